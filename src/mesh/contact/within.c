/* SPDX-License-Identifier: MIT */
/* Triangles within reach: see within.h. */
#include "mesh/contact/within.h"

/* The most that roundings may add to a distance. */
static double slack_of(const pir_contact_job *job) {
    return 0x1p-40 * job->size + 16 * job->error;
}

/* The least and the most of P's vertices along n. */
static void span_along(const pir_contact_job *job, pir_vec3 n, double *ret_least, double *ret_most) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (uint32_t v = 0; v < job->p->vertex_count; v++) {
        const double along = pir_vec_dot(n, job->vertex[v]);
        least = along < least ? along : least;
        most = along > most ? along : most;
    }
    *ret_least = least;
    *ret_most = most;
}

/* The point of a triangle's rim that is nearest to x, by doubles. */
static pir_vec3 nearest_of_rim(const pir_near_triangle *s, pir_vec3 x) {
    pir_vec3 nearest = s->p[0];
    double least = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const pir_vec3 a = s->p[k], e = pir_vec_sub(s->p[(k + 1) % 3], a);
        const double part = pir_vec_dot(e, pir_vec_sub(x, a)) / pir_vec_dot(e, e);
        const pir_vec3 q = pir_vec_add(a, pir_vec_scale(e, part > 0 ? (part < 1 ? part : 1) : 0));
        const pir_vec3 way = pir_vec_sub(x, q);
        const double square = pir_vec_dot(way, way);
        nearest = square < least ? q : nearest;
        least = square < least ? square : least;
    }
    return nearest;
}

bool pir_contact_is_beyond(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, double far) {
    const double reach = far + slack_of(job), height = pir_vec_dot(s->front, pir_vec_sub(t, s->p[0]));
    double least, most, corner = -HUGE_VAL;
    span_along(job, s->front, &least, &most);
    if (height + least > reach || -(height + most) > reach)
        return true;
    const pir_vec3 middle = pir_vec_add(t, pir_vec_scale(pir_vec_add(job->low, job->high), 0.5));
    const pir_vec3 way = pir_vec_sub(middle, nearest_of_rim(s, middle));
    const double length = pir_length(way);
    if (!(length > reach))
        return false;
    const pir_vec3 n = pir_vec_scale(way, 1 / length);
    for (int k = 0; k < 3; k++)
        corner = fmax(corner, pir_vec_dot(n, pir_vec_sub(s->p[k], t)));
    span_along(job, n, &least, &most);
    return least - corner > reach;
}

void pir_contact_keep_within(pir_contact_job *job, double far) {
    const double reach = far + slack_of(job);
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (s->near.meets || !(s->near.distance > reach))
            job->triangle[count++] = *s;
    }
    job->triangle_count = count;
}

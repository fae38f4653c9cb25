/* SPDX-License-Identifier: MIT */
/*
 * Patches over one another. Which features belong to a patch is a matter of a small angle, and chooses points only: the
 * normal is given. A segment or point is treated as a polygon without an area, so one clipping serves all: the corners
 * of each that are over the other, and the crossings of their sides.
 */
#include "mesh/contact/patch_points.h"

/* Sine and cosine of the angle up to which features count as across the normal. */
#define TILT_SINE   0.05
#define TILT_COSINE 0.99875
/* How far an end of a segment is off another one at most that it lies on, by that one's length. */
#define ALONG 0x1p-30

pir_patch_frame pir_patch_frame_of(pir_vec3 n) {
    pir_vec3 axis = fabs(n.x) < 0.6 ? (pir_vec3){1, 0, 0} : (pir_vec3){0, 1, 0}, u = pir_vec_cross(n, axis);
    u = pir_vec_scale(u, 1 / pir_length(u));
    return (pir_patch_frame){n, u, pir_vec_cross(n, u)};
}

static void put(pir_contact_patch *patch, const pir_patch_frame *frame, pir_vec3 x, uint32_t id) {
    if (patch->count == PIR_PATCH_MOST)
        return;
    uint32_t k = patch->count++;
    patch->at[k][0] = pir_vec_dot(frame->u, x);
    patch->at[k][1] = pir_vec_dot(frame->v, x);
    patch->height[k] = pir_vec_dot(frame->n, x);
    patch->id[k] = id;
}

/* --- of P --- */

/* The facet that faces against n most, if it does so by the angle; else UINT32_MAX. */
static uint32_t facing_facet(const pir_contact_job *job, pir_vec3 n) {
    const pir_polytope *p = job->p;
    pir_vec3 own = pir_mat_apply_transposed(&job->rotation.r, n);
    uint32_t best = UINT32_MAX;
    double most = TILT_COSINE;
    for (uint32_t f = 0; f < p->facet_count && p->dimension >= 2; f++) {
        double facing = -pir_vec_dot(own, p->normal[f]);
        if (facing > most) {
            most = facing;
            best = f;
        }
    }
    return best;
}

void pir_patch_of_body(const pir_contact_job *job, const pir_patch_frame *frame, pir_vec3 t, uint32_t lowest,
                       pir_contact_patch *ret_patch) {
    const pir_polytope *p = job->p;
    uint32_t facet = facing_facet(job, frame->n);
    ret_patch->count = 0;
    if (facet != UINT32_MAX) {
        // against its own normal the loop is clockwise, seen along n counter-clockwise is wanted
        uint32_t start = p->loop_start[facet], end = p->loop_start[facet + 1];
        for (uint32_t i = end; i > start; i--)
            put(ret_patch, frame, pir_vec_add(job->vertex[p->origin[p->loop[i - 1]]], t), p->origin[p->loop[i - 1]]);
        return;
    }
    uint32_t v = lowest, other = v;
    pir_vec3 own = pir_mat_apply_transposed(&job->rotation.r, frame->n);
    double least = TILT_SINE;
    for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++) {
        double slope = fabs(pir_vec_dot(own, p->direction[h]));
        other = slope < least ? p->target[h] : other;
        least = slope < least ? slope : least;
    }
    put(ret_patch, frame, pir_vec_add(job->vertex[v], t), v);
    if (other != v)
        put(ret_patch, frame, pir_vec_add(job->vertex[other], t), other);
}

/* --- of a triangle --- */

void pir_patch_of_triangle(const pir_patch_frame *frame, const pir_near_triangle *s, pir_contact_patch *ret_patch) {
    double facing = pir_vec_dot(frame->n, s->front), least = TILT_SINE;
    ret_patch->count = 0;
    if (fabs(facing) > TILT_COSINE) {
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t corner = facing > 0 ? k : 2 - k;
            put(ret_patch, frame, s->p[corner], corner);
        }
        return;
    }
    uint32_t top = 0, other = 3;
    for (uint32_t k = 1; k < 3; k++)
        if (pir_vec_dot(frame->n, s->p[k]) > pir_vec_dot(frame->n, s->p[top]))
            top = k;
    for (uint32_t k = 0; k < 3; k++) {
        pir_vec3 way = pir_vec_sub(s->p[k], s->p[top]);
        double length = pir_length(way), slope = k == top ? 1 : fabs(pir_vec_dot(frame->n, way)) / length;
        other = slope < least ? k : other;
        least = slope < least ? slope : least;
    }
    put(ret_patch, frame, s->p[top], top);
    if (other != 3)
        put(ret_patch, frame, s->p[other], other);
}

/* --- both --- */

static double turn(const double a[2], const double b[2], const double c[2]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Whether a point is over a patch that has an area. */
static bool is_over(const pir_contact_patch *patch, const double x[2]) {
    for (uint32_t k = 0; k < patch->count; k++)
        if (turn(patch->at[k], patch->at[(k + 1) % patch->count], x) < 0)
            return false;
    return patch->count >= 3;
}

/* How a patch rises, and its height at a point: of a polygon by its plane. */
static double height_at(const pir_contact_patch *patch, const double x[2]) {
    const double *a = patch->at[0];
    if (patch->count == 1)
        return patch->height[0];
    if (patch->count == 2) {
        double e[2] = {patch->at[1][0] - a[0], patch->at[1][1] - a[1]};
        double part = ((x[0] - a[0]) * e[0] + (x[1] - a[1]) * e[1]) / (e[0] * e[0] + e[1] * e[1]);
        return patch->height[0] + part * (patch->height[1] - patch->height[0]);
    }
    // the three corners that have the most between them
    uint32_t best = 1;
    double most = 0;
    for (uint32_t k = 1; k + 1 < patch->count; k++) {
        double area = turn(a, patch->at[k], patch->at[k + 1]);
        best = area > most ? k : best;
        most = pir_greater(most, area);
    }
    if (!(most > 0))
        return patch->height[0];
    double p = turn(a, x, patch->at[best + 1]) / most, q = turn(a, patch->at[best], x) / most;
    return patch->height[0] + p * (patch->height[best] - patch->height[0]) +
           q * (patch->height[best + 1] - patch->height[0]);
}

struct patch_meeting {
    const pir_contact_patch *p, *q;
    pir_patch_point *points;
    uint32_t count;
};

static void give(struct patch_meeting *m, const double x[2], pir_contact_feature feature) {
    if (m->count == PIR_PATCH_POINTS)
        return;
    m->points[m->count++] = (pir_patch_point){{x[0], x[1]}, height_at(m->p, x), height_at(m->q, x), feature};
}

/* The crossing of side i of p and side k of q, where they cross. */
static void cross(struct patch_meeting *m, uint32_t i, uint32_t k) {
    const double *a = m->p->at[i], *b = m->p->at[(i + 1) % m->p->count];
    const double *c = m->q->at[k], *d = m->q->at[(k + 1) % m->q->count];
    double at_c = turn(a, b, c), at_d = turn(a, b, d), at_a = turn(c, d, a), at_b = turn(c, d, b);
    if (!(at_c * at_d < 0) || !(at_a * at_b < 0))
        return;
    double part = at_a / (at_a - at_b);
    const double x[2] = {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])};
    const uint32_t from = m->p->id[i], to = m->p->id[(i + 1) % m->p->count];
    const uint32_t corners = 1u << m->q->id[k] | 1u << m->q->id[(k + 1) % m->q->count];
    give(m, x, (pir_contact_feature){{from < to ? from : to, from < to ? to : from}, corners});
}

/* Whether x is on a segment, in doubles. */
static bool is_on(const pir_contact_patch *segment, const double x[2]) {
    const double *a = segment->at[0], *b = segment->at[1];
    const double e[2] = {b[0] - a[0], b[1] - a[1]}, square = e[0] * e[0] + e[1] * e[1];
    const double part = (x[0] - a[0]) * e[0] + (x[1] - a[1]) * e[1];
    return fabs(turn(a, b, x)) <= ALONG * square && part >= 0 && part <= square;
}

/* Ends of two segments that lie on each other. */
static void give_ends(struct patch_meeting *m) {
    for (uint32_t i = 0; i < 2; i++)
        if (is_on(m->q, m->p->at[i]))
            give(m, m->p->at[i],
                 (pir_contact_feature){{m->p->id[i], m->p->id[i]}, 1u << m->q->id[0] | 1u << m->q->id[1]});
    const uint32_t from = m->p->id[0], to = m->p->id[1];
    for (uint32_t k = 0; k < 2; k++)
        if (is_on(m->p, m->q->at[k]))
            give(m, m->q->at[k],
                 (pir_contact_feature){{from < to ? from : to, from < to ? to : from}, 1u << m->q->id[k]});
}

/* How many sides a patch has. */
static uint32_t sides(const pir_contact_patch *patch) {
    return patch->count > 2 ? patch->count : patch->count - 1;
}

uint32_t pir_patch_meet(const pir_contact_patch *p, const pir_contact_patch *q,
                        pir_patch_point ret_points[PIR_PATCH_POINTS]) {
    struct patch_meeting m = {p, q, ret_points, 0};
    for (uint32_t i = 0; i < p->count; i++)
        if (is_over(q, p->at[i]))
            give(&m, p->at[i], (pir_contact_feature){{p->id[i], p->id[i]}, 7});
    for (uint32_t k = 0; k < q->count; k++)
        if (is_over(p, q->at[k]))
            give(&m, q->at[k], (pir_contact_feature){{UINT32_MAX, UINT32_MAX}, 1u << q->id[k]});
    for (uint32_t i = 0; i < sides(p); i++)
        for (uint32_t k = 0; k < sides(q); k++)
            cross(&m, i, k);
    if (p->count == 2 && q->count == 2)
        give_ends(&m);
    return m.count;
}

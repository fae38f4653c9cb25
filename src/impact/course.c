/* SPDX-License-Identifier: MIT */
/* See course.h. */
#include "impact/course.h"

#include <pirouette/exact.h>
#include <pirouette/pose.h>

#include "base/memory.h"
#include "exact/rotation.h"

/* --- doubles --- */

static pir_status place_body(pir_course *course, int which) {
    const pir_polytope *body = course->body[which];
    const pir_allocator *allocator = course->allocator;
    pir_rotation rotation;
    pir_status status = pir_rotation_set(&rotation, course->pose[which].rotation);
    if (status != PIR_OK)
        return status;
    const size_t count = (size_t)body->vertex_count + body->facet_count + body->edge_count;
    pir_vec3 *at = PIR_NEW(allocator, pir_vec3, count);
    if (at == NULL)
        return PIR_ERR_MEMORY;
    course->point[which] = at;
    course->normal[which] = at + body->vertex_count;
    course->edge[which] = course->normal[which] + body->facet_count;
    const pir_vec3 t = course->pose[which].translation;
    double most = 0;
    for (uint32_t v = 0; v < body->vertex_count; v++) {
        at[v] = pir_vec_sub(pir_vec_add(pir_mat_apply(&rotation.r, body->vertex[v]), t), course->pivot);
        most = fmax(most, pir_vec_size(body->vertex[v]));
    }
    for (uint32_t f = 0; f < body->facet_count; f++)
        course->normal[which][f] = pir_mat_apply(&rotation.r, body->normal[f]);
    for (uint32_t e = 0; e < body->edge_count; e++)
        course->edge[which][e] = pir_mat_apply(&rotation.r, body->direction[body->edge_half[e]]);
    course->size += most + pir_vec_size(t) + pir_vec_size(course->pivot);
    return PIR_OK;
}

static void free_body(pir_course *course, int which) {
    const pir_polytope *body = course->body[which];
    PIR_FREE(course->allocator, course->point[which],
             (size_t)body->vertex_count + body->facet_count + body->edge_count);
}

pir_status pir_course_init(pir_course *course, const pir_polytope *const body[2], const pir_pose pose[2]) {
    for (int k = 0; k < 2; k++) {
        course->body[k] = body[k];
        course->pose[k] = pose[k];
    }
    course->has_integers = false;
    course->by_exact = 0;
    if (course->turns) {
        const double most = fmax(fmax(fabs(course->axis.x), fabs(course->axis.y)), fabs(course->axis.z));
        const pir_vec3 u = {course->axis.x / most, course->axis.y / most, course->axis.z / most};
        course->unit = pir_vec_scale(u, 1 / pir_vec_length(u));
    }
    course->advance = (pir_vec3){0, 0, 0};
    if (course->screws)
        course->advance = pir_vec_scale(course->way, course->end_kappa / pir_vec_length(course->axis));
    course->size = pir_vec_size(course->way) + pir_vec_size(course->advance);
    pir_status status = place_body(course, 0);
    if (status != PIR_OK)
        return status;
    status = place_body(course, 1);
    if (status != PIR_OK)
        free_body(course, 0);
    return status;
}

pir_vec3 pir_course_direction(const pir_course *course, pir_vec3 x, double phi) {
    if (!course->turns)
        return x;
    const double s = cos(phi), t = sin(phi);
    const pir_vec3 u = course->unit, c = pir_vec_cross(u, x);
    const pir_vec3 a = pir_vec_scale(x, s * s - t * t), b = pir_vec_scale(c, 2 * s * t);
    return pir_vec_add(pir_vec_add(a, b), pir_vec_scale(u, 2 * t * t * pir_vec_dot(u, x)));
}

pir_vec3 pir_course_point(const pir_course *course, pir_vec3 x, double phi) {
    const pir_vec3 turned = pir_course_direction(course, x, phi);
    if (course->turns && !course->screws)
        return turned;
    return pir_vec_add(turned, pir_vec_scale(course->screws ? course->advance : course->way, tan(phi)));
}

/* Adds `by`·(y·R x), and for a point x of P that goes along, `rate`. */
static void add_product(const pir_course *course, double c[3], pir_vec3 x, pir_vec3 y, double by) {
    const double xy = pir_vec_dot(x, y);
    c[0] += by * xy;
    if (!course->turns)
        return;
    const pir_vec3 u = course->unit;
    c[1] += by * 2 * pir_vec_dot(pir_vec_cross(u, x), y);
    c[2] += by * (2 * pir_vec_dot(u, x) * pir_vec_dot(u, y) - xy);
}

/* Of a way: the number grows by `rate` for each λ. Of a turn: adds the constant h. */
static void add_rest(const pir_course *course, double c[3], double h, double rate) {
    c[0] += h;
    if (course->turns)
        c[2] += h;
    else
        c[1] += rate;
}

pir_plane_rows pir_course_rows(const pir_course *course, const pir_condition *on) {
    const bool of_q = on->kind == PIR_Q_PLANE || on->kind == PIR_Q_SIDE;
    const bool is_side = on->kind == PIR_Q_SIDE || on->kind == PIR_P_SIDE;
    const int own = of_q; /* the body that has the plane */
    const pir_polytope *body = course->body[own];
    const uint32_t face = of_q ? on->q : on->p;
    uint32_t base;
    pir_vec3 n;
    if (is_side) {
        // negative within: outwards is along the halfedge × the normal
        const uint32_t e = body->edge[face];
        n = pir_vec_cross(course->edge[own][e], course->normal[own][body->left[face]]);
        n = pir_vec_scale(n, body->edge_half[e] == face ? 1 : -1);
        base = body->origin[face];
    } else {
        n = pir_vec_scale(course->normal[own][face], -1);
        base = body->origin[body->loop[body->loop_start[face]]];
    }
    const double h = -pir_vec_dot(n, course->point[own][base]), along = pir_vec_dot(n, course->way);
    pir_plane_rows rows = {.row = {n}, .h = {h}, .bound = PIR_COURSE_BOUND * course->size};
    rows.point = course->point[!own];
    if (course->turns) {
        const pir_vec3 u = course->unit;
        rows.row[1] = pir_vec_scale(pir_vec_cross(n, u), of_q ? 2 : -2);
        rows.row[2] = pir_vec_sub(pir_vec_scale(u, 2 * pir_vec_dot(u, n)), n);
        rows.h[2] = h;
    } else {
        rows.h[1] = of_q ? along : -along;
    }
    if (course->screws) {
        const pir_vec3 by = course->advance;
        const double still = pir_vec_dot(n, by);
        rows.h[1] += of_q ? still : -still;
        rows.h[2] -= of_q ? 0 : pir_vec_dot(rows.row[1], by);
        rows.h[3] = of_q ? still : -pir_vec_dot(rows.row[2], by);
    }
    return rows;
}

static void form_of_edges(const pir_course *course, const pir_condition *on, double c[4]) {
    const pir_polytope *p = course->body[0], *q = course->body[1];
    const pir_vec3 e = course->edge[0][on->p], f = course->edge[1][on->q];
    if (on->kind == PIR_CROSSING) {
        const pir_polytope *body = on->corner < 2 ? p : q;
        const pir_arc_ends ends = body->arc_ends[on->corner < 2 ? on->p : on->q];
        const uint32_t facet = on->corner % 2 == 0 ? ends.from : ends.to;
        const double by = on->corner % 2 == 0 ? on->side : -on->side;
        if (on->corner < 2)
            add_product(course, c, course->normal[0][facet], f, by);
        else
            add_product(course, c, e, course->normal[1][facet], by);
        return;
    }
    const pir_vec3 a = course->point[0][p->origin[p->edge_half[on->p]]];
    const pir_vec3 b = course->point[1][q->origin[q->edge_half[on->q]]];
    add_product(course, c, pir_vec_cross(a, e), f, -on->side);
    add_product(course, c, e, pir_vec_cross(f, b), on->side);
    add_rest(course, c, 0, -on->side * pir_vec_dot(pir_vec_cross(e, f), course->way));
    if (course->screws)
        add_product(course, c + 1, e, pir_vec_cross(f, course->advance), -on->side);
}

pir_course_form pir_course_form_of(const pir_course *course, const pir_condition *on) {
    if (on->kind != PIR_CROSSING && on->kind != PIR_EDGES) {
        const pir_plane_rows rows = pir_course_rows(course, on);
        return pir_rows_form(&rows, on->kind == PIR_Q_PLANE || on->kind == PIR_Q_SIDE ? on->p : on->q);
    }
    pir_course_form form = {{0, 0, 0, 0}, PIR_COURSE_BOUND * (on->kind == PIR_CROSSING ? 1 : course->size)};
    form_of_edges(course, on, form.c);
    return form;
}

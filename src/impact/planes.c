/* SPDX-License-Identifier: MIT */
/* See planes.h. */
#include "impact/planes.h"

/* --- around an answer, in doubles --- */

static uint32_t vertex_of(const pir_polytope *body, pir_feature feature) {
    if (feature.kind == PIR_FEATURE_VERTEX)
        return feature.index;
    return body->origin[feature.kind == PIR_FEATURE_EDGE ? body->edge_half[feature.index]
                                                         : body->loop[body->loop_start[feature.index]]];
}

typedef struct best_plane {
    pir_condition plane;
    double gap;
} best_plane;

/* A facet's plane, of which the vertex near the other body is tried before all others. */
static void try_facet(const pir_impact_search *search, pir_condition_kind kind, uint32_t p, uint32_t q,
                      best_plane *best) {
    const pir_condition plane = {.kind = kind, .p = p, .q = q};
    const pir_plane_rows rows = pir_course_rows(&search->course, &plane);
    const double ss = search->sigma * search->sigma, st = search->sigma * search->tau, tt = search->tau * search->tau;
    // the distance is −row·x − h of one row at this moment; of a screw the form over σ
    const pir_vec3 row = pir_vec_add(pir_vec_add(pir_vec_scale(rows.row[0], -ss), pir_vec_scale(rows.row[1], -st)),
                                     pir_vec_scale(rows.row[2], -tt));
    const double last = search->course.screws ? rows.h[3] * tt * (search->tau / search->sigma) : 0;
    const double h = -(rows.h[0] * ss + rows.h[1] * st + rows.h[2] * tt + last);
    double gap = pir_vec_dot(row, rows.point[kind == PIR_Q_PLANE ? p : q]) + h;
    const uint32_t count = pir_plane_count(search, &plane);
    for (uint32_t i = 0; i < count && gap > best->gap; i++)
        gap = pir_lesser(gap, pir_vec_dot(row, rows.point[i]) + h);
    if (gap > best->gap)
        *best = (best_plane){plane, gap};
}

/* An edge of P as it is now: its direction, the normals beside it, a point. */
typedef struct turned_edge {
    pir_vec3 along, left, right, at;
} turned_edge;

static void try_edges(const pir_impact_search *search, const turned_edge *e, uint32_t edge_p, uint32_t edge_q,
                      best_plane *best) {
    const pir_course *course = &search->course;
    const pir_polytope *q = course->body[1];
    const pir_vec3 f = course->edge[1][edge_q];
    const double left = pir_vec_dot(f, e->left), right = pir_vec_dot(f, e->right);
    if (!(left * right < 0))
        return;
    const int8_t side = left < 0 ? 1 : -1;
    const pir_arc_ends ends = q->arc_ends[edge_q];
    if (!(side * pir_vec_dot(e->along, course->normal[1][ends.from]) < 0) ||
        !(side * pir_vec_dot(e->along, course->normal[1][ends.to]) > 0))
        return;
    const pir_vec3 n = pir_vec_scale(pir_vec_cross(e->along, f), side);
    const pir_vec3 b = course->point[1][q->origin[q->edge_half[edge_q]]];
    const double gap = pir_vec_dot(n, pir_vec_sub(e->at, b)) / pir_vec_length(n);
    if (gap > best->gap)
        *best = (best_plane){{.kind = PIR_EDGES, .p = edge_p, .q = edge_q, .side = side}, gap};
}

bool pir_candidates_near(const pir_impact_search *search, const pir_witness *witness, pir_condition *ret_plane) {
    const pir_course *course = &search->course;
    const pir_polytope *p = course->body[0], *q = course->body[1];
    const uint32_t a = vertex_of(p, witness->p), b = vertex_of(q, witness->q);
    best_plane best = {{0}, 0};
    for (uint32_t h = q->ring_start[b]; h < q->ring_start[b + 1]; h++)
        try_facet(search, PIR_Q_PLANE, a, q->left[h], &best);
    for (uint32_t h = p->ring_start[a]; h < p->ring_start[a + 1]; h++)
        try_facet(search, PIR_P_PLANE, p->left[h], b, &best);
    const double phi = search->now.phi;
    for (uint32_t h = p->ring_start[a]; h < p->ring_start[a + 1]; h++) {
        const uint32_t edge = p->edge[h];
        const pir_arc_ends ends = p->arc_ends[edge];
        const turned_edge e = {pir_course_direction(course, course->edge[0][edge], phi),
                               pir_course_direction(course, course->normal[0][ends.from], phi),
                               pir_course_direction(course, course->normal[0][ends.to], phi),
                               pir_course_point(course, course->point[0][a], phi)};
        for (uint32_t g = q->ring_start[b]; g < q->ring_start[b + 1]; g++)
            try_edges(search, &e, edge, q->edge[g], &best);
    }
    if (best.gap > 0)
        *ret_plane = best.plane;
    return best.gap > 0;
}

/* --- exactly --- */

bool pir_parts_strictly(pir_impact_search *search, const pir_condition *plane, pir_sign_when when) {
    const uint32_t count = pir_plane_count(search, plane);
    const bool is_facet = plane->kind != PIR_EDGES;
    const pir_plane_rows rows = is_facet ? pir_course_rows(&search->course, plane) : (pir_plane_rows){0};
    // most planes are decided by doubles
    bool all = true;
    for (uint32_t i = 0; i < count; i++) {
        const pir_condition on = pir_plane_condition(plane, i);
        const pir_course_form form = is_facet ? pir_rows_form(&rows, i) : pir_course_form_of(&search->course, &on);
        const int sign = pir_search_form_sign(search, &form);
        if (sign == 1)
            return false;
        all = all && sign == -1;
    }
    for (uint32_t i = 0; i < count && !all; i++) {
        const pir_condition on = pir_plane_condition(plane, i);
        if (pir_search_sign(search, &on, when) >= 0)
            return false;
    }
    return true;
}

/* As separates, where slacks may be zero. */
static bool holds(pir_impact_search *search, const pir_condition *plane) {
    const uint32_t count = pir_plane_count(search, plane);
    for (uint32_t i = 0; i < count; i++) {
        const pir_condition on = pir_plane_condition(plane, i);
        const int sign = pir_search_sign(search, &on, PIR_SIGN_SOON);
        if (sign > 0 || (sign == 0 && on.kind == PIR_CROSSING))
            return false;
    }
    return true;
}

/* All planes one after another, until one is accepted. */
static bool any_plane(pir_impact_search *search, pir_sign_when when, bool weakly, pir_condition *ret_plane) {
    const pir_polytope *p = search->course.body[0], *q = search->course.body[1];
    const uint32_t facets = p->facet_count + q->facet_count;
    const uint64_t count = facets + 2 * (uint64_t)p->edge_count * q->edge_count;
    for (uint64_t i = 0; i < count && search->status == PIR_OK; i++) {
        pir_condition plane = {0};
        if (i < q->facet_count) {
            plane = (pir_condition){.kind = PIR_Q_PLANE, .q = (uint32_t)i};
        } else if (i < facets) {
            plane = (pir_condition){.kind = PIR_P_PLANE, .p = (uint32_t)i - q->facet_count};
        } else {
            const uint64_t k = (i - facets) / 2;
            plane = (pir_condition){.kind = PIR_EDGES,
                                    .p = (uint32_t)(k / q->edge_count),
                                    .q = (uint32_t)(k % q->edge_count),
                                    .side = (i - facets) % 2 == 0 ? 1 : -1};
        }
        if (weakly ? holds(search, &plane) : pir_parts_strictly(search, &plane, when)) {
            *ret_plane = plane;
            return search->status == PIR_OK;
        }
    }
    return false;
}

bool pir_candidates_any(pir_impact_search *search, pir_sign_when when, pir_condition *ret_plane) {
    return any_plane(search, when, false, ret_plane);
}

bool pir_candidates_rest(pir_impact_search *search) {
    pir_condition plane;
    return any_plane(search, PIR_SIGN_SOON, true, &plane);
}

/* --- touching --- */

/* A vertex is within the facet in whose plane it is. */
static bool is_within(pir_impact_search *search, const pir_condition *slack) {
    const bool of_q = slack->kind == PIR_Q_PLANE;
    const pir_polytope *body = search->course.body[of_q];
    const uint32_t facet = of_q ? slack->q : slack->p;
    for (uint32_t i = body->loop_start[facet]; i < body->loop_start[facet + 1]; i++) {
        pir_condition on = *slack;
        on.kind = of_q ? PIR_Q_SIDE : PIR_P_SIDE;
        *(of_q ? &on.q : &on.p) = body->loop[i];
        if (pir_search_sign(search, &on, PIR_SIGN_NOW) > 0)
            return false;
    }
    return true;
}

/* Whether the ends of an edge are on both sides of a facet that ends at the other edge, or on it. */
static bool is_cut(pir_impact_search *search, const pir_condition *slack, pir_condition_kind kind) {
    const bool of_q = kind == PIR_Q_PLANE;
    const pir_polytope *own = search->course.body[of_q], *other = search->course.body[!of_q];
    const uint32_t facet = own->arc_ends[of_q ? slack->q : slack->p].from;
    const uint32_t half = other->edge_half[of_q ? slack->p : slack->q];
    int product = 1;
    for (int k = 0; k < 2; k++) {
        const uint32_t v = k == 0 ? other->origin[half] : other->target[half];
        const pir_condition on = {.kind = kind, .p = of_q ? v : facet, .q = of_q ? facet : v};
        product *= pir_search_sign(search, &on, PIR_SIGN_NOW);
    }
    return product <= 0;
}

bool pir_features_touch(pir_impact_search *search, const pir_condition *slack) {
    if (slack->kind != PIR_EDGES)
        return is_within(search, slack);
    for (uint32_t i = 0; i < 4; i++) {
        const pir_condition on = pir_plane_condition(slack, i);
        if (pir_search_sign(search, &on, PIR_SIGN_NOW) >= 0)
            return false;
    }
    return is_cut(search, slack, PIR_Q_PLANE) && is_cut(search, slack, PIR_P_PLANE);
}

/* A facet that has a face. */
static uint32_t facet_of(const pir_polytope *body, pir_feature face) {
    if (face.kind == PIR_FEATURE_FACET)
        return face.index;
    return body->left[face.kind == PIR_FEATURE_EDGE ? body->edge_half[face.index] : body->ring_start[face.index]];
}

bool pir_witness_touches(pir_impact_search *search, const pir_witness *witness) {
    const bool of_q = witness->p.kind == PIR_FEATURE_VERTEX;
    if (!of_q && witness->q.kind != PIR_FEATURE_VERTEX)
        return false;
    pir_condition slack = {.kind = of_q ? PIR_Q_PLANE : PIR_P_PLANE, .p = witness->p.index, .q = witness->q.index};
    *(of_q ? &slack.q : &slack.p) = facet_of(search->course.body[of_q], of_q ? witness->q : witness->p);
    return pir_search_sign(search, &slack, PIR_SIGN_NOW) == 0 && is_within(search, &slack);
}

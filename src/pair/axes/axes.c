/* SPDX-License-Identifier: MIT */
/*
 * The facet of least slack among all that the difference of two small bodies can have: see axes.h.
 *
 * No slack is below what the loops say. Along the normal of a facet it is computed from the numbers that
 * PIR_SLACK_BOUND is proven for (frame.h), and the farthest vertex is no less far than the one that the facet meets.
 *
 * For two edges let c be the cross product of their unit vectors, and σ its length. The vectors are off by 6u and
 * 47u, so c as computed is off by less than 64u, and its length σ' as well. The vertices of P are turned first, which
 * puts them off by 44u of its size, and sums round by 6u. So the slack along c, which is σ times that of the facet, is
 * known to 110u · reach, less than E, the placement's error of 128u · reach. Let a be its true value and a' the
 * computed one: the loops say (a' − 4 E) / σ'. No slack is above the reach in absolute value.
 *
 *   - Where σ' is above 128u, |a (σ' − σ) / σ| is at most 64u · reach, less than E. So a' − 4 E is less than
 *     a + a (σ' − σ) / σ = a σ' / σ, and they say less than a / σ. That they multiply by 1 / σ' adds 2u to it.
 *   - Where σ' is less, a' is at most 140u · reach, less than 2 E. So they say less than −reach, which no slack is
 *     below.
 *
 * Of parallelepipeds sums of halves of edges take the place of vertices. Together three halves are at most √3
 * times as long as the farthest vertex, and their sums are vertices but for 8u of that and 3u as above. A half
 * along the edge that the vector is across adds nothing. So a is known to √3 · 110u + 11u of the reach, less
 * than 2 E, and where σ' is at most 128u, a' is less than 4 E. What is left without 4 E is less than a σ' / σ in
 * the first case, and below 0 in the second. Slacks along lines are off by √3 · 60u + 11u of the reach, which 2
 * E holds.
 */
#include "pair/axes/axes.h"

#include <string.h>

/* --- the axes of a body --- */

/* The kind of what is attached. */
static const char an_axes;

static void destroy(pir_attachment *attachment, const pir_allocator *a) {
    pir_axes *axes = (pir_axes *)attachment;
    PIR_FREE(a, axes, 1);
}

static void put(double lanes[3][PIR_AXES_PADDED], uint32_t i, pir_vec3 v) {
    lanes[0][i] = v.x;
    lanes[1][i] = v.y;
    lanes[2][i] = v.z;
}

static void put_half(double lanes[3][PIR_AXES_HALVES], uint32_t i, pir_vec3 v) {
    lanes[0][i] = v.x;
    lanes[1][i] = v.y;
    lanes[2][i] = v.z;
}

static pir_vec3 get(const double lanes[3][PIR_AXES_PADDED], uint32_t i) {
    return (pir_vec3){lanes[0][i], lanes[1][i], lanes[2][i]};
}

/* Whether a · b equals c · d; `room` is for four factors. */
static bool are_equal(const pir_int *a, const pir_int *b, const pir_int *c, const pir_int *d, mp_limb_t *room) {
    uint32_t limbs = pir_int_length(a) + pir_int_length(b), others = pir_int_length(c) + pir_int_length(d);
    pir_int first = {room, 0, limbs}, second = {room + limbs, 0, others};
    pir_int_mul(&first, a, b);
    pir_int_mul(&second, c, d);
    return first.size == second.size &&
           memcmp(first.limb, second.limb, pir_int_length(&first) * sizeof *first.limb) == 0;
}

/* Whether two edges of a body have one direction, or opposite ones. */
static bool are_parallel(const pir_polytope *p, uint32_t e, uint32_t f, mp_limb_t *room) {
    pir_int3 a = pir_vectors_at(&p->exact_edge, e), b = pir_vectors_at(&p->exact_edge, f);
    return are_equal(&a.c[0], &b.c[1], &a.c[1], &b.c[0], room) && are_equal(&a.c[1], &b.c[2], &a.c[2], &b.c[1], room) &&
           are_equal(&a.c[2], &b.c[0], &a.c[0], &b.c[2], room);
}

/* Finds the directions of edges. False where there are too many. */
static bool find_along(const pir_polytope *p, mp_limb_t *room, pir_axes *axes) {
    bool taken[PIR_AXES_EDGES] = {false};
    uint32_t count = 0;
    axes->lanes.along = 0;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        if (taken[e])
            continue;
        uint32_t k = axes->lanes.along++;
        if (k == PIR_AXES_ALONG)
            return false;
        put(axes->lanes.edge, k, p->direction[p->edge_half[e]]);
        axes->lanes.far[k] = 0;
        axes->first[k] = count;
        for (uint32_t f = e; f < p->edge_count; f++)
            if (!taken[f] && are_parallel(p, e, f, room)) {
                taken[f] = true;
                axes->edges[count++] = f;
            }
    }
    axes->first[axes->lanes.along] = count;
    return true;
}

static bool are_opposite(pir_vec3 a, pir_vec3 b) {
    return a.x == -b.x && a.y == -b.y && a.z == -b.z;
}

/* The vector opposite to vector i, of so many; `count` where there is none. */
static uint32_t opposite_of(const pir_vec3 *vectors, uint32_t count, uint32_t i) {
    uint32_t k = 0;
    while (k < count && !are_opposite(vectors[k], vectors[i]))
        k++;
    return k;
}

/* Lists vertices: of opposite ones the first, where all have one and four are left. */
static void list_vertices(const pir_body *body, pir_axes_lanes *lanes) {
    const uint32_t count = body->polytope->vertex_count;
    lanes->is_central = count == 8;
    for (uint32_t v = 0; v < count; v++)
        lanes->is_central = lanes->is_central && opposite_of(body->vertex, count, v) < count;
    lanes->vertices = 0;
    for (uint32_t v = 0; v < count; v++)
        if (!lanes->is_central || opposite_of(body->vertex, count, v) > v)
            put(lanes->vertex, lanes->vertices++, body->vertex[v]);
    for (uint32_t v = lanes->vertices; v < PIR_AXES_PADDED; v++)
        put(lanes->vertex, v, body->vertex[0]);
}

/* Lists facets by the lines along which they look. */
static void list_lines(const pir_body *body, pir_axes *axes) {
    const pir_polytope *p = body->polytope;
    pir_axes_lanes *lanes = &axes->lanes;
    for (uint32_t i = 0; i < PIR_AXES_PADDED; i++)
        lanes->offset[0][i] = lanes->offset[1][i] = lanes->far[i] = HUGE_VAL;
    lanes->lines = 0;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        uint32_t back = opposite_of(p->normal, p->facet_count, f);
        if (back < f)
            continue;
        uint32_t line = lanes->lines++;
        put(lanes->normal, line, p->normal[f]);
        lanes->offset[0][line] = body->offset[f];
        axes->facet[0][line] = f;
        if (back < p->facet_count) {
            lanes->offset[1][line] = body->offset[back];
            axes->facet[1][line] = back;
        }
    }
}

/* Whether each sum of three halves, either way, is a vertex but for rounding. */
static bool are_halves(const pir_body *body, const pir_vec3 half[3]) {
    for (uint32_t i = 0; i < 8; i++) {
        pir_vec3 sum = {0, 0, 0};
        for (uint32_t k = 0; k < 3; k++)
            sum = pir_vec_add(sum, pir_vec_scale(half[k], i >> k & 1 ? 1 : -1));
        bool found = false;
        for (uint32_t v = 0; v < body->polytope->vertex_count; v++)
            found |= pir_vec_length(pir_vec_sub(sum, body->vertex[v])) <= 0x1p-50 * body->size;
        if (!found)
            return false;
    }
    return true;
}

/* Lists halves of edges, the directions of edges being listed, where the body is a parallelepiped. */
static void list_halves(const pir_body *body, pir_axes *axes) {
    const pir_polytope *p = body->polytope;
    pir_axes_lanes *lanes = &axes->lanes;
    pir_vec3 half[3];
    if (!lanes->is_central || lanes->lines != 3 || lanes->along != 3)
        return;
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t h = p->edge_half[axes->edges[axes->first[k]]];
        half[k] = pir_vec_scale(pir_vec_sub(body->vertex[p->target[h]], body->vertex[p->origin[h]]), 0.5);
    }
    lanes->has_halves = are_halves(body, half);
    for (uint32_t k = 0; k < 3; k++) {
        put_half(lanes->half, k, half[k]);
        put_half(lanes->other[0], k, half[(k + 1) % 3]);
        put_half(lanes->other[1], k, half[(k + 2) % 3]);
    }
}

/* Makes the axes of a body; NULL when out of memory. */
static pir_axes *make(const pir_polytope *p, int exponent, const pir_body *body) {
    const pir_allocator *a = &p->allocator;
    uint32_t limbs = 4 * p->exact_edge.stride;
    pir_axes *made = PIR_ZEROED(a, pir_axes, 1);
    mp_limb_t *room = PIR_NEW(a, mp_limb_t, limbs);
    if (made && room) {
        made->attachment = (pir_attachment){.kind = &an_axes, .key = exponent, .destroy = destroy};
        list_vertices(body, &made->lanes);
        list_lines(body, made);
        made->is_few = find_along(p, room, made);
        if (made->is_few)
            list_halves(body, made);
    } else {
        PIR_FREE(a, made, 1);
        made = NULL;
    }
    PIR_FREE(a, room, limbs);
    return made;
}

pir_status pir_axes_find(pir_polytope *p, int exponent, const pir_body *body, const pir_axes **ret_axes) {
    *ret_axes = NULL;
    if (p->dimension < 3 || p->vertex_count > PIR_AXES_VERTICES || p->facet_count > PIR_AXES_FACETS)
        return PIR_OK;
    pir_attachment *attachment = pir_polytope_attachment(p, &an_axes, exponent);
    if (!attachment) {
        pir_axes *made = make(p, exponent, body);
        if (!made)
            return PIR_ERR_MEMORY;
        attachment = pir_polytope_attach(p, &made->attachment);
    }
    const pir_axes *axes = (const pir_axes *)attachment;
    *ret_axes = axes->is_few ? axes : NULL;
    return PIR_OK;
}

/* --- the least --- */

/* The edge along direction k that is farthest along n. */
static uint32_t farthest_edge(const pir_axes *axes, const pir_body *body, uint32_t k, pir_vec3 n) {
    const pir_polytope *p = body->polytope;
    uint32_t best = axes->edges[axes->first[k]];
    double most = -HUGE_VAL;
    for (uint32_t i = axes->first[k]; i < axes->first[k + 1]; i++) {
        uint32_t edge = axes->edges[i];
        double to = pir_vec_dot(n, body->vertex[p->origin[p->edge_half[edge]]]);
        best = to > most ? edge : best;
        most = to > most ? to : most;
    }
    return best;
}

/* The piece of two edges of which slack `k` of those of P's direction i is. */
static pir_piece piece_of_edges(const pir_axes *p, const pir_axes *q, const pir_frame *frame, uint32_t i, uint32_t k,
                                pir_vec3 *ret_normal) {
    const pir_polytope *of_p = frame->p.polytope, *of_q = frame->q.polytope;
    uint32_t wide = pir_axes_padded(q->lanes.along), j = k < wide ? k : k - wide;
    pir_vec3 n = pir_vec_cross(get(q->lanes.edge, j), pir_mat_apply(&frame->r, get(p->lanes.edge, i)));
    n = pir_vec_scale(n, (k < wide ? 1 : -1) / sqrt(pir_vec_dot(n, n)));
    uint32_t edge = farthest_edge(p, &frame->p, i, pir_mat_apply_transposed(&frame->r, n));
    uint32_t half = of_q->edge_half[farthest_edge(q, &frame->q, j, n)];
    pir_vec3 along = pir_mat_apply(&frame->r, of_p->direction[of_p->edge_half[edge]]);
    bool outwards = pir_vec_dot(pir_vec_cross(of_q->direction[half], along), n) > 0;
    *ret_normal = n;
    return (pir_piece){PIR_FACET_EE, edge, outwards ? half : of_q->twin[half]};
}

pir_piece pir_axes_piece(const pir_axes *p, const pir_axes *q, const pir_frame *frame, uint32_t at,
                         pir_vec3 *ret_normal) {
    uint32_t line_p = pir_axes_padded(p->lanes.lines), line_q = pir_axes_padded(q->lanes.lines), of_p = 2 * line_p;
    uint32_t of_both = of_p + 2 * line_q, of_edge = 2 * pir_axes_padded(q->lanes.along);
    if (at < of_p) {
        uint32_t f = p->facet[at / line_p][at % line_p];
        *ret_normal = pir_mat_apply(&frame->r, frame->p.polytope->normal[f]);
        return (pir_piece){PIR_FACET_FV, f, frame->q.landmarks[pir_landmark_of(*ret_normal)]};
    }
    if (at < of_both) {
        uint32_t f = q->facet[(at - of_p) / line_q][(at - of_p) % line_q];
        *ret_normal = frame->q.polytope->normal[f];
        pir_vec3 back = pir_mat_apply_transposed(&frame->r, *ret_normal);
        return (pir_piece){PIR_FACET_VF, frame->p.landmarks[pir_landmark_of(back)], f};
    }
    return piece_of_edges(p, q, frame, (at - of_both) / of_edge, (at - of_both) % of_edge, ret_normal);
}

void pir_axes_least(const pir_axes_loops *loops, const pir_axes *p, const pir_axes *q, const pir_frame *frame,
                    const pir_placement *placement, pir_axes_slack *ret_least) {
    double low[PIR_AXES_SLACKS];
    uint32_t count = loops->slacks(&p->lanes, &q->lanes, &frame->r, placement->x, placement->error, low);
    ret_least->at = loops->least(low, count, &ret_least->next);
    ret_least->low = low[ret_least->at];
}

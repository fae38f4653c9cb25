/* SPDX-License-Identifier: MIT */
/*
 * Pieces of the sum, and which are coplanar.
 *
 * The pairing is that of a perturbed rotation. At the true one, a crossing of arcs e and d may lie on an end of one of them: exactly
 * when one of its four signs is zero. Unless e and d are parallel, and the piece has no area, the crossing then is that end: both e's
 * vector and d are perpendicular to the end's normal. So pieces are joined along such zeros alone, and that is all there is to join:
 * whenever two pieces lie in one facet of the true sum, a facet of P or Q does too, and each crossing that coincides with it has a zero
 * that names it.
 *
 * Where an arc is half a circle, as in the map of a polygon, the end may also be the antipode of the crossing; one more exact sign tells.
 */
#include "dymsum/pieces.h"

/* |sin| of the angle between edges above which they are not parallel; the proof is that of PIR_SIGN_BOUND, four times over. */
#define PARALLEL_BOUND 0x1p-45

void pir_pieces_finish(pir_pieces *pieces, const pir_allocator *allocator) {
    PIR_FREE(allocator, pieces->start, (size_t)pieces->count + 1);
    PIR_FREE(allocator, pieces->corner, pieces->corner_count);
    PIR_FREE(allocator, pieces->group, pieces->count);
    *pieces = (pir_pieces){0};
}

/* --- the polygons --- */

/* The loops of one operand's facets, each with the vertex that its facet is paired with. */
static uint32_t add_facets(pir_pieces *pieces, const pir_polytope *of, const uint32_t *partner, bool of_p,
                           uint32_t piece) {
    uint32_t at = pieces->start[piece];
    for (uint32_t f = 0; f < of->facet_count; f++) {
        for (uint32_t i = of->loop_start[f]; i < of->loop_start[f + 1]; i++) {
            uint32_t v = of->origin[of->loop[i]];
            pieces->corner[at++] = of_p ? (pir_corner){v, partner[f]} : (pir_corner){partner[f], v};
        }
        pieces->start[++piece] = at;
    }
    return piece;
}

/* The parallelogram of a crossing: its outward normal is d × e. */
static void add_crossing(pir_pieces *pieces, const pir_sum *sum, uint32_t slot, uint32_t piece) {
    uint32_t half = sum->p->edge_half[sum->crossings.edge[slot]], h = sum->crossings.half[slot];
    uint32_t p0 = sum->p->origin[half], p1 = sum->p->target[half], q0 = sum->q->origin[h], q1 = sum->q->target[h];
    pir_corner *corner = pieces->corner + pieces->start[piece];
    corner[0] = (pir_corner){p0, q0};
    corner[1] = (pir_corner){p0, q1};
    corner[2] = (pir_corner){p1, q1};
    corner[3] = (pir_corner){p1, q0};
    pieces->start[piece + 1] = pieces->start[piece] + 4;
}

/* --- grouping --- */

static uint32_t find_group(uint32_t *group, uint32_t i) {
    while (group[i] != i) {
        group[i] = group[group[i]];
        i = group[i];
    }
    return i;
}

/* Joins two pieces, the smaller index to stand for both. */
static void join(pir_pieces *pieces, uint32_t i, uint32_t j) {
    i = find_group(pieces->group, i);
    j = find_group(pieces->group, j);
    if (i < j)
        pieces->group[j] = i;
    else
        pieces->group[i] = j;
    pieces->merged = true;
}

/* The vectors of a crossing, for the exact questions that are seldom asked. */
struct crossing {
    uint32_t half, h; /* the halfedges of P and Q */
    pir_vec3 e, d;    /* unit, P's rotated */
};

/* d × M·e exactly, into scratch that the caller gives back. */
static pir_int3 exact_normal(pir_sum *sum, const struct crossing *x) {
    pir_limbs *scratch = &sum->signs.scratch;
    pir_int3 e = pir_half_exact(sum->p, x->half), d = pir_half_exact(sum->q, x->h);
    uint32_t le = pir_int3_length(&e) + PIR_MATRIX_LIMBS + 1, ld = pir_int3_length(&d);
    pir_rotation_make_exact(&sum->signs.rotation);
    pir_int3 rotated = pir_int3_take(scratch, le), n = pir_int3_take(scratch, le + ld + 1);
    pir_rotation_apply(&sum->signs.rotation, &rotated, &e, scratch);
    pir_int3_cross(&n, &d, &rotated, scratch);
    return n;
}

static bool is_parallel(pir_sum *sum, const struct crossing *x) {
    pir_vec3 n = pir_vec_cross(x->d, x->e);
    if (fabs(n.x) > PARALLEL_BOUND || fabs(n.y) > PARALLEL_BOUND || fabs(n.z) > PARALLEL_BOUND)
        return false;
    uint32_t mark = sum->signs.scratch.used;
    pir_int3 exact = exact_normal(sum, x);
    sum->signs.scratch.used = mark;
    return pir_int3_is_zero(&exact);
}

/*
 * Whether the crossing points along `normal` rather than against it, the two being parallel; `rotates` when the normal is P's. Only the
 * half circles of flat operands make it a question.
 */
static bool points_along(pir_sum *sum, const struct crossing *x, const pir_int3 *normal, bool rotates) {
    pir_limbs *scratch = &sum->signs.scratch;
    uint32_t mark = scratch->used;
    pir_int3 n = exact_normal(sum, x), m = *normal;
    uint32_t length = pir_int3_length(normal);
    if (rotates) {
        length += PIR_MATRIX_LIMBS + 1;
        m = pir_int3_take(scratch, length);
        pir_rotation_apply(&sum->signs.rotation, &m, normal, scratch);
    }
    // parallel vectors agree in sign where either is not zero
    bool along = false;
    for (int k = 0; k < 3; k++)
        along |= pir_int_sign(&n.c[k]) * pir_int_sign(&m.c[k]) > 0;
    scratch->used = mark;
    return along;
}

/* Whether s(a, b) is exactly zero, given its value by doubles. */
static bool is_tie(pir_sum *sum, double value, const pir_int3 *a, const pir_int3 *b) {
    return pir_filter_sign(value) == 0 && pir_sign_true(&sum->signs, a, b) == 0;
}

/* Joins the crossing in `slot`, which is piece `piece`, with the facets that it coincides with, or drops it. */
static void group_crossing(pir_pieces *pieces, pir_sum *sum, uint32_t slot, uint32_t piece) {
    const pir_polytope *p = sum->p, *q = sum->q;
    struct crossing x = {.half = p->edge_half[sum->crossings.edge[slot]], .h = sum->crossings.half[slot]};
    x.e = pir_rotated_direction(sum, x.half);
    x.d = q->direction[x.h];
    pir_int3 e = pir_half_exact(p, x.half), d = pir_half_exact(q, x.h);
    const uint32_t ends_p[2] = {p->left[x.half], pir_right(p, x.half)}, ends_q[2] = {q->left[x.h], pir_right(q, x.h)};
    bool tie_p[2], tie_q[2];
    for (int i = 0; i < 2; i++) {
        pir_int3 f = pir_normal_exact(p, ends_p[i]), g = pir_normal_exact(q, ends_q[i]);
        tie_p[i] = is_tie(sum, pir_vec_dot(sum->rotated[ends_p[i]], x.d), &f, &d);
        tie_q[i] = is_tie(sum, pir_vec_dot(x.e, q->normal[ends_q[i]]), &e, &g);
    }
    if (!tie_p[0] && !tie_p[1] && !tie_q[0] && !tie_q[1])
        return;
    if (is_parallel(sum, &x)) {
        pieces->group[piece] = PIR_DROPPED;
        pieces->merged = true;
        return;
    }
    for (int i = 0; i < 2; i++) {
        pir_int3 f = pir_normal_exact(p, ends_p[i]), g = pir_normal_exact(q, ends_q[i]);
        if (tie_p[i] && !p->artificial && (p->dimension == 3 || points_along(sum, &x, &f, true)))
            join(pieces, piece, ends_p[i]);
        if (tie_q[i] && !q->artificial && (q->dimension == 3 || points_along(sum, &x, &g, false)))
            join(pieces, piece, p->facet_count + ends_q[i]);
    }
}

pir_status pir_pieces_make(pir_pieces *pieces, pir_sum *sum) {
    const pir_polytope *p = sum->p, *q = sum->q;
    const pir_allocator *a = &sum->allocator;
    *pieces = (pir_pieces){.count = p->facet_count + q->facet_count + sum->ee_count,
                           .corner_count = p->half_count + q->half_count + 4 * sum->ee_count};
    pieces->start = PIR_ZEROED(a, uint32_t, (size_t)pieces->count + 1);
    pieces->corner = PIR_NEW(a, pir_corner, pieces->corner_count);
    pieces->group = PIR_NEW(a, uint32_t, pieces->count);
    if (!pieces->start || !pieces->corner || !pieces->group) {
        pir_pieces_finish(pieces, a);
        return PIR_ERR_MEMORY;
    }
    // every piece alone, but for the facets of a segment, which have no area
    for (uint32_t i = 0; i < pieces->count; i++)
        pieces->group[i] = i;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        sum->rotated[f] = pir_rotated_normal(sum, f);
        if (p->artificial)
            pieces->group[f] = PIR_DROPPED;
    }
    for (uint32_t g = 0; g < q->facet_count && q->artificial; g++)
        pieces->group[p->facet_count + g] = PIR_DROPPED;
    uint32_t piece = add_facets(pieces, p, sum->fv, true, 0);
    piece = add_facets(pieces, q, sum->vf, false, piece);
    for (uint32_t edge = 0; edge < p->edge_count; edge++)
        for (uint32_t slot = sum->first[edge]; slot != PIR_NO_CROSSING; slot = sum->crossings.next[slot], piece++) {
            add_crossing(pieces, sum, slot, piece);
            group_crossing(pieces, sum, slot, piece);
        }
    for (uint32_t i = 0; i < pieces->count; i++)
        if (pieces->group[i] != PIR_DROPPED)
            pieces->group[i] = find_group(pieces->group, i);
    return PIR_OK;
}

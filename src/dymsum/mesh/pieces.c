/* SPDX-License-Identifier: MIT */
/*
 * Pieces of the sum, and which are coplanar.
 *
 * The pairing is that of a perturbed rotation. At the true one, a crossing of arcs e and d may coincide with an end of
 * one of them: exactly when one of its four signs is zero. Unless e and d are parallel, and the piece has no area, the
 * crossing then is that end: both e's vector and d are perpendicular to the end's normal. So pieces are joined along
 * such zeros alone. That is complete: whenever two pieces lie in one facet of the true sum, a facet of P or Q does too,
 * and each crossing that coincides with it has a zero that names it.
 *
 * A crossing that coincides with a facet f of P and a facet g of Q says that their normals are equal. One that
 * coincides with f alone says that the edge of Q lies along f, and all such crossings of f name that edge. So crossings
 * leave at most one note with each facet. Once f and g are known to coincide, no sign is asked of a crossing between an
 * arc that ends in f and one that ends in g: it coincides with both, or its edges are parallel. That makes sums with
 * many ties cheap: two prisms on one plane have as many such crossings as the product of their sides.
 *
 * Where an arc is half a circle, as in the map of a polygon, the end may also be the antipode of the crossing. One more
 * exact sign tells. Of two half circles both pairs of ends must be known to coincide before signs are saved.
 */
#include "dymsum/mesh/pieces.h"

#include "base/layout.h"

static pir_layout layout_of(pir_sum_pieces *pieces, const pir_pairing *pairing) {
    size_t words = (size_t)pairing->crossings.used / 64 + 1;
    return (pir_layout){{PIR_ROW(pieces->of_p, pairing->p->facet_count), PIR_ROW(pieces->of_q, pairing->q->facet_count),
                         PIR_ROW(pieces->alone, words)}};
}

void pir_pieces_finish(pir_sum_pieces *pieces, const pir_pairing *pairing) {
    pir_layout layout = layout_of(pieces, pairing);
    pir_layout_free(&pairing->allocator, &layout);
    *pieces = (pir_sum_pieces){0};
}

/* Whether s(a, b) is exactly zero, given its value by doubles. */
static bool is_tie(const pir_posed *posed, double value, const pir_int3 *a, const pir_int3 *b) {
    return pir_filter_sign(value) == 0 && pir_sign_true(posed->signs, a, b) == 0;
}

/* The facets at the ends of a crossing's arcs. */
struct crossing_ends {
    uint32_t p[2], q[2];
};

/* Whether the crossing is known to be part of a merged facet, or to have no area, from the notes so far. */
static bool is_known(const pir_sum_pieces *pieces, const pir_posed *posed, const struct crossing_ends *ends) {
    bool half_circles = posed->p->dimension < 3 && posed->q->dimension < 3;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            if (pieces->of_p[ends->p[i]].facet == ends->q[j])
                return !half_circles || pieces->of_p[ends->p[1 - i]].facet == ends->q[1 - j];
    return false;
}

/*
 * The facet of P that the crossing coincides with, or PIR_NO_FACE. The hidden facets of a segment have no area and do
 * not count.
 */
static uint32_t coinciding_p(const pir_posed *posed, const pir_edge_pair *pair, const struct crossing_ends *ends,
                             const bool tie[2]) {
    for (int i = 0; i < 2 && !posed->p->artificial; i++)
        if (tie[i] &&
            (posed->p->dimension == 3 || pir_edges_point_along(posed, pair, (pir_facet_of){true, ends->p[i]})))
            return ends->p[i];
    return PIR_NO_FACE;
}

static uint32_t coinciding_q(const pir_posed *posed, const pir_edge_pair *pair, const struct crossing_ends *ends,
                             const bool tie[2]) {
    for (int i = 0; i < 2 && !posed->q->artificial; i++)
        if (tie[i] &&
            (posed->q->dimension == 3 || pir_edges_point_along(posed, pair, (pir_facet_of){false, ends->q[i]})))
            return ends->q[i];
    return PIR_NO_FACE;
}

/* Whether a crossing is a facet alone. Where it is not, it is noted with the facets that it coincides with. */
static bool check_crossing(pir_sum_pieces *pieces, const pir_posed *posed, const pir_edge_pair *pair) {
    const pir_polytope *p = posed->p, *q = posed->q;
    const struct crossing_ends ends = {{p->left[pair->half], pir_right(p, pair->half)},
                                       {q->left[pair->h], pir_right(q, pair->h)}};
    if (is_known(pieces, posed, &ends))
        return false;
    pir_int3 e = pir_half_exact(p, pair->half), d = pir_half_exact(q, pair->h);
    bool tie_p[2], tie_q[2];
    for (int i = 0; i < 2; i++) {
        pir_int3 f = pir_normal_exact(p, ends.p[i]), g = pir_normal_exact(q, ends.q[i]);
        tie_p[i] = is_tie(posed, pir_vec_dot(posed->normal[ends.p[i]], pair->d), &f, &d);
        tie_q[i] = is_tie(posed, pir_vec_dot(pair->e, q->normal[ends.q[i]]), &e, &g);
    }
    if (!tie_p[0] && !tie_p[1] && !tie_q[0] && !tie_q[1])
        return true;
    if (pir_edges_are_parallel(posed, pair))
        return false;
    uint32_t f = coinciding_p(posed, pair, &ends, tie_p), g = coinciding_q(posed, pair, &ends, tie_q);
    if (f != PIR_NO_FACE)
        pieces->of_p[f] = (pir_sum_face){g, pair->h};
    if (g != PIR_NO_FACE)
        pieces->of_q[g] = (pir_sum_face){f, pair->half};
    return f == PIR_NO_FACE && g == PIR_NO_FACE;
}

pir_status pir_pieces_make(pir_sum_pieces *pieces, const pir_pairing *pairing, const pir_posed *posed) {
    const pir_polytope *p = posed->p, *q = posed->q;
    *pieces = (pir_sum_pieces){0};
    pir_layout layout = layout_of(pieces, pairing);
    if (!pir_layout_new(&pairing->allocator, &layout)) {
        pir_pieces_finish(pieces, pairing);
        return PIR_ERR_MEMORY;
    }
    for (uint32_t f = 0; f < p->facet_count; f++)
        pieces->of_p[f] = (pir_sum_face){PIR_NO_FACE, PIR_NO_FACE};
    for (uint32_t g = 0; g < q->facet_count; g++)
        pieces->of_q[g] = (pir_sum_face){PIR_NO_FACE, PIR_NO_FACE};
    for (uint32_t edge = 0; edge < p->edge_count; edge++) {
        pir_edge_pair pair = {.half = p->edge_half[edge], .e = pir_posed_direction(posed, p->edge_half[edge])};
        for (uint32_t slot = pir_crossing_first(pairing, edge); slot != PIR_NO_CROSSING;
             slot = pir_crossing_next(pairing, slot)) {
            pair.h = pir_crossing_half(pairing, slot);
            pair.d = q->direction[pair.h];
            if (!check_crossing(pieces, posed, &pair))
                continue;
            pieces->alone[slot / 64] |= (uint64_t)1 << slot % 64;
            pieces->alone_count++;
        }
    }
    return PIR_OK;
}

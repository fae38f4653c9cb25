/* SPDX-License-Identifier: MIT */
/* Overlap from a surface in D: see overlap.h. */
#include "pair/overlap.h"

#include "query/decide/witness.h"

/* Bounds on the vertices added in one search; most take none to three. */
#define MOST_ADDED 64

/* Facets that one search may prove; a body of many equal ones has more, and is left to the whole sum. */
#define MOST_FACETS 32

/* --- triangles and facets --- */

static uint32_t corner_of(const pir_overlap *overlap, uint32_t t, int k) {
    return overlap->surface->corner[k][t];
}

/* The vertices of P and Q at the corners of a triangle. */
static void vertices_of(const pir_overlap *overlap, uint32_t t, uint32_t a[3], uint32_t b[3]) {
    for (int k = 0; k < 3; k++) {
        a[k] = overlap->surface->a[corner_of(overlap, t, k)];
        b[k] = overlap->surface->b[corner_of(overlap, t, k)];
    }
}

static bool has_vertex(const pir_polytope *p, pir_feature face, uint32_t v) {
    if (face.kind == PIR_FEATURE_VERTEX)
        return face.index == v;
    if (face.kind == PIR_FEATURE_EDGE) {
        uint32_t half = p->edge_half[face.index];
        return p->origin[half] == v || p->target[half] == v;
    }
    for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++)
        if (p->left[h] == face.index)
            return true;
    return false;
}

/* Whether a triangle lies in a true facet of D. */
static bool lies_in(const pir_overlap *overlap, uint32_t t, const pir_facet *facet) {
    const pir_frame *frame = overlap->exact->frame;
    for (int k = 0; k < 3; k++) {
        uint32_t i = corner_of(overlap, t, k);
        if (!has_vertex(frame->p.polytope, facet->faces.p, overlap->surface->a[i]) ||
            !has_vertex(frame->q.polytope, facet->faces.q, overlap->surface->b[i]))
            return false;
    }
    return true;
}

/* The piece that the features at a triangle's corners make, with its normal on the triangle's outer side. */
static bool piece_at(const pir_overlap *overlap, uint32_t t, pir_piece *ret_piece) {
    const pir_frame *frame = overlap->exact->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    uint32_t a[3], b[3];
    vertices_of(overlap, t, a, b);
    pir_feature of_p = pir_feature_of(p, a, 3), of_q = pir_feature_of(q, b, 3);
    pir_vec3 out = pir_surface_normal(overlap->room, t);
    if (of_p.kind == PIR_FEATURE_FACET) {
        // of a polygon's two facets, the one that faces outwards
        pir_vec3 n = pir_mat_apply(&frame->r, p->normal[of_p.index]);
        if (p->dimension == 2 && pir_vec_dot(n, out) < 0)
            of_p.index = 1 - of_p.index;
        *ret_piece = (pir_piece){PIR_FACET_FV, of_p.index, b[0]};
        return true;
    }
    if (of_q.kind == PIR_FEATURE_FACET) {
        if (q->dimension == 2 && pir_vec_dot(q->normal[of_q.index], out) < 0)
            of_q.index = 1 - of_q.index;
        *ret_piece = (pir_piece){PIR_FACET_VF, a[0], of_q.index};
        return true;
    }
    if (of_p.kind != PIR_FEATURE_EDGE || of_q.kind != PIR_FEATURE_EDGE)
        return false;
    uint32_t half = q->edge_half[of_q.index];
    pir_vec3 n = pir_vec_cross(q->direction[half], pir_mat_apply(&frame->r, p->direction[p->edge_half[of_p.index]]));
    *ret_piece = (pir_piece){PIR_FACET_EE, of_p.index, pir_vec_dot(n, out) > 0 ? half : q->twin[half]};
    return true;
}

/* --- expansion --- */

/*
 * Adds the vertex of D farthest along the normal of triangle t, where it is beyond the triangle by more than
 * rounding.
 */
static bool expand(const pir_overlap *overlap, uint32_t t) {
    const pir_frame *frame = overlap->exact->frame;
    pir_vec3 n = pir_surface_normal(overlap->room, t);
    double length = sqrt(pir_vec_dot(n, n));
    n = pir_vec_scale(n, 1 / length);
    uint32_t first = corner_of(overlap, t, 0);
    uint32_t a = pir_climb(frame->p.polytope, pir_mat_apply_transposed(&frame->r, n), overlap->surface->a[first]);
    uint32_t b = pir_climb(frame->q.polytope, n, overlap->surface->b[first]);
    pir_vec3 w = pir_vec_sub(pir_frame_vertex(frame, a, b), overlap->room->centre);
    if (!(pir_vec_dot(n, w) * length > overlap->room->det[t] + overlap->room->det_error))
        return false;
    overlap->statistics->supports++;
    return pir_surface_add(overlap->surface, frame, t, a, b, overlap->room);
}

/* --- surfaces --- */

bool pir_overlap_place(const pir_overlap *overlap) {
    uint32_t worst;
    const pir_placement *placement = overlap->placement;
    return pir_surface_place(overlap->surface, overlap->exact->frame, placement->x, placement->error, placement->reach,
                             overlap->room, &worst);
}

/* The tetrahedron of four vertices of D about a point; false where that is not certainly inside. */
static bool begin_about(const pir_overlap *overlap, const uint32_t a[4], const uint32_t b[4], pir_vec3 centre) {
    const pir_placement *placement = overlap->placement;
    uint32_t worst;
    for (int turned = 0; turned < 2; turned++) {
        const uint32_t i = turned ? 1 : 0, j = 1 - i;
        pir_surface_begin(overlap->surface, (const uint32_t[4]){a[i], a[j], a[2], a[3]},
                          (const uint32_t[4]){b[i], b[j], b[2], b[3]});
        if (pir_surface_place(overlap->surface, overlap->exact->frame, centre, placement->error, placement->reach,
                              overlap->room, &worst))
            return true;
    }
    return false;
}

bool pir_overlap_begin(const pir_overlap *overlap, const pir_simplex *simplex) {
    overlap->statistics->begun++;
    return simplex->tried == 4 && begin_about(overlap, simplex->a, simplex->b, overlap->placement->x);
}

/*
 * The triangle that x is deepest inside of, or beyond, the least: its distance times the length of its normal less
 * errors.
 */
static uint32_t least_about(const pir_overlap *overlap, pir_vec3 way, double *ret_low) {
    const pir_surface_room *room = overlap->room;
    uint32_t least = 0;
    double low = HUGE_VAL;
    for (uint32_t t = 0; t < overlap->surface->count; t++) {
        pir_vec3 n = pir_surface_normal(room, t);
        double d =
            (room->det[t] - pir_vec_dot(n, way) - 2 * room->det_error) / (sqrt(pir_vec_dot(n, n)) + room->normal_error);
        if (d < low)
            low = d, least = t;
    }
    *ret_low = low;
    return least;
}

bool pir_overlap_widen(const pir_overlap *overlap, pir_vec3 inner, pir_facet *ret_facet, bool *ret_some) {
    const pir_placement *placement = overlap->placement;
    pir_placement within = *placement;
    pir_simplex simplex = {.count = 0};
    uint32_t steps = 0;
    *ret_some = false;
    within.x = inner;
    pir_descend_to_point(overlap->exact->frame, &within, 0, &simplex, &steps);
    overlap->statistics->begun++;
    if (simplex.tried != 4 || !begin_about(overlap, simplex.a, simplex.b, inner))
        return false;
    pir_vec3 way = pir_vec_sub(placement->x, inner);
    for (uint32_t added = 0; added < MOST_ADDED; added++) {
        double low;
        uint32_t t = least_about(overlap, way, &low);
        if (low > 0 && pir_overlap_place(overlap))
            return true;
        pir_piece piece;
        if (low <= 0 && !expand(overlap, t)) {
            *ret_some = piece_at(overlap, t, &piece) && pir_facet_prove(overlap->exact, piece, ret_facet);
            return false;
        }
        if (low > 0)
            return false;
    }
    return false;
}

/* --- the least facet --- */

/* The facets proven so far, triangles that are known to lie in them, and the least. */
struct found {
    uint32_t count;
    pir_facet facet[MOST_FACETS];
    uint64_t covered;
    pir_least least;
};

/* Whether triangle t lies in a facet that is proven. */
static bool is_covered(const pir_overlap *overlap, uint32_t t, const struct found *found) {
    for (uint32_t i = found->count; i-- > 0;)
        if (lies_in(overlap, t, &found->facet[i]))
            return true;
    return false;
}

/* Proves that triangle t lies in a facet of D, and takes that. */
static bool take_facet(const pir_overlap *overlap, uint32_t t, struct found *found) {
    pir_piece piece;
    pir_facet *facet = &found->facet[found->count];
    if (found->count == MOST_FACETS || !piece_at(overlap, t, &piece) ||
        !pir_facet_prove(overlap->exact, piece, facet) || !lies_in(overlap, t, facet))
        return false;
    found->count++;
    pir_least_offer_facet(overlap->exact, overlap->placement, &found->least, facet);
    found->covered |= 1ull << t;
    return true;
}

/* The triangle of least distance that is not covered; the count where none is. */
static uint32_t next_open(const pir_overlap *overlap, const struct found *found) {
    uint32_t next = overlap->surface->count;
    double low = HUGE_VAL;
    for (uint32_t t = 0; t < overlap->surface->count; t++)
        if (overlap->room->low[t] < low && !(found->covered >> t & 1))
            low = overlap->room->low[t], next = t;
    return next;
}

/* What the least slack is not above. */
static double bound_of(const pir_overlap *overlap, const pir_least *least) {
    if (!least->some)
        return HUGE_VAL;
    const pir_facet *facet = &least->facet;
    return facet->h - pir_vec_dot(facet->n, overlap->placement->x) + overlap->placement->error * facet->err;
}

bool pir_overlap_least(const pir_overlap *overlap, pir_facet *ret_facet) {
    struct found found;
    found.count = 0;
    found.covered = 0;
    found.least.some = false;
    for (uint32_t added = 0; added <= MOST_ADDED;) {
        uint32_t t = next_open(overlap, &found);
        if (t == overlap->surface->count || overlap->room->low[t] > bound_of(overlap, &found.least)) {
            *ret_facet = found.least.facet;
            return found.least.some;
        }
        if (is_covered(overlap, t, &found)) {
            found.covered |= 1ull << t;
            continue;
        }
        if (take_facet(overlap, t, &found))
            continue;
        if (!expand(overlap, t))
            return false;
        // triangles have other numbers now
        found.covered = 0;
        added++;
    }
    return false;
}

void pir_overlap_nearest(const pir_overlap *overlap, uint32_t a[3], uint32_t b[3]) {
    uint32_t nearest = 0;
    for (uint32_t t = 1; t < overlap->surface->count; t++)
        nearest = overlap->room->low[t] < overlap->room->low[nearest] ? t : nearest;
    vertices_of(overlap, nearest, a, b);
}

/* SPDX-License-Identifier: MIT */
/* Overlap from a surface in D: see overlap.h. */
#include "pair/overlap.h"

#include "query/decide/witness.h"

/* Bounds on the vertices added in one search; most take none to three. */
#define MOST_ADDED 64

/* The same for a surface that x has left. */
#define MOST_REPAIRS 8

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

/*
 * Whether corner i of the surface is in a true facet of D. A vertex is asked for before a facet, which takes longer.
 */
static inline bool is_in(const pir_overlap *overlap, uint32_t i, const pir_facet *facet) {
    const pir_frame *frame = overlap->exact->frame;
    uint32_t a = overlap->surface->a[i], b = overlap->surface->b[i];
    if (facet->faces.p.kind == PIR_FEATURE_FACET)
        return has_vertex(frame->q.polytope, facet->faces.q, b) && has_vertex(frame->p.polytope, facet->faces.p, a);
    return has_vertex(frame->p.polytope, facet->faces.p, a) && has_vertex(frame->q.polytope, facet->faces.q, b);
}

/* Those of the corners whose vertices of a body, `at`, a face of it has. */
static uint32_t corners_at(const pir_overlap *overlap, const pir_polytope *p, pir_feature face, const uint32_t *at,
                           uint32_t corners) {
    uint32_t in = 0;
    if (face.kind == PIR_FEATURE_VERTEX)
        return corners & overlap->room->loops->either(at, face.index, face.index);
    if (face.kind == PIR_FEATURE_EDGE) {
        uint32_t half = p->edge_half[face.index];
        return corners & overlap->room->loops->either(at, p->origin[half], p->target[half]);
    }
    for (uint32_t rest = corners; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest);
        in |= (uint32_t)has_vertex(p, face, at[i]) << i;
    }
    return in;
}

/* The corners that are: bit i for corner i. */
static uint32_t corners_in(const pir_overlap *overlap, const pir_facet *facet) {
    const pir_frame *frame = overlap->exact->frame;
    const pir_surface *surface = overlap->surface;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    if (facet->faces.p.kind == PIR_FEATURE_FACET)
        return corners_at(overlap, p, facet->faces.p, surface->a,
                          corners_at(overlap, q, facet->faces.q, surface->b, surface->used));
    return corners_at(overlap, q, facet->faces.q, surface->b,
                      corners_at(overlap, p, facet->faces.p, surface->a, surface->used));
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

/* What came of an expansion: nothing is beyond the triangle, the surface has changed, or it could not. */
enum expansion { NOTHING_BEYOND, CHANGED, STUCK };

/* Bodies of more vertices than this have corners of triangles that are far from what is beyond those. */
#define FEW_VERTICES 32

/*
 * The vertex of a body farthest along a direction: uphill from the first corner of triangle t, or from another or a
 * landmark where those are farther. `at` are the vertices at corners.
 */
static inline uint32_t climb(const pir_overlap *overlap, const pir_body *body, const uint32_t *at, uint32_t t,
                             pir_vec3 n, double least) {
    uint32_t from = at[corner_of(overlap, t, 0)];
    if (body->polytope->vertex_count > FEW_VERTICES) {
        const uint32_t others[3] = {at[corner_of(overlap, t, 1)], at[corner_of(overlap, t, 2)],
                                    body->landmarks[pir_landmark_of(n)]};
        double far = pir_vec_dot(n, body->vertex[from]);
        for (int k = 0; k < 3; k++) {
            double other = pir_vec_dot(n, body->vertex[others[k]]);
            from = other > far ? others[k] : from;
            far = other > far ? other : far;
        }
    }
    return pir_climb_above(body->polytope, n, least, from);
}

/*
 * Adds the vertex of D farthest along the normal of triangle t, where it is beyond the triangle by more than
 * rounding, or makes room for it. *ret_corner is its number, PIR_SURFACE_CORNERS where it was no new one.
 *
 * A corner of the surface that is beyond goes first: as the bodies turn the surface does not stay convex, and what sees
 * a vertex from within a dent is seldom a disk. Where the centre has left the surface that seldom helps.
 */
static enum expansion expand(const pir_overlap *overlap, uint32_t t, uint32_t *ret_corner) {
    const pir_frame *frame = overlap->exact->frame;
    *ret_corner = PIR_SURFACE_CORNERS;
    if (overlap->room->plane.low[t] > 0 && pir_surface_turn(overlap->surface, t, overlap->room))
        return CHANGED;
    pir_vec3 n = pir_surface_normal(overlap->room, t);
    double least = PIR_LEAST_SLOPE * sqrt(pir_vec_dot(n, n));
    pir_vec3 back = pir_mat_apply_transposed(&frame->r, n);
    uint32_t a = climb(overlap, &frame->p, overlap->surface->a, t, back, least);
    uint32_t b = climb(overlap, &frame->q, overlap->surface->b, t, n, least);
    pir_vec3 w = pir_vec_sub(pir_frame_vertex(frame, a, b), overlap->room->centre);
    if (!(pir_vec_dot(n, w) > overlap->room->plane.det[t] + overlap->room->det_error))
        return NOTHING_BEYOND;
    // room is made first; the vertex comes when the triangle is met again
    if (!pir_surface_has_room(overlap->surface))
        return pir_surface_trim(overlap->surface, overlap->room) ? CHANGED : STUCK;
    overlap->statistics->supports++;
    const pir_surface_vertex vertex = {a, b, w};
    *ret_corner = pir_surface_add(overlap->surface, t, &vertex, overlap->room);
    return *ret_corner < PIR_SURFACE_CORNERS ? CHANGED : STUCK;
}

/* --- surfaces --- */

bool pir_overlap_place(const pir_overlap *overlap) {
    const pir_placement *placement = overlap->placement;
    return pir_surface_place(overlap->surface, overlap->exact->frame, placement->x, placement->error, placement->reach,
                             overlap->room);
}

/* The triangle that is least far from x. */
static uint32_t least_of(const pir_overlap *overlap) {
    const pir_surface_loops *loops = overlap->room->loops;
    double low = loops->least(overlap->surface, overlap->room, UINT64_MAX);
    uint64_t least = loops->below(overlap->surface, overlap->room, low);
    return least != 0 ? (uint32_t)__builtin_ctzll(least) : 0;
}

/* The facet of D that a triangle lies in which nothing is beyond. */
static pir_about facet_at(const pir_overlap *overlap, uint32_t t, pir_facet *ret_facet) {
    pir_piece piece;
    bool some = piece_at(overlap, t, &piece) && pir_facet_prove(overlap->exact, piece, ret_facet);
    return some ? PIR_ABOUT_FACET : PIR_ABOUT_NOTHING;
}

pir_about pir_overlap_repair(const pir_overlap *overlap, pir_facet *ret_facet) {
    for (uint32_t added = 0; added < MOST_REPAIRS; added++) {
        uint32_t t = least_of(overlap), corner;
        if (overlap->room->plane.low[t] > 0)
            return PIR_ABOUT_X;
        enum expansion expansion = expand(overlap, t, &corner);
        if (expansion == NOTHING_BEYOND)
            return facet_at(overlap, t, ret_facet);
        if (expansion == STUCK)
            return PIR_ABOUT_NOTHING;
    }
    return overlap->room->plane.low[least_of(overlap)] > 0 ? PIR_ABOUT_X : PIR_ABOUT_NOTHING;
}

/* The tetrahedron of four vertices of D, placed about a point. Returns whether that is certainly inside. */
static bool begin_about(const pir_overlap *overlap, const pir_simplex *simplex, pir_vec3 centre) {
    const pir_placement *placement = overlap->placement;
    const uint32_t *a = simplex->a, *b = simplex->b;
    bool certain = false;
    for (int turned = 0; turned < 2; turned++) {
        const uint32_t i = turned ? 1 : 0, j = 1 - i;
        pir_surface_begin(overlap->surface, (const uint32_t[4]){a[i], a[j], a[2], a[3]},
                          (const uint32_t[4]){b[i], b[j], b[2], b[3]});
        certain = pir_surface_place(overlap->surface, overlap->exact->frame, centre, placement->error, placement->reach,
                                    overlap->room);
        // the sum is its volume, six times, wherever the centre is
        const double *det = overlap->room->plane.det;
        if (certain || det[0] + det[1] + det[2] + det[3] > 0)
            break;
    }
    return certain;
}

pir_about pir_overlap_begin(const pir_overlap *overlap, const pir_simplex *simplex, pir_facet *ret_facet) {
    overlap->statistics->begun++;
    if (simplex->tried != 4)
        return PIR_ABOUT_NOTHING;
    if (begin_about(overlap, simplex, overlap->placement->x))
        return PIR_ABOUT_X;
    return pir_overlap_repair(overlap, ret_facet);
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
        double d = (room->plane.det[t] - pir_vec_dot(n, way) - 2 * room->det_error) /
                   (sqrt(pir_vec_dot(n, n)) + room->normal_error);
        if (d < low)
            low = d, least = t;
    }
    *ret_low = low;
    return least;
}

pir_about pir_overlap_widen(const pir_overlap *overlap, pir_vec3 inner, pir_facet *ret_facet) {
    const pir_placement *placement = overlap->placement;
    pir_placement within = *placement;
    pir_simplex simplex = {.count = 0};
    uint32_t steps = 0;
    within.x = inner;
    pir_descend_to_point(overlap->exact->frame, &within, 0, &simplex, &steps);
    overlap->statistics->begun++;
    if (simplex.tried != 4 || !begin_about(overlap, &simplex, inner))
        return PIR_ABOUT_NOTHING;
    pir_vec3 way = pir_vec_sub(placement->x, inner);
    for (uint32_t added = 0; added < MOST_ADDED; added++) {
        double low;
        uint32_t t = least_about(overlap, way, &low), corner;
        if (low > 0)
            return pir_overlap_place(overlap) ? PIR_ABOUT_X : PIR_ABOUT_NOTHING;
        if (expand(overlap, t, &corner) != CHANGED)
            return facet_at(overlap, t, ret_facet);
    }
    return PIR_ABOUT_NOTHING;
}

/* --- the least facet --- */

/* The facets proven so far, the corners of the surface that are in each, and the least. */
struct found {
    uint32_t count;
    pir_facet facet[MOST_FACETS];
    uint32_t corners[MOST_FACETS];
    pir_least least;
};

/* Takes the facet after the last, which has these corners. True where it is the least of all. */
static bool add_facet(const pir_overlap *overlap, uint32_t corners, struct found *found) {
    const pir_facet *facet = &found->facet[found->count];
    found->corners[found->count] = corners;
    pir_least_offer_facet(overlap->exact, overlap->placement, &found->least, facet);
    bool is_least = pir_facet_same(facet, &found->least.facet);
    found->count++;
    return is_least;
}

/* Proves that triangle t lies in a facet of D, and takes that. */
static bool take_facet(const pir_overlap *overlap, uint32_t t, struct found *found) {
    pir_piece piece;
    pir_same_facet same;
    pir_facet *facet = &found->facet[found->count];
    if (found->count == MOST_FACETS || !piece_at(overlap, t, &piece))
        return false;
    bool has_same =
        overlap->prove_same(overlap->exact->frame, overlap->placement, piece, NULL, &same) == PIR_SAME_PROVEN;
    if (has_same)
        *facet = same.facet;
    else if (!pir_facet_prove(overlap->exact, piece, facet))
        return false;
    uint32_t corners = corners_in(overlap, facet);
    if (!(overlap->room->loops->within(overlap->surface, corners) >> t & 1))
        return false;
    if (add_facet(overlap, corners, found) && has_same) {
        *overlap->same = same;
        *overlap->has_same = true;
    }
    return true;
}

/* After a corner was added. */
static void find_corner(const pir_overlap *overlap, uint32_t corner, struct found *found) {
    for (uint32_t i = 0; i < found->count; i++) {
        found->corners[i] &= ~(1u << corner);
        found->corners[i] |= (uint32_t)is_in(overlap, corner, &found->facet[i]) << corner;
    }
}

/*
 * The triangle of least distance that is in no facet that is proven; the count where none is, or that is farther than
 * `limit`.
 */
static uint32_t next_open(const pir_overlap *overlap, const struct found *found, double limit) {
    const pir_surface_loops *loops = overlap->room->loops;
    const pir_surface *surface = overlap->surface;
    uint64_t open = pir_surface_first(surface->count);
    for (uint32_t i = 0; i < found->count; i++)
        open &= ~loops->within(surface, found->corners[i]);
    double least = loops->least(surface, overlap->room, open);
    if (open == 0 || !(least <= limit))
        return surface->count;
    return (uint32_t)__builtin_ctzll(open & loops->below(surface, overlap->room, least));
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
    found.least.some = false;
    if (*overlap->has_same) {
        found.facet[0] = overlap->same->facet;
        add_facet(overlap, corners_in(overlap, &found.facet[0]), &found);
    }
    for (uint32_t added = 0; added <= MOST_ADDED;) {
        double bound = bound_of(overlap, &found.least);
        uint32_t t = next_open(overlap, &found, bound), corner;
        if (t == overlap->surface->count) {
            *ret_facet = found.least.facet;
            return found.least.some;
        }
        enum expansion expansion = expand(overlap, t, &corner);
        if (expansion == STUCK || (expansion == NOTHING_BEYOND && !take_facet(overlap, t, &found)))
            return false;
        if (expansion == CHANGED) {
            if (corner < PIR_SURFACE_CORNERS)
                find_corner(overlap, corner, &found);
            added++;
        }
    }
    return false;
}

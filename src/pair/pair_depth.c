/* SPDX-License-Identifier: MIT */
/*
 * The depth of a pair that overlaps: the facet of D of least slack at x, proven.
 *
 * Of small bodies all facets that D can have are compared (axes/axes.h). Of others a closed surface of vertex pairs
 * in D is kept from answer to answer (surface/inner_surface.h). Where the surface about x is certain, x is inside of D.
 * The true facets of D that triangles of the surface lie in are proven by exact slopes (facet.h), and compared exactly.
 * The search ends when each triangle either lies in a proven facet or is farther from x, for certain, than the least of
 * these: then that is the least of all facets of D, and every facet that ties with it is among those compared.
 *
 * Where the facet that holds the foot of x is known, most triangles need no look: they were farther from x by more than
 * they can have come nearer since (surface/kept_lows.h).
 */
#include "pair/pair_task.h"

#include "pair/surface/kept_lows.h"
#include "query/decide/touch.h"
#include "query/walk/foot.h"
#include "query/walk/foot_walk.h"

/* Bounds on the vertices added in one search; most take none to three. */
#define MOST_ADDED 64

/* From so many on, discs about the feet of x are looked for, where a facet has so many corners. */
#define MANY_ADDED   24
#define MANY_CORNERS 64

/* The most walks to a foot of x in one search: each end of D takes one. */
#define MOST_WALKS 8

/* Directions at a greater cosine are at one end of D. */
#define SAME_END 0.875

/* The most repairs of a surface that x has left. */
#define MOST_REPAIRS 8

/* Facets that one search may prove; a body of many equal ones has more, and is left to the whole sum. */
#define MOST_FACETS 32

/* --- a surface at one placement --- */

struct overlap {
    pir_task *task;
    pir_exact *exact;
    const pir_placement *placement;
    pir_surface *surface;
    pir_surface_room *room;
    pir_pair_statistics *statistics;
};

/* The outcome of a surface: nothing, a facet of D that x is within rounding of or beyond, or a certain one about x. */
enum about { ABOUT_NOTHING, ABOUT_FACET, ABOUT_X };

/* --- triangles and facets --- */

static uint32_t corner_of(const struct overlap *overlap, uint32_t t, int k) {
    return overlap->surface->corner[k][t];
}

/* The vertices of P and Q at the corners of a triangle. */
static void vertices_of(const struct overlap *overlap, uint32_t t, uint32_t a[3], uint32_t b[3]) {
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

/* The corners, of those given, whose vertex `at` of body p lies in the face; bit i stands for corner i. */
static uint32_t corners_at(const struct overlap *overlap, const pir_polytope *p, pir_feature face, const uint32_t *at,
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

/* The corners, of those given, that lie in a true facet of D; bit i stands for corner i. The cheaper of both faces, a
   vertex before a facet, is asked first. */
static uint32_t corners_in(const struct overlap *overlap, const pir_facet *facet, uint32_t corners) {
    const pir_frame *frame = overlap->exact->frame;
    const pir_surface *surface = overlap->surface;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    if (facet->faces.p.kind == PIR_FEATURE_FACET)
        return corners_at(overlap, p, facet->faces.p, surface->a,
                          corners_at(overlap, q, facet->faces.q, surface->b, corners));
    return corners_at(overlap, q, facet->faces.q, surface->b,
                      corners_at(overlap, p, facet->faces.p, surface->a, corners));
}

/* The piece that the features at a triangle's corners make, with its normal on the triangle's outer side. */
static bool piece_at(const struct overlap *overlap, uint32_t t, pir_piece *ret_piece) {
    const pir_frame *frame = overlap->exact->frame;
    uint32_t a[3], b[3];
    vertices_of(overlap, t, a, b);
    const pir_witness faces = {pir_feature_of(frame->p.polytope, a, 3), pir_feature_of(frame->q.polytope, b, 3)};
    return pir_piece_of(frame, faces, a[0], b[0], pir_surface_normal(overlap->room, t), ret_piece);
}

/* --- expansion --- */

/* The outcome of an expansion: nothing is beyond the triangle, the surface has changed, or it could not. */
enum expansion { NOTHING_BEYOND, CHANGED, STUCK };

/* Bodies of more vertices than this have corners of triangles that are far from what is beyond those. */
#define FEW_VERTICES 32

/*
 * The vertex of a body farthest along a direction: uphill from the first corner of triangle t, or from another or a
 * landmark where those are farther. `at` are the vertices at corners.
 */
static inline uint32_t climb(const struct overlap *overlap, const pir_body *body, const uint32_t *at, uint32_t t,
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
static enum expansion expand(const struct overlap *overlap, uint32_t t, uint32_t *ret_corner) {
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

/* Places the surface about x. True where it is certain: x then is inside. */
static bool place(const struct overlap *overlap) {
    const pir_placement *placement = overlap->placement;
    return pir_surface_place(overlap->surface, overlap->exact->frame, placement->x, placement->error, placement->reach,
                             overlap->room);
}

/* The triangle that is least far from x. */
static uint32_t least_of(const struct overlap *overlap) {
    const pir_surface_loops *loops = overlap->room->loops;
    double low = loops->least(overlap->surface, overlap->room, UINT64_MAX);
    uint64_t least = loops->below(overlap->surface, overlap->room, low);
    return least != 0 ? (uint32_t)__builtin_ctzll(least) : 0;
}

/* The facet of D that a triangle lies in which nothing is beyond. */
static enum about facet_at(const struct overlap *overlap, uint32_t t, pir_facet *ret_facet) {
    pir_piece piece;
    bool is_facet = piece_at(overlap, t, &piece) && pir_facet_prove(overlap->exact, piece, ret_facet);
    return is_facet ? ABOUT_FACET : ABOUT_NOTHING;
}

/* Expands a placed surface that x has left. */
static enum about repair(const struct overlap *overlap, pir_facet *ret_facet) {
    for (uint32_t added = 0; added < MOST_REPAIRS; added++) {
        uint32_t t = least_of(overlap), corner;
        if (overlap->room->plane.low[t] > 0)
            return ABOUT_X;
        enum expansion expansion = expand(overlap, t, &corner);
        if (expansion == NOTHING_BEYOND)
            return facet_at(overlap, t, ret_facet);
        if (expansion == STUCK)
            return ABOUT_NOTHING;
    }
    return overlap->room->plane.low[least_of(overlap)] > 0 ? ABOUT_X : ABOUT_NOTHING;
}

/* The tetrahedron of four vertices of D, placed about a point. Returns whether that is certainly inside. */
static bool begin_about(const struct overlap *overlap, const pir_simplex *simplex, pir_vec3 centre) {
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

/* Makes a surface from the four vertices that a descent ended with, if there are so many. */
static enum about begin_surface(const struct overlap *overlap, const pir_simplex *simplex, pir_facet *ret_facet) {
    overlap->statistics->begun++;
    if (simplex->tried != 4)
        return ABOUT_NOTHING;
    if (begin_about(overlap, simplex, overlap->placement->x))
        return ABOUT_X;
    return repair(overlap, ret_facet);
}

/*
 * The triangle that x is deepest inside of, or beyond, the least: its distance times the length of its normal less
 * errors.
 */
static uint32_t least_about(const struct overlap *overlap, pir_vec3 way, double *ret_low) {
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

/* Four vertices of D in directions that are as far from each other as can be. */
static pir_simplex four_corners(const pir_frame *frame) {
    static const pir_vec3 along[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    pir_simplex simplex = {.tried = 4};
    for (int k = 0; k < 4; k++) {
        simplex.a[k] = frame->p.landmarks[pir_landmark_of(pir_mat_apply_transposed(&frame->r, along[k]))];
        simplex.b[k] = frame->q.landmarks[pir_landmark_of(along[k])];
    }
    return simplex;
}

/*
 * A certain surface about a point inside of D. A descent to that point ends with a tetrahedron about it, unless the
 * point is on the rim of what was tried, as the middle of a symmetric body is.
 */
static bool begin_inside(const struct overlap *overlap, pir_vec3 inner, pir_facet *ret_facet) {
    const pir_frame *frame = overlap->exact->frame;
    pir_placement within = *overlap->placement;
    pir_simplex simplex = {.count = 0};
    uint32_t steps = 0;
    within.x = inner;
    pir_descend_to_point(frame, &within, 0, &simplex, &steps);
    if (simplex.tried == 4 && begin_about(overlap, &simplex, inner))
        return true;
    simplex = four_corners(frame);
    return begin_about(overlap, &simplex, inner) || repair(overlap, ret_facet) == ABOUT_X;
}

/* Makes a surface about x from one about `inner`, a point inside of D. */
static enum about widen(const struct overlap *overlap, pir_vec3 inner, pir_facet *ret_facet) {
    const pir_placement *placement = overlap->placement;
    overlap->statistics->begun++;
    if (!begin_inside(overlap, inner, ret_facet))
        return ABOUT_NOTHING;
    pir_vec3 way = pir_vec_sub(placement->x, inner);
    for (uint32_t added = 0; added < MOST_ADDED; added++) {
        double low;
        uint32_t t = least_about(overlap, way, &low), corner;
        if (low > 0)
            return place(overlap) ? ABOUT_X : ABOUT_NOTHING;
        if (expand(overlap, t, &corner) != CHANGED)
            return facet_at(overlap, t, ret_facet);
    }
    return ABOUT_NOTHING;
}

/* --- the least facet --- */

/* The facets proven so far, the corners of the surface that are in each, and the least. */
struct found {
    uint32_t count;
    pir_facet facet[MOST_FACETS];
    uint32_t corners[MOST_FACETS];
    double radius[MOST_FACETS]; /* of a disc about the foot of x that found facets hold; NAN where it is not known */
    uint32_t walks;             /* to the foot of x */
    bool aside;                 /* some triangles are proven by the discs: others may be, without more vertices */
    pir_least least;
};

/* Takes the facet after the last, which has these corners. True where it is the least of all. */
static bool add_facet(const struct overlap *overlap, uint32_t corners, struct found *found) {
    const pir_facet *facet = &found->facet[found->count];
    found->corners[found->count] = corners;
    found->radius[found->count] = NAN;
    pir_least_offer_facet(overlap->exact, overlap->placement, &found->least, facet);
    bool is_least = pir_facet_same(facet, &found->least.facet);
    found->count++;
    return is_least;
}

/* Proves that triangle t lies in a facet of D, and takes that. */
static bool take_facet(const struct overlap *overlap, uint32_t t, struct found *found) {
    pir_piece piece;
    pir_same_facet same;
    pir_facet *facet = &found->facet[found->count];
    if (found->count == MOST_FACETS || !piece_at(overlap, t, &piece))
        return false;
    bool has_same =
        overlap->task->walker->prove(overlap->exact->frame, overlap->placement, piece, &same) == PIR_SAME_PROVEN;
    if (has_same)
        *facet = same.facet;
    else if (!pir_facet_prove(overlap->exact, piece, facet))
        return false;
    uint32_t corners = corners_in(overlap, facet, overlap->surface->used);
    if (!(overlap->room->loops->within(overlap->surface, corners) >> t & 1))
        return false;
    if (add_facet(overlap, corners, found) && has_same) {
        overlap->task->same = same;
        overlap->task->has_same = true;
    }
    return true;
}

/* After a corner was added. */
static void find_corner(const struct overlap *overlap, uint32_t corner, struct found *found) {
    for (uint32_t i = 0; i < found->count; i++) {
        found->corners[i] &= ~(1u << corner);
        found->corners[i] |= corners_in(overlap, &found->facet[i], 1u << corner);
    }
}

/*
 * The triangle of least distance that is in no facet that is proven; the count where none is, or that is farther than
 * `limit`.
 */
static uint32_t next_open(const struct overlap *overlap, const struct found *found, double limit) {
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

/* An upper bound on the least slack. */
static double bound_of(const struct overlap *overlap, const pir_least *least) {
    if (!least->found)
        return HUGE_VAL;
    const pir_facet *facet = &least->facet;
    return facet->h - pir_vec_dot(facet->n, overlap->placement->x) + overlap->placement->error * facet->err;
}

/* --- triangles that lie in no facet --- */

/* The least of three corners along a unit direction, less the error that they may have. */
static double least_along(const struct overlap *overlap, uint32_t t, pir_vec3 along) {
    double least = HUGE_VAL;
    for (int k = 0; k < 3; k++)
        least = fmin(least, pir_vec_dot(along, pir_surface_corner(overlap->room, corner_of(overlap, t, k))));
    return least - 2 * overlap->placement->error;
}

/*
 * A bound on the distance of a triangle from x, from the nearest points of its sides: those are certain where the plane
 * of a sliver is not. *ret_along is the direction of the best.
 */
static double distance_of(const struct overlap *overlap, uint32_t t, pir_vec3 *ret_along) {
    double most = overlap->room->plane.low[t];
    pir_vec3 n = pir_surface_normal(overlap->room, t);
    *ret_along = pir_vec_scale(n, 1 / sqrt(pir_vec_dot(n, n)));
    for (int k = 0; k < 3; k++) {
        pir_vec3 a = pir_surface_corner(overlap->room, corner_of(overlap, t, k)),
                 way = pir_vec_sub(pir_surface_corner(overlap->room, corner_of(overlap, t, (k + 1) % 3)), a);
        double part = fmin(1, fmax(0, -pir_vec_dot(a, way) / pir_vec_dot(way, way)));
        pir_vec3 at = pir_vec_add(a, pir_vec_scale(way, part)),
                 along = pir_vec_scale(at, 1 / sqrt(pir_vec_dot(at, at)));
        double least = least_along(overlap, t, along);
        if (least > most) {
            most = least;
            *ret_along = along;
        }
    }
    return most;
}

/*
 * A bound on the distance from x of what a triangle holds beside the disc about the foot of x in facet i. All facets
 * whose normals, as rays from x, pass through the disc are compared, or have more slack than those there (foot_walk.h).
 * A ray beside it is at an angle from the facet's normal n whose tangent is at least the radius over the slack. It
 * leaves the triangle at a distance of at least the least of its corners along n, over the cosine.
 */
static double distance_beside(const struct overlap *overlap, uint32_t t, struct found *found, uint32_t i) {
    const pir_facet *facet = &found->facet[i];
    const double error = overlap->placement->error * facet->err;
    double slack = pir_facet_slack(overlap->exact, overlap->placement, facet);
    if (isnan(found->radius[i]))
        found->radius[i] = pir_foot_rim(overlap->exact, overlap->placement, facet, slack).margin;
    double least = least_along(overlap, t, facet->n) - error, tangent = found->radius[i] / (slack + error);
    return tangent > 0 && least > 0 ? least * sqrt(1 + tangent * tangent) : 0;
}

/*
 * Raises what a triangle is known to be from x at least: by its distance, and by what is beside the discs in the facets
 * that are found. Returns whether that is more than the least facet.
 */
static bool is_beside(const struct overlap *overlap, uint32_t t, struct found *found, pir_vec3 *ret_along) {
    double *low = &overlap->room->plane.low[t], bound = bound_of(overlap, &found->least);
    *low = distance_of(overlap, t, ret_along);
    for (uint32_t i = 0; i < found->count && !(*low > bound); i++)
        *low = fmax(*low, distance_beside(overlap, t, found, i));
    return *low > bound;
}

/* The place of a facet among those that are found; the count where it is new. */
static uint32_t place_of(const struct found *found, const pir_facet *facet) {
    uint32_t i = 0;
    while (i < found->count && !pir_facet_same(&found->facet[i], facet))
        i++;
    return i;
}

/* Adds the facets about the foot of x, found from a triangle. */
static bool add_at_foot(const struct overlap *overlap, uint32_t t, pir_vec3 along, struct found *found) {
    const uint32_t corner = corner_of(overlap, t, 0);
    const uint32_t vertex[2] = {overlap->surface->a[corner], overlap->surface->b[corner]};
    pir_about_foot about;
    if (found->walks++ == MOST_WALKS || !pir_foot_walk(overlap->exact, overlap->placement, vertex, along, &about))
        return false;
    for (uint32_t i = 0; i < about.count; i++) {
        if (place_of(found, &about.facet[i]) < found->count)
            continue;
        if (found->count == MOST_FACETS)
            return false;
        found->facet[found->count] = about.facet[i];
        add_facet(overlap, corners_in(overlap, &about.facet[i], overlap->surface->used), found);
    }
    found->radius[place_of(found, &about.facet[0])] = about.radius;
    return true;
}

/*
 * Whether a triangle in which nothing is beyond, but which lies in no facet, is proven to be farther from x than the
 * least facet. Facets that doubles cannot tell apart leave such triangles.
 */
static bool set_aside(const struct overlap *overlap, uint32_t t, struct found *found) {
    pir_vec3 along;
    found->aside = true;
    return is_beside(overlap, t, found, &along) ||
           (add_at_foot(overlap, t, along, found) && is_beside(overlap, t, found, &along));
}

/* Whether no disc is known that faces a direction. */
static bool is_new_end(const struct found *found, pir_vec3 along) {
    bool new_end = true;
    for (uint32_t i = 0; i < found->count; i++)
        new_end &= isnan(found->radius[i]) || !(pir_vec_dot(found->facet[i].n, along) > SAME_END);
    return new_end;
}

/* Whether a vertex has a facet of many corners. */
static bool has_large_facet(const pir_polytope *p, uint32_t vertex) {
    bool large = false;
    for (uint32_t h = p->ring_start[vertex]; h < p->ring_start[vertex + 1]; h++)
        large |= p->loop_start[p->left[h] + 1] - p->loop_start[p->left[h]] >= MANY_CORNERS;
    return large;
}

/* Whether a search takes long because large facets of both bodies are nearly parallel at a triangle. */
static bool is_long(const struct overlap *overlap, uint32_t t, uint32_t added) {
    const pir_frame *frame = overlap->exact->frame;
    const uint32_t corner = corner_of(overlap, t, 0);
    return added >= MANY_ADDED && has_large_facet(frame->p.polytope, overlap->surface->a[corner]) &&
           has_large_facet(frame->q.polytope, overlap->surface->b[corner]);
}

/* Whether a triangle needs no more vertices: where discs are known, or a search is long, they prove what many would. */
static inline bool is_passed(const struct overlap *overlap, uint32_t t, uint32_t added, struct found *found) {
    pir_vec3 along;
    const bool seeks = is_long(overlap, t, added);
    if (!found->aside && !seeks)
        return false;
    found->aside = true;
    return is_beside(overlap, t, found, &along) ||
           (seeks && is_new_end(found, along) && add_at_foot(overlap, t, along, found) &&
            is_beside(overlap, t, found, &along));
}

/*
 * The true facet of least slack, and the first in order of those that tie, from a surface about x; false where it
 * is left open. task->same may become that facet.
 */
static bool find_least(const struct overlap *overlap, pir_facet *ret_facet) {
    struct found found;
    found.count = found.walks = 0;
    found.aside = found.least.found = false;
    if (overlap->task->has_same) {
        found.facet[0] = overlap->task->same.facet;
        add_facet(overlap, corners_in(overlap, &found.facet[0], overlap->surface->used), &found);
    }
    for (uint32_t added = 0; added <= MOST_ADDED;) {
        double bound = bound_of(overlap, &found.least);
        uint32_t t = next_open(overlap, &found, bound), corner;
        if (t == overlap->surface->count) {
            *ret_facet = found.least.facet;
            // what is known of a triangle beside discs is no distance of it
            if (!found.aside)
                pir_surface_keep(overlap->surface, overlap->exact->frame, overlap->placement, overlap->room);
            return found.least.found;
        }
        if (is_passed(overlap, t, added, &found))
            continue;
        enum expansion expansion = expand(overlap, t, &corner);
        if (expansion == STUCK ||
            (expansion == NOTHING_BEYOND && !take_facet(overlap, t, &found) && !set_aside(overlap, t, &found)))
            return false;
        if (expansion == CHANGED) {
            if (corner < PIR_SURFACE_CORNERS)
                find_corner(overlap, corner, &found);
            added++;
        }
    }
    return false;
}

/* --- answers from a surface --- */

/* Counts an answer of a level. */
static bool end(pir_task *task, pir_level level) {
    pir_pair_task_of(task)->pair->level = (uint8_t)level;
    return true;
}

/* The answer from task->same, the least facet. */
static bool inside_same(pir_task *task) {
    pir_task_inside(task, &task->same.facet, task->same.slack);
    return end(task, PIR_LEVEL_OVERLAPPING);
}

static struct overlap overlap_of(pir_task *task) {
    pir_pair *pair = pir_pair_task_of(task)->pair;
    pir_workspace *workspace = pir_pair_task_of(task)->workspace;
    if (!pair->surface)
        pair->surface = PIR_ZEROED(&pair->allocator, pir_surface, 1);
    // without memory, one that is not kept
    return (struct overlap){.task = task,
                            .exact = task->exact,
                            .placement = task->placement,
                            .surface = pair->surface ? pair->surface : &workspace->spare,
                            .room = &workspace->room,
                            .statistics = &pair->statistics};
}

/* The answer from a surface about x. */
static bool finish_inside(pir_task *task, const struct overlap *overlap) {
    pir_facet facet;
    if (!(task->want & PIR_WANT_DEPTH))
        pir_result_set_state(task->result, PIR_INSIDE);
    else if (find_least(overlap, &facet))
        pir_task_inside(task, &facet, pir_facet_slack(task->exact, task->placement, &facet));
    else
        return false;
    task->hint->deep = true;
    return end(task, PIR_LEVEL_OVERLAPPING);
}

/* The answer from what came of a surface. A facet that x is at or beyond is an answer by the level `near`. */
static bool finish(pir_task *task, const struct overlap *overlap, enum about about, const pir_facet *facet) {
    if (about == ABOUT_X)
        return finish_inside(task, overlap);
    return about == ABOUT_FACET && task->may_near && pir_task_settle(task, facet) && end(task, PIR_LEVEL_NEAR);
}

/* The triangles that lie in a facet of D, which are mostly those of the last answer. */
static uint64_t triangles_in(const struct overlap *overlap, const pir_facet *facet) {
    pir_surface_lows *lows = &overlap->surface->lows;
    const pir_witness f = facet->faces, g = lows->faces;
    if (!(f.p.kind == g.p.kind && f.p.index == g.p.index && f.q.kind == g.q.kind && f.q.index == g.q.index)) {
        lows->of_facet =
            overlap->room->loops->within(overlap->surface, corners_in(overlap, facet, overlap->surface->used));
        lows->faces = f;
    }
    return lows->of_facet;
}

/* Whether the facet that holds the foot of x is the least, as the distances that are kept with the surface tell. */
static bool is_least_still(const struct overlap *overlap) {
    const pir_same_facet *same = &overlap->task->same;
    const double error = overlap->placement->error * same->facet.err;
    pir_surface_step step = {.frame = overlap->exact->frame,
                             .placement = overlap->placement,
                             .least = same->slack - error,
                             .most = same->slack + error};
    uint64_t near;
    if (!overlap->task->has_same || !overlap->surface->lows.is_known ||
        !pir_surface_approach(overlap->surface, overlap->room, &step, &near))
        return false;
    near = near != 0 ? near & ~triangles_in(overlap, &same->facet) : near;
    return pir_surface_stays(overlap->surface, &step, near, overlap->room);
}

/* By the surface of the last answer, mended where x has left it. */
static bool by_surface(pir_task *task) {
    const pir_surface *surface = pir_pair_task_of(task)->pair->surface;
    pir_facet facet;
    if (!task->was_deep || task->same.is_far || !surface || surface->count == 0)
        return false;
    const struct overlap overlap = overlap_of(task);
    if (is_least_still(&overlap)) {
        task->hint->deep = true;
        return inside_same(task);
    }
    overlap.surface->lows.is_known = false;
    return finish(task, &overlap, place(&overlap) ? ABOUT_X : repair(&overlap, &facet), &facet);
}

/* Three vertices of a facet of D, and the one farthest behind it. */
static pir_simplex behind(const pir_frame *frame, const pir_facet *facet) {
    const pir_vec3 n = pir_vec_scale(facet->n, -1), back = pir_mat_apply_transposed(&frame->r, n);
    pir_simplex simplex = {.tried = 4};
    pir_facet_simplex(frame, facet->piece, &simplex);
    simplex.a[3] = pir_climb(frame->p.polytope, back, frame->p.landmarks[pir_landmark_of(back)]);
    simplex.b[3] = pir_climb(frame->q.polytope, n, frame->q.landmarks[pir_landmark_of(n)]);
    return simplex;
}

/* By a new surface, from a facet that holds the foot of x, behind which x is. */
static bool by_facet(pir_task *task) {
    pir_pair *pair = pir_pair_task_of(task)->pair;
    pir_facet facet;
    if (!task->has_same)
        return false;
    const struct overlap overlap = overlap_of(task);
    const pir_simplex simplex = behind(task->frame, &task->same.facet);
    bool done = finish(task, &overlap, begin_surface(&overlap, &simplex, &facet), &facet);
    if (pair->surface && !task->hint->deep)
        pair->surface->count = 0;
    return done;
}

/* By a new surface: from the descent's last simplex, or widened from one about a point inside of D. */
static bool by_new_surface(pir_task *task) {
    pir_pair *pair = pir_pair_task_of(task)->pair;
    const struct overlap overlap = overlap_of(task);
    pir_facet facet;
    bool done = finish(task, &overlap, begin_surface(&overlap, &task->simplex, &facet), &facet);
    if (!done) {
        pir_vec3 inner = pir_vec_add(pir_mat_apply(&task->frame->r, pair->body_p->inner), pair->body_q->inner);
        done = finish(task, &overlap, widen(&overlap, inner, &facet), &facet);
    }
    if (pair->surface && !task->hint->deep)
        pair->surface->count = 0;
    return done;
}

/* --- answers from all axes of small bodies --- */

/* The answer from task->same, a facet that doubles have proven; inside only where all others have more slack. */
static bool settle_least(pir_task *task, const pir_axes_slack *least) {
    const pir_same_facet *same = &task->same;
    if (!(same->slack > 0)) {
        pir_task_near_same(task);
        return end(task, PIR_LEVEL_NEAR);
    }
    if (!(same->slack + task->placement->error * same->facet.err < least->next))
        return false;
    return inside_same(task);
}

/* Whether x is within task->same, and of two parallelepipeds no other slack may be as little. */
static bool is_only_near(pir_task *task) {
    const pir_pair *pair = pir_pair_task_of(task)->pair;
    const pir_axes_lanes *p = &pair->axes_p->lanes, *q = &pair->axes_q->lanes;
    const pir_same_facet *same = &task->same;
    const double error = task->placement->error;
    return task->has_same && same->slack > 0 && p->has_halves && q->has_halves &&
           pir_pair_task_of(task)->workspace->axes->near(p, q, &task->frame->r, task->placement->x, error,
                                                         same->slack + error * same->facet.err) == 1;
}

/* The answer by the axes of both bodies. Where they leave it open, tells whether they are likely to do so again. */
static bool ask_axes(pir_task *task, bool *ret_open) {
    const pir_pair *pair = pir_pair_task_of(task)->pair;
    const pir_axes *p = pair->axes_p, *q = pair->axes_q;
    pir_axes_slack least;
    pir_same_facet other;
    pir_vec3 n;
    *ret_open = false;
    if (is_only_near(task))
        return inside_same(task);
    pir_axes_least(pir_pair_task_of(task)->workspace->axes, p, q, task->frame, task->placement, &least);
    // along edges that are parallel there is no axis, and less than any slack is said
    const bool is_none = least.low < -task->placement->reach;
    *ret_open = is_none || !(least.low < 0);
    if (task->has_same && settle_least(task, &least))
        return true;
    if (is_none)
        return false;
    pir_piece piece = pir_axes_piece(p, q, task->frame, least.at, &n);
    // written in place where nothing is there: avoids a copy
    other.is_far = task->same.is_far;
    pir_same_facet *same = task->has_same ? &other : &task->same;
    if (task->walker->prove(task->frame, task->placement, piece, same) == PIR_SAME_PROVEN) {
        if (task->has_same)
            task->same = other;
        task->has_same = true;
        return settle_least(task, &least);
    }
    return !*ret_open && pir_pair_apart_along(task, n) && end(task, PIR_LEVEL_NEAR);
}

/*
 * Calls that do not ask the axes after one that they left open. Two facets of one slack, or an edge of P along one of
 * Q, stay as they are where bodies rest on each other.
 */
#define AXES_REST 15

static bool by_axes(pir_task *task) {
    pir_pair *pair = pir_pair_task_of(task)->pair;
    bool open;
    if (!pair->axes_p || !task->may_near)
        return false;
    if (pair->resting > 0) {
        pair->resting--;
        return false;
    }
    if (ask_axes(task, &open))
        return true;
    pair->resting = open ? AXES_REST : 0;
    return false;
}

bool pir_pair_depth(pir_task *task, bool anew) {
    return anew ? by_new_surface(task) : by_axes(task) || by_surface(task) || by_facet(task);
}

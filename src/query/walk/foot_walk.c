/* SPDX-License-Identifier: MIT */
/* The facets about the foot of x: see foot_walk.h. */
#include "query/walk/foot_walk.h"

#include "query/frame/climb.h"
#include "query/walk/foot.h"

/* The most steps, and the most edges at a vertex that a step passes. */
#define MOST_STEPS 512
#define MOST_EDGES 16

/*
 * The radii that are tried, relative to the reach: the first with few facets about it. The square of the last is still
 * above what doubles tell slacks to.
 */
static const double RADII[] = {0x1p-9, 0x1p-11, 0x1p-13, 0x1p-15, 0x1p-17, 0x1p-19};
#define RADII_COUNT (sizeof RADII / sizeof *RADII)

/* Facets at a smaller cosine with the first are not nearly parallel to it: distances along them are not those seen. */
#define PARALLEL (1 - 0x1p-20)

/* --- the first facet --- */

/* The facet at a vertex that faces a direction of the body most. */
static uint32_t facet_most(const pir_polytope *p, uint32_t vertex, pir_vec3 n, double *ret_along) {
    uint32_t best = p->left[p->ring_start[vertex]];
    double most = -HUGE_VAL;
    for (uint32_t h = p->ring_start[vertex]; h < p->ring_start[vertex + 1]; h++) {
        double along = pir_vec_dot(p->normal[p->left[h]], n);
        best = along > most ? p->left[h] : best;
        most = along > most ? along : most;
    }
    *ret_along = most;
    return best;
}

/* The vertex of a body farthest along a normal, by exact slopes from where doubles end. */
static uint32_t farthest(pir_exact *exact, const pir_normal *normal, bool of_q, uint32_t from) {
    pir_view view = pir_view_of(exact->frame, normal, of_q);
    const pir_polytope *p = view.body;
    from = pir_climb(p, view.unit, from);
    // every step rises, so no vertex comes twice
    for (uint32_t left = p->vertex_count; left > 0; left--) {
        uint32_t h = p->ring_start[from], end = p->ring_start[from + 1];
        while (h < end && pir_slope(exact, normal, &view, h) <= 0)
            h++;
        if (h == end)
            break;
        from = p->target[h];
    }
    return from;
}

static bool first_facet(pir_exact *exact, const uint32_t vertex[2], pir_vec3 n, pir_facet *ret_facet) {
    const pir_frame *frame = exact->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    double of_p, of_q;
    uint32_t f = facet_most(p, vertex[0], pir_mat_apply_transposed(&frame->r, n), &of_p),
             g = facet_most(q, vertex[1], n, &of_q);
    bool by_p = of_p >= of_q;
    pir_piece piece = by_p ? (pir_piece){PIR_FACET_FV, f, vertex[1]} : (pir_piece){PIR_FACET_VF, vertex[0], g};
    pir_vec3 unit = by_p ? pir_mat_apply(&frame->r, p->normal[f]) : q->normal[g];
    pir_normal normal = {.unit = unit, .err = 1, .piece = piece};
    *(by_p ? &piece.second : &piece.first) = farthest(exact, &normal, by_p, vertex[by_p ? 1 : 0]);
    return pir_facet_prove(exact, piece, ret_facet);
}

/* --- from facet to facet --- */

/* A side of a facet of D: an edge of one body, and the vertex of the other that it is put at. */
struct side {
    const pir_polytope *body, *other;
    bool of_q;
    uint32_t half, vertex;
};

/* Whether a facet of D holds a side of that kind. */
static bool holds(const struct side *side, const pir_facet *facet) {
    const pir_polytope *p = side->body;
    pir_feature face = side->of_q ? facet->faces.q : facet->faces.p;
    if (face.kind == PIR_FEATURE_FACET)
        return face.index == p->left[side->half] || face.index == pir_right(p, side->half);
    return face.kind == PIR_FEATURE_EDGE && face.index == p->edge[side->half];
}

/* A facet of the body, at the side's vertex of the other body. */
static pir_piece piece_of_facet(const struct side *side, uint32_t facet) {
    return side->of_q ? (pir_piece){PIR_FACET_VF, side->vertex, facet} : (pir_piece){PIR_FACET_FV, facet, side->vertex};
}

/* A facet of the other body, at the start of the side. */
static pir_piece piece_of_other(const struct side *side, uint32_t facet) {
    uint32_t start = side->body->origin[side->half];
    return side->of_q ? (pir_piece){PIR_FACET_FV, facet, start} : (pir_piece){PIR_FACET_VF, start, facet};
}

/* The side's edge with one of the other body, with the normal on one side or the other. */
static pir_piece piece_of_edges(const struct side *side, uint32_t half, bool turned) {
    const pir_polytope *p = side->body, *q = side->other;
    uint32_t of_q = side->of_q ? side->half : half, edge = side->of_q ? q->edge[half] : p->edge[side->half];
    return (pir_piece){PIR_FACET_EE, edge, turned ? (side->of_q ? p : q)->twin[of_q] : of_q};
}

/* Whether a piece is of a facet beside `from`; if so, that becomes it. */
static bool goes_to(pir_exact *exact, const struct side *side, pir_piece piece, pir_facet *from) {
    pir_facet facet;
    if (!pir_facet_prove(exact, piece, &facet) || !holds(side, &facet) || pir_facet_same(&facet, from))
        return false;
    *from = facet;
    return true;
}

static bool has_many_edges(const struct side *side) {
    const uint32_t *ring = &side->other->ring_start[side->vertex];
    return ring[1] - ring[0] > MOST_EDGES;
}

/* Goes across a side: to the one other facet of D that holds it. */
static bool cross(pir_exact *exact, const struct side *side, pir_facet *facet) {
    const pir_polytope *p = side->body, *q = side->other;
    const uint32_t start = q->ring_start[side->vertex], end = q->ring_start[side->vertex + 1];
    if (has_many_edges(side))
        return false;
    if (goes_to(exact, side, piece_of_facet(side, p->left[side->half]), facet) ||
        goes_to(exact, side, piece_of_facet(side, pir_right(p, side->half)), facet))
        return true;
    for (uint32_t h = start; h < end; h++)
        if (goes_to(exact, side, piece_of_edges(side, h, false), facet) ||
            goes_to(exact, side, piece_of_edges(side, h, true), facet) ||
            goes_to(exact, side, piece_of_other(side, q->left[h]), facet))
            return true;
    return false;
}

static struct side side_of(const pir_frame *frame, const pir_rim *rim) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    return (struct side){rim->of_q ? q : p, rim->of_q ? p : q, rim->of_q, rim->half, rim->across};
}

/* Whether a facet is among those; else it joins them, where there is room. */
static bool was_there(pir_about_foot *passed, const pir_facet *facet) {
    for (uint32_t i = 0; i < passed->count; i++)
        if (pir_facet_same(facet, &passed->facet[i]))
            return true;
    if (passed->count < PIR_ABOUT_FOOT)
        passed->facet[passed->count++] = *facet;
    return false;
}

/*
 * Walks to a facet that holds the foot of x. Where the foot is on a side or at a corner of facets but for rounding,
 * none is sure to hold it: then steps go around it, and end where they come back with the foot never farther beyond a
 * side than `near`. Being so near to the lines of one facet's sides is not enough, for beyond the tip of a sliver a
 * foot may be near to them and far from the facet. *ret_margin is the foot's.
 */
static bool walk(pir_exact *exact, const pir_placement *placement, double near, pir_facet *facet, double *ret_margin) {
    pir_about_foot passed = {.count = 0};
    for (uint32_t step = 0; step < MOST_STEPS; step++) {
        double slack = pir_facet_slack(exact, placement, facet);
        pir_rim rim = pir_foot_rim(exact, placement, facet, slack);
        *ret_margin = rim.margin;
        if (!(rim.margin > -near))
            passed.count = 0;
        else if (rim.margin > 0 || was_there(&passed, facet))
            return true;
        const struct side side = side_of(exact->frame, &rim);
        if (!cross(exact, &side, facet))
            return false;
    }
    return false;
}

/* Adds a facet where it is a new one. False where it may not be added. */
static bool add(pir_about_foot *about, const pir_facet *facet) {
    for (uint32_t i = 0; i < about->count; i++)
        if (pir_facet_same(facet, &about->facet[i]))
            return true;
    if (about->count == PIR_ABOUT_FOOT || !(pir_vec_dot(facet->n, about->facet[0].n) > PARALLEL))
        return false;
    about->facet[about->count++] = *facet;
    return true;
}

/* Adds the facets beside facet i that may reach the disc of the radius of `rims` about the foot. */
static bool add_beside(pir_exact *exact, const pir_placement *placement, uint32_t i, pir_rims *rims,
                       pir_about_foot *about) {
    const pir_facet *facet = &about->facet[i];
    // where the line through x and the foot meets the plane of this one
    double along = pir_facet_slack(exact, placement, facet) / pir_vec_dot(facet->n, about->facet[0].n);
    pir_vec3 y = pir_vec_add(placement->x, pir_vec_scale(about->facet[0].n, along));
    pir_rim nearest = pir_foot_rims(exact, placement, facet, y, rims);
    if (nearest.margin < -rims->within)
        return true;
    if (rims->count > PIR_RIMS_MOST)
        return false;
    for (uint32_t k = 0; k < rims->count; k++) {
        pir_facet beside = *facet;
        const struct side side = side_of(exact->frame, &rims->side[k]);
        if (has_many_edges(&side))
            return false;
        // what is no side of D has no facet beside it
        if (cross(exact, &side, &beside) && !add(about, &beside))
            return false;
    }
    return true;
}

/* Finds all that reach the disc of a radius about the foot on the first facet. */
static bool find_about(pir_exact *exact, const pir_placement *placement, double radius, pir_about_foot *about) {
    pir_rims rims = {.within = radius};
    about->count = 1;
    for (uint32_t i = 0; i < about->count; i++)
        if (!add_beside(exact, placement, i, &rims, about))
            return false;
    // less what rounding and the angles between the facets take
    about->radius = radius / 2;
    return true;
}

bool pir_foot_walk(pir_exact *exact, const pir_placement *placement, const uint32_t vertex[2], pir_vec3 n,
                   pir_about_foot *about) {
    const pir_polytope *p = exact->frame->p.polytope, *q = exact->frame->q.polytope;
    const double least = RADII[RADII_COUNT - 1] * placement->reach;
    double margin;
    if (p->artificial || q->artificial || !first_facet(exact, vertex, n, &about->facet[0]) ||
        !walk(exact, placement, least / 2, &about->facet[0], &margin))
        return false;
    for (size_t i = 0; i < RADII_COUNT && margin < RADII[i] * placement->reach; i++)
        if (find_about(exact, placement, RADII[i] * placement->reach, about))
            return true;
    about->count = 1;
    about->radius = margin;
    return margin > least;
}

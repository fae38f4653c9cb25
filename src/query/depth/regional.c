/* SPDX-License-Identifier: MIT */
/*
 * Searches on a sum with a region.
 *
 * D is replaced by the intersection of the half-spaces of those of its facets whose normals are in the cone. That
 * intersection contains D. So a translation outside of it is outside of D. For a translation inside of it overlap is
 * not proven: the facets outside of the cone would decide. The depth is the least over facets in the cone.
 *
 * The sum keeps more features than the cone needs, and which ones depends on its past. So every piece is tested
 * against the cone, and the answer depends on the placement and the region alone. There are few pieces; they are
 * searched one by one, without groups. A piece that may hold the least slack becomes a plane, in slots of the groups'
 * planes, which are forgotten.
 *
 * Bounds last as those of groups do (depth/bounds.c). While R turns by θ and x moves by d, s(n) changes by at most
 * θ·(swing_q + |x|) + d in a direction that is fixed in P's frame, and by at most θ·swing_p + d in one that is
 * fixed in Q's. change_p and change_q are the sums of these over all searches. For each facet, and each edge of P,
 * `known` is a lower bound on its slacks when they were last computed, plus the change then. `known` minus the present
 * change is a lower bound on its slacks now. On an arc, which is shorter than half a turn unless P is flat, s is
 * nowhere less than at its crossings and ends while those are positive. This is geometry alone, so it does not matter
 * whether a feature has been inactive in between.
 */
#include "query/depth/regional.h"

#include "query/decide/touch.h"

struct search {
    pir_regional *regional;
    pir_groups *groups;
    const pir_placement *placement;
    const pir_cone *cone;
    bool all;          /* keep every plane, not just those that may have the least slack */
    double limit;      /* an upper bound on the least slack */
    double difference; /* bound on the difference of slacks that are computed in different ways */
    double most;       /* slacks above this are not searched for */
    uint32_t count;    /* planes, from slot 0 */
};

/*
 * The changes begin again at 0 when they pass this, in units of the frame. What rounds in adding to them then stays
 * below the error of a slack.
 */
#define GREATEST_CHANGE 16.0

/* --- memory --- */

static pir_layout layout_of(pir_regional *regional, const pir_frame *frame) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    return (pir_layout){{PIR_ROW(regional->known_p, p->facet_count), PIR_ROW(regional->known_q, q->facet_count),
                         PIR_ROW(regional->known_edge, p->edge_count)}};
}

bool pir_regional_init(pir_regional *regional, const pir_allocator *allocator, const pir_frame *frame) {
    pir_layout layout = layout_of(regional, frame);
    if (!pir_layout_new(allocator, &layout))
        return false;
    pir_regional_forget(regional, frame);
    return true;
}

void pir_regional_finish(pir_regional *regional, const pir_allocator *allocator, const pir_frame *frame) {
    pir_layout layout = layout_of(regional, frame);
    pir_layout_free(allocator, &layout);
}

void pir_regional_forget(pir_regional *regional, const pir_frame *frame) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    regional->change_p = regional->change_q = 0;
    for (uint32_t f = 0; f < p->facet_count; f++)
        regional->known_p[f] = -HUGE_VAL;
    for (uint32_t g = 0; g < q->facet_count; g++)
        regional->known_q[g] = -HUGE_VAL;
    for (uint32_t e = 0; e < p->edge_count; e++)
        regional->known_edge[e] = -HUGE_VAL;
}

/* --- the search --- */

/* Lowers the upper bound on the least slack. */
static void lower_limit(struct search *search, double limit) {
    if (!(limit < search->limit) || search->all)
        return;
    search->limit = limit;
    search->most = limit + search->difference;
}

/* Whether the piece is a facet that a segment hides: its plane bounds D, but no facet of D lies in it. */
static bool is_hidden(const pir_frame *frame, pir_piece piece) {
    return (piece.kind == PIR_FACET_FV && frame->p.polytope->artificial) ||
           (piece.kind == PIR_FACET_VF && frame->q.polytope->artificial);
}

/* Makes a piece's plane, and keeps it where it is in the cone and may be searched for. */
static void take(struct search *search, pir_piece piece) {
    pir_groups *groups = search->groups;
    pir_plane plane;
    if (is_hidden(groups->frame, piece) || !pir_plane_of(groups->exact, piece, &plane) ||
        !pir_plane_refine(groups->exact, &plane) || !pir_cone_has(search->cone, plane.n))
        return;
    double slack = pir_plane_slack(&plane, search->placement->x), error = search->placement->error * plane.err;
    if (slack - error > search->limit)
        return;
    lower_limit(search, slack + error);
    pir_planes_put(groups->planes, search->count++, &plane);
}

/*
 * Whether a piece may be searched for. Its slack, computed in another way than a plane's, is out / √square within
 * error / √square. Most pieces are told without the root.
 */
static inline bool may_win(const struct search *search, double out, double square) {
    double over = out - search->difference;
    return !(over > 0) || over * over <= search->most * search->most * square;
}

static inline double least_of(double a, double b) {
    return a < b ? a : b;
}

static void take_facets(struct search *search) {
    pir_regional *regional = search->regional;
    const pir_groups *groups = search->groups;
    const pir_frame *frame = groups->frame;
    const pir_pairing *pairing = groups->pairing;
    const pir_kept kept = pir_sum_kept(regional->sum);
    const pir_cone *cone = search->cone;
    pir_vec3 x = search->placement->x, back = pir_mat_apply_transposed(&frame->r, x);
    double off = search->difference;
    for (uint32_t i = 0; i < kept.facets_p.count; i++) {
        uint32_t f = kept.facets_p.at[i];
        if (regional->known_p[f] > search->most + regional->change_p)
            continue;
        pir_vec3 n = pir_mat_apply(&frame->r, frame->p.polytope->normal[f]);
        double slack = frame->p.offset[f] + pir_vec_dot(n, pir_vec_sub(frame->q.vertex[pairing->fv[f]], x));
        regional->known_p[f] = slack - off + regional->change_p;
        if (may_win(search, slack, 1) && pir_vec_dot(n, cone->axis) >= cone->cosine)
            take(search, pir_piece_fv(groups, f));
    }
    for (uint32_t i = 0; i < kept.facets_q.count; i++) {
        uint32_t g = kept.facets_q.at[i];
        if (regional->known_q[g] > search->most + regional->change_q)
            continue;
        pir_vec3 n = frame->q.polytope->normal[g],
                 from = pir_mat_apply(&frame->r, pir_vec_sub(frame->p.vertex[pairing->vf[g]], back));
        double slack = frame->q.offset[g] + pir_vec_dot(n, from);
        regional->known_q[g] = slack - off + regional->change_q;
        if (may_win(search, slack, 1) && pir_vec_dot(n, cone->axis) >= cone->cosine)
            take(search, pir_piece_vf(groups, g));
    }
}

/* Takes the edge pairs of an edge of P. Returns a lower bound on their slacks, −HUGE_VAL where doubles give none. */
static double take_crossings_of(struct search *search, uint32_t edge) {
    const pir_groups *groups = search->groups;
    const pir_frame *frame = groups->frame;
    const pir_pairing *pairing = groups->pairing;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    uint32_t half = p->edge_half[edge];
    pir_vec3 e = pir_mat_apply(&frame->r, p->direction[half]);
    pir_vec3 from = pir_vec_sub(pir_mat_apply(&frame->r, frame->p.vertex[p->origin[half]]), search->placement->x);
    double least = HUGE_VAL, off = search->difference;
    for (uint32_t at = pir_crossing_first(pairing, edge); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at)) {
        uint32_t h = pir_crossing_half(pairing, at);
        pir_vec3 n = pir_vec_cross(q->direction[h], e);
        double square = pir_vec_dot(n, n), out = pir_vec_dot(n, pir_vec_add(from, frame->q.vertex[q->origin[h]]));
        bool tells = square >= PIR_SIN_EXACT * PIR_SIN_EXACT;
        least = least_of(least, tells ? (out - off) / sqrt(square) : -HUGE_VAL);
        // at small angles the exact normal decides
        if (tells && (!may_win(search, out, square) ||
                      (square >= PIR_SIN_REFINED * PIR_SIN_REFINED && !pir_cone_has(search->cone, n))))
            continue;
        take(search, (pir_piece){PIR_FACET_EE, edge, h});
    }
    return least;
}

static void take_crossings(struct search *search) {
    pir_regional *regional = search->regional;
    const pir_groups *groups = search->groups;
    const pir_polytope *p = groups->frame->p.polytope;
    const pir_features edges = pir_sum_kept(regional->sum).edges_p;
    for (uint32_t i = 0; i < edges.count; i++) {
        uint32_t edge = edges.at[i];
        if (regional->known_edge[edge] > search->most + regional->change_p)
            continue;
        uint32_t half = p->edge_half[edge];
        double crossings = take_crossings_of(search, edge) + regional->change_p;
        double ends = least_of(regional->known_p[p->left[half]], regional->known_p[pir_right(p, half)]);
        double least = least_of(crossings, ends);
        regional->known_edge[edge] = p->dimension == 3 && least > regional->change_p ? least : -HUGE_VAL;
    }
}

/* Adds how much slacks may have changed since the last search. */
static void note_change(pir_regional *regional, const pir_frame *frame, const pir_placement *placement) {
    pir_quat unit = frame->unit;
    pir_vec3 off = pir_vec_sub(placement->x, regional->last_x);
    double moved = sqrt(pir_vec_dot(off, off)), turned = pir_rotation_angle_bound(regional->last_unit, unit);
    double far = placement->reach - frame->p.size - frame->q.size + moved;
    // reach is rounded, and so are these sums
    far += 0x1p-40 * placement->reach;
    regional->change_p = (regional->change_p + turned * (frame->q.swing + far) + moved) * (1 + 0x1p-50);
    regional->change_q = (regional->change_q + turned * frame->p.swing + moved) * (1 + 0x1p-50);
    regional->last_x = placement->x;
    regional->last_unit = unit;
    // large changes round badly
    if (regional->change_p < GREATEST_CHANGE && regional->change_q < GREATEST_CHANGE)
        return;
    pir_regional_forget(regional, frame);
}

/* The piece of a cache. False where the sum does not keep it. */
static bool recall(const pir_groups *groups, const pir_query_cache *cache, pir_piece *ret_piece) {
    return pir_piece_cached(groups, cache, ret_piece) && ret_piece->kind == cache->kind &&
           ret_piece->first != PIR_NO_PAIR && ret_piece->second != PIR_NO_PAIR;
}

/* Searches everything that the sum keeps, first the piece that was least last time. */
static struct search search_all(pir_regional *regional, pir_groups *groups, const pir_placement *placement, bool all,
                                const pir_query_cache *cache) {
    struct search search = {.regional = regional,
                            .groups = groups,
                            .placement = placement,
                            .cone = pir_sum_cone(regional->sum),
                            .all = all,
                            .limit = HUGE_VAL,
                            .difference = 4 * placement->error,
                            .most = HUGE_VAL};
    pir_groups_forget(groups);
    note_change(regional, groups->frame, placement);
    pir_piece last;
    if (recall(groups, cache, &last))
        take(&search, last);
    // the limit stays, and the piece will be taken again
    search.count = 0;
    take_facets(&search);
    take_crossings(&search);
    return search;
}

pir_state pir_regional_find(pir_regional *regional, pir_groups *groups, const pir_placement *placement,
                            const pir_query_cache *cache, pir_least *ret_least, uint32_t *steps) {
    const pir_planes *planes = groups->planes;
    struct search search = search_all(regional, groups, placement, false, cache);
    ++*steps;
    // every piece whose slack may be the least is there
    *ret_least = (pir_least){.found = false};
    for (uint32_t i = 0; i < search.count; i++)
        if (pir_planes_slack(planes, i, placement->x) - placement->error * planes->err[i] <= search.limit)
            pir_least_offer(groups->exact, placement, ret_least, planes->piece[i]);
    if (!ret_least->found)
        return PIR_INSIDE;
    int side = pir_facet_side(groups->exact, placement, &ret_least->facet);
    return side < 0 ? PIR_OUTSIDE : side == 0 ? PIR_BOUNDARY : PIR_INSIDE;
}

bool pir_regional_exit(pir_regional *regional, pir_groups *groups, const pir_line *line, pir_arrival *ret_arrival,
                       uint32_t *steps) {
    struct search search = search_all(regional, groups, line->placement, true, NULL);
    pir_clip clip = PIR_CLIP_NONE;
    for (uint32_t i = 0; i < search.count; i++)
        pir_clip_bound(groups->planes, line, &clip, i);
    for (uint32_t i = 0; i < search.count; i++)
        pir_clip_take(groups->exact, groups->planes, line, &clip, i);
    ++*steps;
    if (!clip.leave.found)
        return false;
    const pir_facet *facet = &clip.leave.facet;
    if (!pir_line_arrive(groups->exact, line, facet, ret_arrival)) {
        // the line passes beside the facet
        pir_placement there = *line->placement;
        there.x = pir_vec_add(there.x, pir_vec_scale(line->u, ret_arrival->at));
        ret_arrival->touch = (pir_touch){facet->faces, pir_facet_point(groups->frame, &there, facet, 0)};
    }
    return true;
}

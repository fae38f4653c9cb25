/* SPDX-License-Identifier: MIT */
/* See kept_facet.h: the candidates of a facet, and the pairs near them. */
#include "solid/kept/kept_facet.h"

#include <math.h>

#include "base/fetching.h"
#include "solid/space/identity.h"
#include "solid/space/places.h"
#include "solid/sum/convolution.h"

/* Far planes are sorted out once in so many steps. */
#define HORIZON_STEPS 8

/* How many planes ahead the next one is fetched. */
#define AHEAD 12

void pir_facet_maker_finish(pir_facet_maker *maker) {
    pir_space *space = maker->space;
    if (!space)
        return;
    pir_record_finish(&maker->record, space);
    pir_polygons_finish(&maker->polygons);
    pir_fragments_finish(&maker->fragments, space);
    pir_fragments_finish(&maker->kept, space);
    pir_space_shrink(space, maker->half, maker->half_room, sizeof *maker->half);
    pir_space_shrink(space, maker->order, maker->order_room, sizeof *maker->order);
    pir_space_shrink(space, maker->work, maker->work_room, sizeof *maker->work);
    pir_space_shrink(space, maker->due, maker->due_room, sizeof *maker->due);
    pir_space_shrink(space, maker->gone, maker->gone_room, sizeof *maker->gone);
    *maker = (pir_facet_maker){0};
}

void pir_give_back(pir_space *space, pir_space_spare *spare, pir_number_list *list) {
    for (uint32_t i = 0; i < list->count; i++)
        if (pir_space_grow(space, (void **)&spare->number, &spare->room, spare->count, sizeof *spare->number))
            spare->number[spare->count++] = list->number[i];
    list->count = 0;
}

/* Forgets all but the keys. */
static void clear(pir_facet_maker *maker, pir_plane_facet *facet) {
    pir_kept_facet_unclip(maker, facet);
    pir_give_back(maker->space, &maker->space->spare_points, &facet->points);
    pir_give_back(maker->space, &maker->space->spare_planes, &facet->planes);
    pir_polygons_truncate(&facet->candidates, 0);
    facet->near_count = facet->far_count = facet->far_soon = facet->cut_count = 0;
    facet->near_until = (double)INFINITY;
    facet->horizon = 0;
    facet->box_frame = 0;
    facet->based = false;
}

void pir_kept_facet_empty(pir_facet_maker *maker, pir_plane_facet *facet) {
    pir_facet_outline *outline = &facet->outline;
    clear(maker, facet);
    facet->key_count = 0;
    outline->run_count = outline->member.count = outline->chain.count = outline->touch.count = 0;
    outline->loop.count = outline->end.count = 0;
    outline->near.count = 0;
    outline->is_traced = outline->knotted = outline->is_listed = false;
}

void pir_kept_facet_finish(pir_facet_maker *maker, pir_plane_facet *facet) {
    pir_space *space = maker->space;
    pir_kept_facet_empty(maker, facet);
    pir_polygons_finish(&facet->candidates);
    pir_space_shrink(space, facet->key, facet->key_room, sizeof *facet->key);
    pir_space_shrink(space, facet->points.number, facet->points.room, sizeof(uint32_t));
    pir_space_shrink(space, facet->planes.number, facet->planes.room, sizeof(uint32_t));
    pir_space_shrink(space, facet->made.number, facet->made.room, sizeof(uint32_t));
    pir_space_shrink(space, facet->corners.number, facet->corners.room, sizeof(uint32_t));
    pir_space_shrink(space, facet->near, facet->near_room, sizeof *facet->near);
    pir_space_shrink(space, facet->near_pair, facet->near_pair_room, sizeof *facet->near_pair);
    pir_space_shrink(space, facet->gap_until, facet->gap_until_room, sizeof *facet->gap_until);
    pir_space_shrink(space, facet->far, facet->far_room, sizeof *facet->far);
    pir_space_shrink(space, facet->far_until, facet->far_until_room, sizeof *facet->far_until);
    pir_space_shrink(space, facet->cold_until, facet->cold_until_room, sizeof *facet->cold_until);
    pir_space_shrink(space, facet->cut, facet->cut_room, sizeof *facet->cut);
    pir_space_shrink(space, facet->hot, facet->hot_room, sizeof *facet->hot);
    pir_space_shrink(space, facet->cold, facet->cold_room, sizeof *facet->cold);
    pir_space_shrink(space, facet->parted, facet->parted_room, sizeof *facet->parted);
    pir_space_shrink(space, facet->met, facet->met_room, sizeof *facet->met);
    pir_space_shrink(space, facet->edge.segment, facet->edge.room, sizeof *facet->edge.segment);
    pir_facet_outline *outline = &facet->outline;
    pir_number_list *const list[] = {&outline->member, &outline->chain, &outline->touch,
                                     &outline->near,   &outline->loop,  &outline->end};
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        pir_space_shrink(space, list[i]->number, list[i]->room, sizeof(uint32_t));
    pir_space_shrink(space, outline->run, outline->run_room, sizeof *outline->run);
}

/* --- how long a side stands --- */

pir_plane_reach pir_reach_of(const pir_space *space, uint32_t plane) {
    const pir_space_plane *f = &space->plane[plane];
    pir_plane_reach reach = {.first = f->body, .of_edges = f->direction[1] != PIR_SPACE_NONE};
    for (uint32_t k = 0; k < 2; k++)
        reach.through[k] = space->point[f->point[k ^ reach.first]].x;
    return reach;
}

double pir_distance_until(const pir_facet_maker *maker, uint32_t plane, double distance, const pir_plane_reach *reach) {
    if (!(distance > 0))
        return maker->turn;
    // vertices are within 2^-48 of their doubles, of no more than 1
    double rate = sqrt(reach->square[1 - reach->first]) + 0x1p-40, slope = distance;
    if (reach->of_edges) {
        rate += sqrt(reach->square[0]);
        slope *= maker->space->plane[plane].length - 0x1p-45;
    }
    const double leeway = slope < rate * PIR_TURN_MOST ? slope / rate : PIR_TURN_MOST;
    return maker->turn + leeway * (1 - 0x1p-40) - PIR_TURN_SLACK;
}

double pir_sure_distance(const pir_space *space, uint32_t plane, uint32_t point, int side) {
    const pir_space_plane *f = &space->plane[plane];
    const pir_space_point *p = &space->point[point];
    const double s = f->n[0] * p->x[0] + f->n[1] * p->x[1] + f->n[2] * p->x[2] - f->d;
    return side * s - (f->err + p->err + 0x1p-47);
}

/* --- the candidates --- */

static void make_candidate(pir_facet_maker *maker, pir_polygons *candidates, pir_candidate_key key) {
    const pir_shell_body *p = &maker->body[0], *q = &maker->body[1];
    if (key.kind == PIR_TWO_EDGES)
        pir_candidate_of_edges(p, q, key.a, key.b, candidates);
    else if (key.kind == PIR_FACET_OF_P)
        pir_candidates_at_vertex(p, q, key.a, key.b, candidates);
    else
        pir_candidates_at_vertex(q, p, key.a, key.b, candidates);
}

static void make_candidates(pir_facet_maker *maker, pir_plane_facet *facet) {
    pir_space *space = maker->space;
    pir_polygons *candidates = &facet->candidates;
    if (!candidates->space)
        pir_polygons_init(candidates, space);
    pir_record_begin(&maker->record, space);
    for (uint32_t i = 0; i < facet->key_count && space->status == PIR_OK; i++) {
        const uint32_t before = candidates->count;
        make_candidate(maker, candidates, facet->key[i]);
        if (candidates->count == before)
            pir_space_fault(space);
    }
    pir_record_end(space);
    for (uint32_t i = 0; i < maker->record.points.count; i++)
        pir_number_list_add(&facet->points, space, maker->record.points.number[i]);
    for (uint32_t i = 0; i < maker->record.planes.count; i++)
        pir_number_list_add(&facet->planes, space, maker->record.planes.number[i]);
    if (space->status != PIR_OK)
        return;
    facet->half = candidates->polygon[0].half;
    for (uint32_t i = 0; i < candidates->count; i++)
        candidates->polygon[i].half = facet->half;
    const uint32_t *direction = space->plane[candidates->wall[0] >> 1].direction;
    for (facet->axis = 0; facet->axis < 2 && space->axis[facet->axis] != direction[1]; facet->axis++)
        ;
    facet->upright = space->plane[facet->half >> 1].n[facet->axis];
}

bool pir_kept_facet_is_upright(pir_facet_maker *maker, const pir_plane_facet *facet) {
    pir_space_renew_plane(maker->space, facet->half >> 1);
    return maker->space->plane[facet->half >> 1].n[facet->axis] * facet->upright > .1;
}

static void renew_candidates(pir_facet_maker *maker, const pir_plane_facet *facet) {
    for (uint32_t i = 0; i < facet->candidates.corner_count; i++)
        pir_space_renew_point(maker->space, facet->candidates.point[i]);
}

pir_space_box pir_kept_facet_box(pir_facet_maker *maker, pir_plane_facet *facet) {
    if (facet->box_frame == maker->space->frame)
        return facet->box;
    const pir_space_point *point = maker->space->point;
    const uint32_t swapped = facet->key[0].kind == PIR_FACET_OF_Q;
    facet->box = facet->part[0] = facet->part[1] = PIR_SPACE_BOX_EMPTY;
    facet->box_frame = maker->space->frame;
    renew_candidates(maker, facet);
    for (uint32_t i = 0; i < facet->candidates.corner_count; i++) {
        const pir_space_point *corner = &point[facet->candidates.point[i]];
        pir_space_box_add(&facet->box, corner);
        for (uint32_t k = 0; k < 2; k++)
            pir_space_box_add(&facet->part[k], &point[corner->of[k ^ swapped]]);
    }
    return facet->box;
}

/* The least distance of the candidates' corners from a plane of a pair, on one side of it, of those that are not in it
 * at every rotation; 0 or less where it is not sure, or all are in it. *ret_until is for how far a turn it stands. */
static double distance_of_all(pir_facet_maker *maker, const pir_plane_facet *facet, uint32_t plane, int side,
                              double *ret_until) {
    const pir_space *space = maker->space;
    pir_plane_reach reach = pir_reach_of(space, plane);
    double least = (double)INFINITY;
    for (uint32_t i = 0; i < facet->candidates.corner_count && least > 0; i++) {
        const uint32_t corner = facet->candidates.point[i];
        const double own = pir_sure_distance(space, plane, corner, side);
        if (own <= 0 && side < 0 && own >= -0x1p-40 && pir_identity_holds(maker->space, plane, corner))
            continue;
        least = own < least ? own : least;
        pir_reach_add(&reach, space, facet, &space->point[corner]);
    }
    least = least < (double)INFINITY ? least : 0;
    *ret_until = pir_distance_until(maker, plane, least, &reach);
    return least;
}

/* --- pairs that are apart --- */

static void renew_pair(pir_facet_maker *maker, uint32_t pair) {
    pir_kept_pair_sum *sum = &maker->pairs->pair[pair];
    for (uint32_t k = 0; k < sum->count && sum->renewed != maker->space->frame; k++)
        pir_space_renew_plane(maker->space, sum->plane[k]);
    sum->renewed = maker->space->frame;
}

/* How far two boxes are apart. */
static double gap_of(const pir_space_box *a, const pir_space_box *b) {
    double gap = -(double)INFINITY;
    for (int k = 0; k < 3; k++) {
        const double above = a->low[k] - b->high[k], below = b->low[k] - a->high[k];
        gap = above > gap ? above : gap;
        gap = below > gap ? below : gap;
    }
    return gap;
}

/* How far points of two boxes are from each other at most. */
static double span_of(const pir_space_box *a, const pir_space_box *b) {
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double above = a->high[k] - b->low[k], below = b->high[k] - a->low[k];
        square += above > below ? above * above : below * below;
    }
    return sqrt(square) * (1 + 0x1p-40);
}

/* How much the candidates and the sum of a pair may approach each other, times the angle; their boxes are there. */
static double approach_of(const pir_facet_maker *maker, const pir_plane_facet *facet, uint32_t pair) {
    const pir_convexes *convexes = maker->pairs->table->convexes;
    const double of_p = span_of(&facet->part[0], &convexes[0].convex[pair / convexes[1].count].box);
    const double of_q = span_of(&facet->part[1], &convexes[1].convex[pair % convexes[1].count].box);
    return (of_p < of_q ? of_p : of_q) + 0x1p-40;
}

/* The plane of a pair's sum that the candidates' middle is farthest above. */
static uint32_t farthest_plane(pir_facet_maker *maker, const pir_plane_facet *facet, const pir_kept_pair_sum *sum) {
    const pir_space *space = maker->space;
    const uint32_t count = facet->candidates.corner_count;
    double middle[3] = {0}, least = (double)INFINITY;
    uint32_t best = sum->plane[0];
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            middle[k] += space->point[facet->candidates.point[i]].x[k] / count;
    for (uint32_t k = 0; k < sum->count; k++) {
        const pir_space_plane *f = &space->plane[sum->plane[k]];
        const double depth = f->d - (f->n[0] * middle[0] + f->n[1] * middle[1] + f->n[2] * middle[2]);
        if (depth < least) {
            least = depth;
            best = sum->plane[k];
        }
    }
    return best;
}

static void add_far(pir_facet_maker *maker, pir_plane_facet *facet, pir_far_plane far, double until) {
    pir_space *space = maker->space;
    if (!pir_space_grow(space, (void **)&facet->far, &facet->far_room, facet->far_count, sizeof *facet->far) ||
        !pir_space_grow(space, (void **)&facet->far_until, &facet->far_until_room, facet->far_count,
                        sizeof *facet->far_until))
        return;
    uint32_t at = facet->far_count++;
    if (until < facet->horizon) {
        facet->far[at] = facet->far[facet->far_soon];
        facet->far_until[at] = facet->far_until[facet->far_soon];
        at = facet->far_soon++;
    }
    facet->far[at] = far;
    facet->far_until[at] = until;
}

/* Proves that the sum of the pair near[at] covers nothing of the candidates: by boxes, if that may stand for some
 * frames, or by a plane, the farthest or any. */
static bool prove_apart(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t at) {
    pir_near_pair *near = &facet->near[at];
    const pir_kept_pair_sum *sum = &maker->pairs->pair[near->pair];
    const pir_space_box box = pir_kept_pair_box(maker->pairs, near->pair), own = pir_kept_facet_box(maker, facet);
    const double leeway = gap_of(&own, &box) * (1 - 0x1p-40) / approach_of(maker, facet, near->pair);
    const double gap = fmin(leeway, PIR_TURN_MOST) - PIR_TURN_SLACK;
    if (gap >= maker->step && gap > 0) {
        near->cover = PIR_COVER_GAP;
        facet->gap_until[at] = maker->turn + gap;
        facet->near_until = fmin(facet->near_until, facet->gap_until[at]);
        return true;
    }
    renew_pair(maker, near->pair);
    near->plane = farthest_plane(maker, facet, sum);
    double until, distance = distance_of_all(maker, facet, near->plane, 1, &until);
    for (uint32_t k = 0; k < sum->count && distance <= 0; k++) {
        near->plane = sum->plane[k];
        distance = distance_of_all(maker, facet, near->plane, 1, &until);
    }
    facet->gap_until[at] = (double)INFINITY;
    if (distance <= 0 && gap <= 0)
        return false;
    near->cover = distance > 0 ? PIR_COVER_APART : PIR_COVER_GAP;
    if (distance > 0) {
        add_far(maker, facet, (pir_far_plane){near->plane, at, 1}, until);
        return true;
    }
    facet->gap_until[at] = maker->turn + gap;
    facet->near_until = fmin(facet->near_until, facet->gap_until[at]);
    return true;
}

/* --- pairs that may clip --- */

/* Takes a plane of a pair that may clip. */
static void take_plane(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t at, uint32_t plane) {
    double until;
    if (distance_of_all(maker, facet, plane, -1, &until) > 0) {
        add_far(maker, facet, (pir_far_plane){plane, at, -1}, until);
        return;
    }
    if (pir_space_grow(maker->space, (void **)&facet->cut, &facet->cut_room, facet->cut_count, sizeof *facet->cut))
        facet->cut[facet->cut_count++] = (pir_cut_plane){plane, at};
    if (facet->stands && facet->near[at].cover == PIR_COVER_CLIPS)
        pir_kept_facet_amend_plane(maker, facet, at, plane);
}

/* Whether a pair's sum is below the facet's plane and touches it at every rotation; notes how deep the candidates'
 * middle is in it. */
static bool is_below(pir_facet_maker *maker, const pir_plane_facet *facet, pir_near_pair *near) {
    pir_space *space = maker->space;
    const pir_kept_pair_sum *sum = &maker->pairs->pair[near->pair];
    const pir_ball ball = pir_polygons_ball(&facet->candidates, 0);
    near->depth = (double)INFINITY;
    for (uint32_t k = 0; k < sum->count; k++) {
        const uint32_t plane = sum->plane[k];
        const double depth = pir_ball_depth(&ball, &space->plane[plane]);
        near->depth = fmin(near->depth, depth);
        if (fabs(depth) < 0x1p-40 && pir_identity_of_planes(space, facet->half >> 1, plane) &&
            pir_planes_face_one_way(space, facet->half >> 1, plane) == !(facet->half & 1)) {
            near->plane = plane;
            return true;
        }
    }
    return false;
}

/* Takes the pair near[at], which is not known to be apart. */
static void join(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t at) {
    pir_near_pair *near = &facet->near[at];
    renew_candidates(maker, facet);
    pir_space_renew_plane(maker->space, facet->half >> 1);
    renew_pair(maker, near->pair);
    near->cover = is_below(maker, facet, near) ? PIR_COVER_BELOW : PIR_COVER_NONE;
    if (facet->stands && near->cover == PIR_COVER_NONE)
        pir_kept_facet_amend_pair(maker, facet, at);
}

void pir_kept_facet_list_planes(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t at) {
    const pir_kept_pair_sum *sum = &maker->pairs->pair[facet->near[at].pair];
    renew_candidates(maker, facet);
    renew_pair(maker, facet->near[at].pair);
    for (uint32_t k = 0; k < sum->count; k++)
        take_plane(maker, facet, at, sum->plane[k]);
    facet->near[at].listed = true;
}

static void add_near(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t pair) {
    pir_space *space = maker->space;
    const uint32_t at = facet->near_count;
    if (!pir_space_grow(space, (void **)&facet->near, &facet->near_room, at, sizeof *facet->near) ||
        !pir_space_grow(space, (void **)&facet->near_pair, &facet->near_pair_room, at, sizeof *facet->near_pair) ||
        !pir_space_grow(space, (void **)&facet->gap_until, &facet->gap_until_room, at, sizeof *facet->gap_until))
        return;
    facet->near_count++;
    facet->near_pair[at] = pair;
    facet->near[at] = (pir_near_pair){.pair = pair, .plane = PIR_SPACE_NONE};
    if (!prove_apart(maker, facet, at))
        join(maker, facet, at);
}

void pir_kept_facet_make(pir_facet_maker *maker, pir_plane_facet *facet, const uint32_t *near, uint32_t count) {
    clear(maker, facet);
    make_candidates(maker, facet);
    for (uint32_t i = 0; i < count && maker->space->status == PIR_OK; i++)
        add_near(maker, facet, near[i]);
    facet->based = maker->space->status == PIR_OK;
}

void pir_kept_facet_meet(pir_facet_maker *maker, pir_plane_facet *facet, const uint32_t *near, uint32_t count) {
    pir_kept_pair_sum *pair = maker->pairs->pair;
    const uint64_t look = ++maker->pairs->looks;
    for (uint32_t i = 0; i < facet->near_count; i++)
        pair[facet->near_pair[i]].met = look;
    for (uint32_t i = 0; i < count && maker->space->status == PIR_OK; i++)
        if (pair[near[i]].met != look)
            add_near(maker, facet, near[i]);
}

/* --- after a turn --- */

/* Takes the planes that pairs which may clip have got, and finds those whose own plane is gone. */
static bool take_changes(pir_facet_maker *maker, pir_plane_facet *facet) {
    bool changed = false;
    for (uint32_t i = 0; i < facet->near_count; i++) {
        if (!maker->pairs->has_changed[facet->near_pair[i]])
            continue;
        pir_near_pair *near = &facet->near[i];
        const pir_kept_pair_sum *sum = &maker->pairs->pair[near->pair];
        changed = true;
        renew_candidates(maker, facet);
        if (near->cover == PIR_COVER_BELOW && pir_plane_is_dropped(maker->pairs, near->plane))
            join(maker, facet, i);
        else if (near->listed)
            for (uint32_t k = 0; k < sum->new_count; k++)
                take_plane(maker, facet, i, maker->pairs->added[sum->first_new + k]);
    }
    return changed;
}

static void drop_cuts(pir_facet_maker *maker, pir_plane_facet *facet) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < facet->cut_count; i++)
        if (!pir_plane_is_dropped(maker->pairs, facet->cut[i].plane))
            facet->cut[kept++] = facet->cut[i];
    facet->cut_count = kept;
}

/* Looks at a plane again; whether all corners are still on its side. */
static bool look_again(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t i) {
    const pir_far_plane far = facet->far[i];
    maker->looked++;
    renew_candidates(maker, facet);
    pir_space_renew_plane(maker->space, far.plane);
    return distance_of_all(maker, facet, far.plane, far.sign, &facet->far_until[i]) > 0;
}

/* Does without a plane that is dropped, or that not all corners are on one side of any longer. */
static void replace_far(pir_facet_maker *maker, pir_plane_facet *facet, pir_far_plane far) {
    renew_candidates(maker, facet);
    if (far.sign > 0 && !prove_apart(maker, facet, far.near))
        join(maker, facet, far.near);
    if (far.sign < 0 && !pir_plane_is_dropped(maker->pairs, far.plane))
        take_plane(maker, facet, far.near, far.plane);
}

static void swap_far(pir_plane_facet *facet, uint32_t i, uint32_t j) {
    const pir_far_plane far = facet->far[i];
    const double until = facet->far_until[i];
    facet->far[i] = facet->far[j];
    facet->far_until[i] = facet->far_until[j];
    facet->far[j] = far;
    facet->far_until[j] = until;
}

/* Takes a far plane out: the last ones take its place. */
static void drop_far(pir_plane_facet *facet, uint32_t i) {
    if (i < facet->far_soon) {
        swap_far(facet, i, --facet->far_soon);
        i = facet->far_soon;
    }
    swap_far(facet, i, --facet->far_count);
}

/* Puts those first that may not hold for some frames. */
static void sort_far(const pir_facet_maker *maker, pir_plane_facet *facet) {
    facet->horizon = maker->turn + HORIZON_STEPS * maker->step;
    facet->far_soon = 0;
    for (uint32_t i = 0; i < facet->far_count; i++)
        if (facet->far_until[i] < facet->horizon)
            swap_far(facet, i, facet->far_soon++);
}

/* Lists the far planes that may be wrong, and where pairs have changed those that are dropped. */
static void list_due(pir_facet_maker *maker, const pir_plane_facet *facet) {
    const uint32_t room = facet->far_count;
    maker->due_count = maker->gone_count = 0;
    if (!pir_space_grow(maker->space, (void **)&maker->due, &maker->due_room, room, sizeof *maker->due) ||
        !pir_space_grow(maker->space, (void **)&maker->gone, &maker->gone_room, room, sizeof *maker->gone))
        return;
    for (uint32_t i = 0; i < facet->far_soon; i++)
        if (facet->far_until[i] <= maker->turn ||
            (maker->changed && pir_plane_is_dropped(maker->pairs, facet->far[i].plane)))
            maker->due[maker->due_count++] = i;
    for (uint32_t i = facet->far_soon; i < facet->far_count && maker->changed; i++)
        if (pir_plane_is_dropped(maker->pairs, facet->far[i].plane))
            maker->due[maker->due_count++] = i;
}

/* Looks at the far planes that may be wrong, and does without those that are, and the dropped ones. */
static void follow_planes(pir_facet_maker *maker, pir_plane_facet *facet) {
    if (maker->turn >= facet->horizon)
        sort_far(maker, facet);
    list_due(maker, facet);
    // from the last one on: what takes the place of one that goes has been looked at
    for (uint32_t k = maker->due_count; k-- > 0 && maker->space->status == PIR_OK;) {
        const uint32_t i = maker->due[k];
        // planes of one facet are far apart in memory
        if (k >= AHEAD)
            PIR_FETCH(&maker->space->plane[facet->far[maker->due[k - AHEAD]].plane].frame);
        if (!pir_plane_is_dropped(maker->pairs, facet->far[i].plane) && look_again(maker, facet, i))
            continue;
        maker->gone[maker->gone_count++] = facet->far[i];
        drop_far(facet, i);
    }
    for (uint32_t k = 0; k < maker->gone_count && maker->space->status == PIR_OK; k++)
        replace_far(maker, facet, maker->gone[k]);
}

static void follow_gaps(pir_facet_maker *maker, pir_plane_facet *facet) {
    double least = (double)INFINITY;
    for (uint32_t i = 0; i < facet->near_count && maker->space->status == PIR_OK; i++) {
        if (facet->gap_until[i] <= maker->turn && !prove_apart(maker, facet, i))
            join(maker, facet, i);
        least = facet->gap_until[i] < least ? facet->gap_until[i] : least;
    }
    facet->near_until = least;
}

void pir_kept_facet_follow(pir_facet_maker *maker, pir_plane_facet *facet) {
    maker->changed = take_changes(maker, facet);
    if (maker->changed)
        drop_cuts(maker, facet);
    follow_planes(maker, facet);
    if (maker->turn >= facet->near_until)
        follow_gaps(maker, facet);
}

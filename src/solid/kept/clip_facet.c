/* SPDX-License-Identifier: MIT */
/* See kept_facet.h: what clipping a facet's candidates was told, and whether it still holds. */
#include <math.h>

#include "base/sort.h"
#include "solid/kept/kept_facet.h"
#include "solid/space/identity.h"

/* A facet is clipped again rather than that more planes are taken as new ones in one frame, or that its points where
 * planes meet have many more sides than clipping told. */
#define SPARED_MOST    6
#define HOT_MOST(told) (2 * (told) + 32)

void pir_kept_facet_unclip(pir_facet_maker *maker, pir_plane_facet *facet) {
    pir_give_back(maker->space, &maker->space->spare_points, &facet->made);
    facet->hot_count = facet->cold_count = facet->parted_count = facet->met_count = 0;
    facet->corners.count = facet->edge.count = 0;
    facet->survivors = 0;
    facet->told_until = (double)INFINITY;
    facet->stands = facet->fleeting = facet->outline.made = false;
}

/* --- clipping --- */

static bool is_deeper(void *context, uint32_t a, uint32_t b) {
    const pir_near_pair *near = context;
    return near[a].depth > near[b].depth;
}

/* Lists the pairs that may cover the candidates, the deepest first. */
static uint32_t list_clips(pir_facet_maker *maker, const pir_plane_facet *facet) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < facet->near_count; i++) {
        if (facet->near[i].cover != PIR_COVER_NONE && facet->near[i].cover != PIR_COVER_CLIPS)
            continue;
        if (!pir_space_grow(maker->space, (void **)&maker->order, &maker->order_room, count, sizeof *maker->order) ||
            !pir_space_grow(maker->space, (void **)&maker->work, &maker->work_room, count, sizeof *maker->work))
            return 0;
        facet->near[i].cover = PIR_COVER_NONE;
        maker->order[count++] = i;
    }
    pir_sort(maker->order, count, maker->work, is_deeper, facet->near);
    return count;
}

/* Sees to it that there is room for the half-spaces of all planes that cut. */
static bool make_room(pir_facet_maker *maker, const pir_plane_facet *facet) {
    return facet->cut_count == 0 || pir_space_grow(maker->space, (void **)&maker->half, &maker->half_room,
                                                   facet->cut_count - 1, sizeof *maker->half);
}

/* Lists the planes that cut, as half-spaces, pair by pair. */
static bool list_halves(pir_facet_maker *maker, pir_plane_facet *facet) {
    if (!make_room(maker, facet))
        return false;
    for (uint32_t i = 0; i < facet->near_count; i++)
        facet->near[i].cuts = 0;
    for (uint32_t i = 0; i < facet->cut_count; i++)
        facet->near[facet->cut[i].near].cuts++;
    for (uint32_t i = 0, first = 0; i < facet->near_count; i++) {
        facet->near[i].first_cut = first;
        first += facet->near[i].cuts;
        facet->near[i].cuts = 0;
    }
    for (uint32_t i = 0; i < facet->cut_count; i++) {
        pir_near_pair *near = &facet->near[facet->cut[i].near];
        pir_space_renew_plane(maker->space, facet->cut[i].plane);
        maker->half[near->first_cut + near->cuts++] = pir_half(facet->cut[i].plane, false);
    }
    return maker->space->status == PIR_OK;
}

/* Lists the planes of a pair that clipping comes to for the first time, and the half-spaces of those that cut. */
static void list_late(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t at) {
    const uint32_t before = facet->cut_count;
    pir_kept_facet_list_planes(maker, facet, at);
    if (!make_room(maker, facet))
        return;
    facet->near[at].first_cut = before;
    facet->near[at].cuts = facet->cut_count - before;
    for (uint32_t i = before; i < facet->cut_count; i++) {
        pir_space_renew_plane(maker->space, facet->cut[i].plane);
        maker->half[i] = pir_half(facet->cut[i].plane, false);
    }
}

static void clip_candidate(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t polygon, uint32_t clips) {
    pir_space *space = maker->space;
    maker->fragments.count = 0;
    pir_fragments_add(&maker->fragments, space, pir_polygons_copy(&maker->polygons, &facet->candidates, polygon));
    for (uint32_t i = 0; i < clips && maker->fragments.count > 0 && space->status == PIR_OK; i++) {
        pir_near_pair *near = &facet->near[maker->order[i]];
        uint32_t apart = 0;
        if (!near->listed)
            list_late(maker, facet, maker->order[i]);
        if (space->status != PIR_OK)
            return;
        near->cover = PIR_COVER_CLIPS;
        maker->record.set = maker->order[i];
        pir_fragments_subtract(&maker->fragments, &maker->polygons, maker->half + near->first_cut, near->cuts, NULL,
                               &apart);
    }
    facet->survivors += maker->fragments.count > 0;
    for (uint32_t i = 0; i < maker->fragments.count; i++)
        pir_fragments_add(&maker->kept, space, maker->fragments.polygon[i]);
}

/* --- the record --- */

/* How far P may turn before a corner of the candidates at this distance from a plane may be in it. */
static double side_until(const pir_facet_maker *maker, const pir_plane_facet *facet, uint32_t plane, uint32_t corner,
                         double distance) {
    pir_plane_reach reach = pir_reach_of(maker->space, plane);
    pir_reach_add(&reach, maker->space, facet, &maker->space->point[corner]);
    return pir_distance_until(maker, plane, distance, &reach);
}

/* Keeps a side that was told. */
static void keep_side(pir_facet_maker *maker, pir_plane_facet *facet, pir_told_side told) {
    pir_space *space = maker->space;
    if (space->point[told.point].kind != PIR_POINT_SUM) {
        if (pir_space_grow(space, (void **)&facet->hot, &facet->hot_room, facet->hot_count, sizeof *facet->hot))
            facet->hot[facet->hot_count++] = told;
        return;
    }
    const double distance = pir_sure_distance(space, told.plane, told.point, told.sign);
    const double until = side_until(maker, facet, told.plane, told.point, distance);
    if (!pir_space_grow(space, (void **)&facet->cold, &facet->cold_room, facet->cold_count, sizeof *facet->cold) ||
        !pir_space_grow(space, (void **)&facet->cold_until, &facet->cold_until_room, facet->cold_count,
                        sizeof *facet->cold_until))
        return;
    facet->cold_until[facet->cold_count] = until;
    facet->cold[facet->cold_count++] = told;
    facet->told_until = fmin(facet->told_until, until);
}

/* The least distance of the corners of a polygon that is apart, above a plane; not sure where it is not above 0.
 * *ret_until is how far P may turn before that may be no more: not at all where a corner is where planes meet. */
static double parted_distance(pir_facet_maker *maker, const pir_plane_facet *facet, const pir_parted_polygon *parted,
                              uint32_t plane, double *ret_until) {
    pir_space *space = maker->space;
    const pir_space_plane f = space->plane[plane];
    const uint32_t *corner = facet->corners.number + parted->first;
    pir_plane_reach reach = pir_reach_of(space, plane);
    double least = (double)INFINITY;
    bool sums = true;
    for (uint32_t i = 0; i < parted->count && least > 0; i++) {
        if (!pir_space_sees_point(space, corner[i]))
            return 0;
        const pir_space_point *p = &space->point[corner[i]];
        const double own = f.n[0] * p->x[0] + f.n[1] * p->x[1] + f.n[2] * p->x[2] - f.d - (f.err + p->err + 0x1p-47);
        least = own < least ? own : least;
        sums &= p->kind == PIR_POINT_SUM;
        if (sums)
            pir_reach_add(&reach, space, facet, p);
    }
    *ret_until = sums ? pir_distance_until(maker, plane, least, &reach) : -(double)INFINITY;
    return least;
}

/* Proves that a polygon is above a plane; until when is noted with it. */
static bool is_parted_by(pir_facet_maker *maker, const pir_plane_facet *facet, pir_parted_polygon *parted,
                         uint32_t plane) {
    double until;
    pir_space_renew_plane(maker->space, plane);
    if (!(parted_distance(maker, facet, parted, plane, &until) > 0))
        return false;
    parted->plane = plane;
    parted->until = until;
    return true;
}

static void add_parted(pir_facet_maker *maker, pir_plane_facet *facet, pir_parted_polygon parted) {
    if (pir_space_grow(maker->space, (void **)&facet->parted, &facet->parted_room, facet->parted_count,
                       sizeof *facet->parted))
        facet->parted[facet->parted_count++] = parted;
}

static void keep_record(pir_facet_maker *maker, pir_plane_facet *facet) {
    pir_space *space = maker->space;
    const pir_side_record *record = &maker->record;
    for (uint32_t i = 0; i < record->told_count; i++)
        keep_side(maker, facet, record->told[i]);
    for (uint32_t i = 0; i < record->corners.count; i++)
        pir_number_list_add(&facet->corners, space, record->corners.number[i]);
    for (uint32_t i = 0; i < record->parted_count && space->status == PIR_OK; i++) {
        pir_parted_polygon parted = record->parted[i];
        parted.until = maker->turn;
        is_parted_by(maker, facet, &parted, parted.plane);
        add_parted(maker, facet, parted);
    }
    for (uint32_t i = 0; i < record->met_count; i++)
        if (pir_space_grow(space, (void **)&facet->met, &facet->met_room, facet->met_count, sizeof *facet->met))
            facet->met[facet->met_count++] = record->met[i];
    for (uint32_t i = 0; i < record->points.count; i++)
        pir_number_list_add(&facet->made, space, record->points.number[i]);
    facet->fleeting = record->fleeting;
    facet->hot_clipped = facet->hot_count;
}

/* Adds the sides of a part that is left. Parts do not overlap, so that what they share is led along both ways. */
static void add_sides(pir_facet_maker *maker, pir_plane_facet *facet, pir_polygon part) {
    const uint32_t *point = maker->polygons.point + part.first, *wall = maker->polygons.wall + part.first;
    pir_segment_list *edge = &facet->edge;
    for (uint32_t i = 0; i < part.count; i++)
        if (pir_space_grow(maker->space, (void **)&edge->segment, &edge->room, edge->count, sizeof *edge->segment))
            edge->segment[edge->count++] =
                (pir_segment){{part.half >> 1, wall[i] >> 1}, point[i], point[i + 1 < part.count ? i + 1 : 0]};
}

void pir_kept_facet_clip(pir_facet_maker *maker, pir_plane_facet *facet) {
    pir_space *space = maker->space;
    pir_kept_facet_unclip(maker, facet);
    for (uint32_t i = 0; i < facet->points.count; i++)
        pir_space_renew_point(space, facet->points.number[i]);
    for (uint32_t i = 0; i < facet->planes.count; i++)
        pir_space_renew_plane(space, facet->planes.number[i]);
    const uint32_t clips = list_halves(maker, facet) ? list_clips(maker, facet) : 0;
    maker->kept.count = 0;
    pir_polygons_truncate(&maker->polygons, 0);
    pir_record_begin(&maker->record, space);
    for (uint32_t i = 0; i < facet->candidates.count && space->status == PIR_OK; i++)
        clip_candidate(maker, facet, i, clips);
    for (uint32_t i = 0; i < maker->kept.count && space->status == PIR_OK; i++)
        pir_record_met(&maker->polygons, maker->kept.polygon[i], PIR_SPACE_NONE);
    for (uint32_t i = 0; i < maker->kept.count && space->status == PIR_OK; i++)
        add_sides(maker, facet, maker->polygons.polygon[maker->kept.polygon[i]]);
    pir_record_end(space);
    keep_record(maker, facet);
    facet->stands = space->status == PIR_OK;
    maker->made++;
}

/* --- after a turn --- */

/* Whether no point is told to be above a plane: it cut nothing, nor held anything apart. */
static bool is_idle(const pir_plane_facet *facet, uint32_t plane) {
    for (uint32_t i = 0; i < facet->hot_count; i++)
        if (facet->hot[i].plane == plane && facet->hot[i].sign > 0)
            return false;
    for (uint32_t i = 0; i < facet->cold_count; i++)
        if (facet->cold[i].plane == plane && facet->cold[i].sign > 0)
            return false;
    return true;
}

/* Forgets the sides told of a plane, or of all that are dropped. */
static void forget_sides(const pir_facet_maker *maker, pir_plane_facet *facet, uint32_t plane) {
    uint32_t hot = 0, cold = 0;
    for (uint32_t i = 0; i < facet->hot_count; i++)
        if (facet->hot[i].plane != plane && !pir_plane_is_dropped(maker->pairs, facet->hot[i].plane))
            facet->hot[hot++] = facet->hot[i];
    for (uint32_t i = 0; i < facet->cold_count; i++)
        if (facet->cold[i].plane != plane && !pir_plane_is_dropped(maker->pairs, facet->cold[i].plane)) {
            facet->cold_until[cold] = facet->cold_until[i];
            facet->cold[cold++] = facet->cold[i];
        }
    facet->hot_count = hot;
    facet->cold_count = cold;
}

/* Whether a plane that a point is above now, below which it was, still cuts nothing of what its pair covers: then it is
 * taken as a new one. */
static bool is_spared(pir_facet_maker *maker, pir_plane_facet *facet, pir_told_side told) {
    uint32_t at = 0;
    while (at < facet->cut_count && facet->cut[at].plane != told.plane)
        at++;
    if (told.sign > 0 || at == facet->cut_count || maker->spared++ >= SPARED_MOST ||
        facet->hot_count > HOT_MOST(facet->hot_clipped) || !is_idle(facet, told.plane))
        return false;
    forget_sides(maker, facet, told.plane);
    pir_kept_facet_amend_plane(maker, facet, facet->cut[at].near, told.plane);
    return facet->stands;
}

/* Looks at a cold side again; whether it is as it was. */
static bool look_again(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t i) {
    pir_space *space = maker->space;
    const pir_told_side told = facet->cold[i];
    maker->looked++;
    pir_space_renew_point(space, told.point);
    if (!pir_space_look_at_plane(space, told.plane))
        return false;
    const double distance = pir_sure_distance(space, told.plane, told.point, told.sign);
    facet->cold_until[i] = side_until(maker, facet, told.plane, told.point, distance);
    return distance > 0 || pir_space_side(space, pir_half(told.plane, false), told.point) == told.sign;
}

static bool cold_sides_stand(pir_facet_maker *maker, pir_plane_facet *facet) {
    const double turn = maker->turn;
    double least = (double)INFINITY;
    if (turn < facet->told_until)
        return true;
    for (uint32_t i = 0; i < facet->cold_count; i++) {
        if (facet->cold_until[i] <= turn && !look_again(maker, facet, i)) {
            if (!is_spared(maker, facet, facet->cold[i]))
                return false;
            i = UINT32_MAX;
            least = (double)INFINITY;
            continue;
        }
        least = facet->cold_until[i] < least ? facet->cold_until[i] : least;
    }
    facet->told_until = least;
    return true;
}

/* Passes over hot sides, from one on, of which doubles say that they are as they were; the number of the next one. */
static uint32_t pass_sure(pir_facet_maker *maker, const pir_plane_facet *facet, uint32_t i) {
    pir_space *space = maker->space;
    uint32_t plane = PIR_SPACE_NONE;
    double a = 0, b = 0, c = 0, d = 0, err = 0;
    for (; i < facet->hot_count; i++) {
        const pir_told_side *side = &facet->hot[i];
        const pir_space_point *p = &space->point[side->point];
        // sides of one plane are told in a row
        if (side->plane != plane) {
            if (!pir_space_sees_plane(space, side->plane))
                break;
            const pir_space_plane *f = &space->plane[plane = side->plane];
            a = f->n[0], b = f->n[1], c = f->n[2], d = f->d, err = f->err + 0x1p-48;
        }
        if (!pir_space_sees_point(space, side->point) ||
            !(side->sign * (a * p->x[0] + b * p->x[1] + c * p->x[2] - d) > err + p->err))
            break;
    }
    return i;
}

static bool hot_sides_stand(pir_facet_maker *maker, pir_plane_facet *facet) {
    pir_space *space = maker->space;
    for (uint32_t i = pass_sure(maker, facet, 0); i < facet->hot_count; i = pass_sure(maker, facet, i)) {
        const pir_told_side side = facet->hot[i++];
        if (!pir_space_sees_point(space, side.point) || !pir_space_sees_plane(space, side.plane))
            return false;
        if (pir_space_side(space, pir_half(side.plane, false), side.point) == side.sign)
            continue;
        if (!is_spared(maker, facet, side))
            return false;
        i = 0;
    }
    maker->looked += facet->hot_count;
    return true;
}

/* Whether a polygon is still apart from the sum of its pair, by the plane at hand or another. */
static bool is_parted(pir_facet_maker *maker, const pir_plane_facet *facet, pir_parted_polygon *parted) {
    const pir_kept_pair_sum *sum = &maker->pairs->pair[facet->near[parted->set].pair];
    maker->looked++;
    if (parted->plane != PIR_SPACE_NONE && !pir_plane_is_dropped(maker->pairs, parted->plane) &&
        is_parted_by(maker, facet, parted, parted->plane))
        return true;
    for (uint32_t k = 0; k < sum->count; k++)
        if (is_parted_by(maker, facet, parted, sum->plane[k]))
            return true;
    return false;
}

/* Whether doubles say that a polygon is still above its plane. */
static bool is_surely_parted(pir_facet_maker *maker, const pir_plane_facet *facet, const pir_parted_polygon *parted) {
    pir_space *space = maker->space;
    if (!pir_space_sees_plane(space, parted->plane))
        return false;
    const pir_space_plane f = space->plane[parted->plane];
    const uint32_t *corner = facet->corners.number + parted->first;
    for (uint32_t i = 0; i < parted->count; i++) {
        if (!pir_space_sees_point(space, corner[i]))
            return false;
        const pir_space_point *p = &space->point[corner[i]];
        if (!(f.n[0] * p->x[0] + f.n[1] * p->x[1] + f.n[2] * p->x[2] - f.d > f.err + p->err + 0x1p-47))
            return false;
    }
    return true;
}

static bool parted_stand(pir_facet_maker *maker, pir_plane_facet *facet) {
    for (uint32_t i = 0; i < facet->parted_count; i++) {
        pir_parted_polygon *parted = &facet->parted[i];
        const bool dropped = maker->changed && pir_plane_is_dropped(maker->pairs, parted->plane);
        if (!dropped && parted->until > maker->turn)
            continue;
        // where it is to be looked at in every frame, no more is asked
        if (!dropped && parted->until < 0 && is_surely_parted(maker, facet, parted)) {
            maker->looked++;
            continue;
        }
        if (!is_parted(maker, facet, parted))
            return false;
    }
    return true;
}

void pir_kept_facet_amend_plane(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t at, uint32_t plane) {
    pir_space *space = maker->space;
    pir_space_renew_plane(space, plane);
    for (uint32_t i = 0; i < facet->met_count && facet->stands; i++) {
        const pir_met met = facet->met[i];
        for (uint32_t k = met.first; k < met.first + met.count && met.set == at && facet->stands; k++) {
            const uint32_t corner = facet->corners.number[k];
            if (!pir_space_look_at_point(space, corner))
                facet->stands = false;
            else if (pir_sure_distance(space, plane, corner, -1) > 0)
                keep_side(maker, facet, (pir_told_side){plane, corner, -1});
            else
                facet->stands = pir_identity_holds(space, plane, corner);
        }
    }
}

void pir_kept_facet_amend_pair(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t at) {
    for (uint32_t i = 0; i < facet->met_count && facet->stands; i++) {
        const pir_met met = facet->met[i];
        if (met.set != PIR_SPACE_NONE)
            continue;
        pir_parted_polygon parted = {.set = at, .plane = PIR_SPACE_NONE, .first = met.first, .count = met.count};
        facet->near[at].cover = PIR_COVER_CLIPS;
        facet->stands = is_parted(maker, facet, &parted);
        add_parted(maker, facet, parted);
    }
}

/* Whether the planes that are dropped cut nothing and held nothing apart; what was told of them is forgotten. */
static bool outlives_dropped(const pir_facet_maker *maker, pir_plane_facet *facet) {
    bool named = false;
    for (uint32_t i = 0; i < facet->hot_count; i++)
        if (pir_plane_is_dropped(maker->pairs, facet->hot[i].plane)) {
            named = true;
            if (facet->hot[i].sign > 0)
                return false;
        }
    for (uint32_t i = 0; i < facet->cold_count; i++)
        if (pir_plane_is_dropped(maker->pairs, facet->cold[i].plane)) {
            named = true;
            if (facet->cold[i].sign > 0)
                return false;
        }
    if (named)
        forget_sides(maker, facet, PIR_SPACE_NONE);
    return true;
}

bool pir_kept_facet_stands(pir_facet_maker *maker, pir_plane_facet *facet) {
    maker->spared = 0;
    facet->stands = facet->stands && !facet->fleeting && (!maker->changed || outlives_dropped(maker, facet)) &&
                    cold_sides_stand(maker, facet) && hot_sides_stand(maker, facet) && parted_stand(maker, facet);
    return facet->stands;
}

/* SPDX-License-Identifier: MIT */
/*
 * The nearest free place x to t, where P is: the nearest point outside of the insides of all sums S_kl.
 *
 * The last bit of the way from t to x is inside of some sum, of whose facets at x all have t below their planes. So
 * x is on a facet with t strictly below, and the first free point of any of these is the answer: pairs, facets and
 * parts of facets are taken best first, by a lower bound of their distance. A part whose nearest point is inside of a
 * sum is replaced by what that sum leaves of it; one whose nearest point is free is a candidate. Nothing else has to be
 * known of a part, or of sums that are farther off: the union is never built. Each part is cut by a sum at most once,
 * so the search ends.
 *
 * Bounds and distances are intervals; candidates whose intervals meet are compared exactly. So the least counts, and of
 * equal ones the first: by pieces and the order of planes (obstacle.h), then by the coordinates of the point.
 *
 * Along a direction the same holds of a line: the way out of a sum that holds t is either free or in another sum.
 */
#include "solid/depth/depth_search.h"

#include <math.h>

bool pir_depth_search_init(pir_depth_search *search, const pir_compound *p, const pir_compound *q,
                           const pir_allocator *allocator) {
    search->parts.obstacle = &search->obstacle;
    return pir_obstacle_init(&search->obstacle, p, q, allocator) &&
           pir_covers_init(&search->covers, &search->obstacle) && pir_kept_covers_init(&search->kept, &search->covers);
}

void pir_depth_search_finish(pir_depth_search *search) {
    PIR_FREE(&search->obstacle.allocator, search->heap, search->heap_room);
    pir_free_parts_finish(&search->parts);
    pir_kept_covers_finish(&search->kept);
    pir_covers_finish(&search->covers);
    pir_obstacle_finish(&search->obstacle);
}

/* --- the heap --- */

static void push(pir_depth_search *s, double least, int kind, uint32_t number) {
    if (!pir_obstacle_grow(&s->obstacle, (void **)&s->heap, &s->heap_room, s->heap_count, sizeof *s->heap))
        return;
    uint32_t at = s->heap_count++;
    for (; at > 0 && s->heap[(at - 1) / 2].least > least; at = (at - 1) / 2)
        s->heap[at] = s->heap[(at - 1) / 2];
    s->heap[at] = (pir_depth_item){.least = least, .number = number};
    s->heap[at].kind = kind;
}

static pir_depth_item pop(pir_depth_search *s) {
    const pir_depth_item first = s->heap[0], last = s->heap[--s->heap_count];
    uint32_t at = 0;
    for (;;) {
        uint32_t child = 2 * at + 1;
        if (child + 1 < s->heap_count && s->heap[child + 1].least < s->heap[child].least)
            child++;
        if (child >= s->heap_count || s->heap[child].least >= last.least)
            break;
        s->heap[at] = s->heap[child];
        at = child;
    }
    s->heap[at] = last;
    return first;
}

/* --- the nearest of all --- */

/* A lower bound of how far a sum is from the place of P: 0 where its box holds it. */
static double box_distance(const pir_obstacle *o, uint32_t pair) {
    const pir_space_box box = pir_obstacle_box(o, pair);
    const double *t = o->point[0].x;
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double gap = fmax(fmax(box.low[k] - t[k], t[k] - box.high[k]) - 0x1p-44, 0);
        square += gap * gap;
    }
    return sqrt(square) * (1 - 0x1p-48);
}

/* Whether the place of P is strictly below a plane. */
static bool is_below(pir_obstacle *o, uint32_t f, double slack, double room) {
    return slack > room || (slack >= -room && pir_obstacle_exact_side(o, f, 0) < 0);
}

/* How far the place of P is below a plane, and what that may be off by. */
static double slack_of(const pir_obstacle *o, uint32_t f, double *ret_room) {
    const pir_obstacle_plane *plane = &o->plane[f];
    const double *t = o->point[0].x;
    *ret_room = plane->err + o->point[0].err + 0x1p-50;
    return plane->d - (plane->n[0] * t[0] + plane->n[1] * t[1] + plane->n[2] * t[2]);
}

/* The planes of a pair's facets that the place of P is strictly below. */
static void push_planes(pir_depth_search *s, const pir_depth_item *item) {
    pir_obstacle *o = &s->obstacle;
    const pir_obstacle_sum sum = *pir_obstacle_open(o, item->number);
    for (uint32_t f = sum.first; f < sum.first + sum.count && o->status == PIR_OK; f++) {
        double room;
        const double slack = slack_of(o, f, &room);
        if (is_below(o, f, slack, room))
            push(s, fmax(slack - room, item->least), PIR_DEPTH_PLANE, f);
    }
}

/* Whether the nearest point of a part comes before what was found. */
static bool comes_before(pir_obstacle *o, const pir_free_part *part, const pir_depth_found *found, const double most) {
    if (part->least > most)
        return false;
    const int nearer = found->point == part->nearest ? 0 : pir_obstacle_exact_nearer(o, part->nearest, found->point);
    if (nearer != 0)
        return nearer < 0;
    const pir_obstacle_plane *a = &o->plane[part->plane], *b = &o->plane[found->plane];
    if (a->pair != b->pair)
        return a->pair < b->pair;
    if (part->plane != found->plane)
        return part->plane < found->plane;
    return pir_obstacle_exact_order(o, part->nearest, found->point) < 0;
}

static void push_parts(pir_depth_search *s, uint32_t from, double least) {
    for (uint32_t k = from; k < s->parts.count; k++)
        push(s, fmax(s->parts.part[k].least, least), PIR_DEPTH_PART, k);
}

/* Facets with more corners are divided at once. */
#define MOST_CORNERS 32

/* The plane of a facet: the facet, where it may be free, by how far it is itself. */
static void look_at_plane(pir_depth_search *s, const pir_depth_item *item) {
    double corner[MOST_CORNERS][3];
    const uint32_t count = pir_free_parts_corners(&s->obstacle, item->number, MOST_CORNERS, corner);
    uint32_t cover = PIR_OBSTACLE_NONE;
    if (!(pir_covers_all(&s->covers, s->obstacle.plane[item->number].pair, 0, &cover, count,
                         (const double(*)[3])corner) > 0))
        push(s, pir_facet_distance(&s->obstacle, item->number, count, corner, item->least), PIR_DEPTH_FACET,
             item->number);
}

/* The facet of a plane of a pair, where something was found: pushed where it may be free, no farther than `most`. What
 * covers it, for what is no farther than `most` and somewhat more. */
static pir_kept_cover look_at_facet(pir_depth_search *s, uint32_t f, double least, double most) {
    static const pir_kept_cover none = {0, 0};
    pir_obstacle *o = &s->obstacle;
    pir_kept_covers *kept = &s->kept;
    const bool known = s->has_last && pir_facet_key_equal(pir_facet_key_of(&o->plane[f]), s->last);
    double room, corner[MOST_CORNERS][3];
    const double slack = slack_of(o, f, &room);
    if (fabs(slack) - room > most + pir_kept_covers_more(kept))
        return (pir_kept_cover){HUGE_VAL, kept->way + fabs(slack) - room};
    if (known)
        return none;
    pir_kept_cover cover = pir_kept_covers_find(kept, f, most);
    if (cover.until > 0)
        return cover;
    const uint32_t count = pir_free_parts_corners(o, f, MOST_CORNERS, corner);
    const double at_least = pir_facet_distance(o, f, count, corner, fmax(fabs(slack) - room, least));
    if (count > 0 && at_least > most + pir_kept_covers_more(kept))
        return (pir_kept_cover){HUGE_VAL, kept->way + at_least};
    cover = count > 0 ? pir_kept_covers_make(kept, f, count, corner, most) : none;
    if (!(cover.until > 0) && at_least <= most && is_below(o, f, slack, room))
        push(s, at_least, PIR_DEPTH_FACET, f);
    return cover;
}

/* A pair where something was found: its facets that may be free, and what covers them all. Those that the place of P is
 * above are never left by; they are looked at where the others are covered for some time, so that the pair may be. */
static void look_at_pair(pir_depth_search *s, const pir_depth_item *item, double most) {
    pir_obstacle *o = &s->obstacle;
    const pir_obstacle_sum sum = *pir_obstacle_open(o, item->number);
    const double later = s->kept.turned + 2 * s->kept.step_turned;
    pir_kept_cover all = {HUGE_VAL, HUGE_VAL};
    for (int above = 0; above < 2 && (above == 0 || all.until > later); above++)
        for (uint32_t f = sum.first; f < sum.first + sum.count && o->status == PIR_OK; f++) {
            double room;
            const double slack = slack_of(o, f, &room);
            if ((slack < -room) != above)
                continue;
            const pir_kept_cover cover = look_at_facet(s, f, item->least, most);
            all.until = fmin(all.until, cover.until);
            all.reach = fmin(all.reach, cover.reach);
        }
    if (!(all.until > later))
        all.until = 0;
    s->kept.pair[item->number] = all;
}

/* A part: what is left of it, or, where its nearest point is free, what was found and no farther than *most. */
static void look_at_part(pir_depth_search *s, const pir_depth_item *item, pir_depth_found *found, double *most) {
    pir_obstacle *o = &s->obstacle;
    const pir_free_part part = s->parts.part[item->number];
    const uint32_t cover = pir_covers_of(&s->covers, part.nearest);
    if (cover != PIR_OBSTACLE_NONE) {
        push_parts(s, pir_free_parts_subtract(&s->parts, item->number, pir_obstacle_open(o, cover)), item->least);
    } else if (found->plane == PIR_OBSTACLE_NONE || comes_before(o, &part, found, *most)) {
        *found = (pir_depth_found){part.plane, part.nearest};
        *most = fmin(*most, part.most);
    }
}

/* Looks at what may be as near as what was found, until nothing is left. */
static void search_heap(pir_depth_search *s, pir_depth_found *found, double *most) {
    while (s->heap_count > 0 && s->heap[0].least <= *most && s->obstacle.status == PIR_OK) {
        const pir_depth_item item = pop(s);
        switch (item.kind) {
        case PIR_DEPTH_PAIR:
            if (s->coherent && found->plane != PIR_OBSTACLE_NONE)
                look_at_pair(s, &item, *most);
            else
                push_planes(s, &item);
            break;
        case PIR_DEPTH_PLANE:
            look_at_plane(s, &item);
            break;
        case PIR_DEPTH_FACET:
            push_parts(s, pir_free_parts_facet(&s->parts, item.number), item.least);
            break;
        case PIR_DEPTH_PART:
            look_at_part(s, &item, found, most);
            break;
        }
    }
    s->heap_count = 0;
}

/* The facet of the last answer, where its pair still has it, looked at before all others. */
static void search_last(pir_depth_search *s, pir_depth_found *found, double *most) {
    pir_obstacle *o = &s->obstacle;
    const pir_obstacle_sum sum = *pir_obstacle_open(o, (uint32_t)(s->last.pair_kind >> 8));
    for (uint32_t f = sum.first; f < sum.first + sum.count && o->status == PIR_OK; f++) {
        double room;
        if (!pir_facet_key_equal(pir_facet_key_of(&o->plane[f]), s->last))
            continue;
        const double slack = slack_of(o, f, &room);
        if (is_below(o, f, slack, room))
            push(s, 0, PIR_DEPTH_FACET, f);
    }
    search_heap(s, found, most);
    s->has_last = found->plane != PIR_OBSTACLE_NONE;
}

pir_status pir_depth_search_nearest(pir_depth_search *search, const pir_pair_input *input, pir_depth_found *ret_found) {
    pir_depth_search *s = search;
    pir_obstacle *o = &s->obstacle;
    const pir_status status = pir_obstacle_set(o, input, NULL);
    if (status != PIR_OK)
        return status;
    s->coherent = pir_kept_covers_step(&s->kept);
    s->heap_count = s->parts.count = s->parts.used = 0;
    pir_depth_found found = {PIR_OBSTACLE_NONE, 0};
    double most = HUGE_VAL; // what was found is no farther
    if (s->has_last)
        search_last(s, &found, &most);
    for (uint32_t pair = 0; pair < o->pairs; pair++) {
        const double least = box_distance(o, pair);
        if (least <= most && !pir_kept_cover_holds(&s->kept, s->kept.pair[pair], most))
            push(s, least, PIR_DEPTH_PAIR, pair);
    }
    search_heap(s, &found, &most);
    if (o->status == PIR_OK && found.plane == PIR_OBSTACLE_NONE)
        o->status = PIR_ERR_INTERNAL;
    s->has_last = o->status == PIR_OK;
    if (o->status != PIR_OK)
        return o->status;
    s->last = pir_facet_key_of(&o->plane[found.plane]);
    *ret_found = found;
    return PIR_OK;
}

/* --- along a direction --- */

/* Whether the way rises through a plane; about where, in its length. */
static bool rises(pir_obstacle *o, uint32_t f, double *ret_at) {
    const pir_obstacle_plane *plane = &o->plane[f];
    const double *t = o->point[0].x;
    const double rate = plane->n[0] * o->way[0] + plane->n[1] * o->way[1] + plane->n[2] * o->way[2];
    const double room = 2 * plane->err + 0x1p-46;
    *ret_at = (plane->d - (plane->n[0] * t[0] + plane->n[1] * t[1] + plane->n[2] * t[2])) / rate;
    return rate > room || (rate >= -room && pir_obstacle_exact_rate(o, f) > 0);
}

/* Where the way from the place of P leaves a sum that it is in: on the first plane that it rises through. */
static uint32_t exit_of(pir_obstacle *o, const pir_obstacle_sum *sum, uint32_t *ret_plane) {
    double first = HUGE_VAL, at;
    uint32_t plane = PIR_OBSTACLE_NONE;
    for (uint32_t f = sum->first; f < sum->first + sum->count && o->status == PIR_OK; f++)
        if (rises(o, f, &at) && (plane == PIR_OBSTACLE_NONE || at < first)) {
            first = at;
            plane = f;
        }
    if (plane == PIR_OBSTACLE_NONE)
        return PIR_OBSTACLE_NONE;
    uint32_t best = pir_obstacle_add(o, PIR_OBSTACLE_ON_WAY, plane, PIR_OBSTACLE_NONE, PIR_OBSTACLE_NONE);
    // rounding may have hidden one that comes before: it has this point above
    for (uint32_t f = sum->first; f < sum->first + sum->count && o->status == PIR_OK; f++)
        if (f != plane && rises(o, f, &at) && pir_obstacle_side(o, f, best) > 0) {
            plane = f;
            best = pir_obstacle_add(o, PIR_OBSTACLE_ON_WAY, f, PIR_OBSTACLE_NONE, PIR_OBSTACLE_NONE);
        }
    *ret_plane = plane;
    return best;
}

pir_status pir_depth_search_along(pir_depth_search *search, const pir_pair_input *input, pir_vec3 way,
                                  pir_depth_found *ret_found) {
    pir_obstacle *o = &search->obstacle;
    const pir_status status = pir_obstacle_set(o, input, &way);
    if (status != PIR_OK)
        return status;
    pir_depth_found found = {PIR_OBSTACLE_NONE, 0};
    for (uint32_t cover = pir_covers_of(&search->covers, 0); cover != PIR_OBSTACLE_NONE && o->status == PIR_OK;
         cover = pir_covers_of(&search->covers, found.point)) {
        found.point = exit_of(o, pir_obstacle_open(o, cover), &found.plane);
        if (found.point == PIR_OBSTACLE_NONE)
            o->status = PIR_ERR_INTERNAL;
        if (o->status != PIR_OK)
            break;
    }
    if (o->status == PIR_OK && found.plane == PIR_OBSTACLE_NONE)
        o->status = PIR_ERR_INTERNAL;
    if (o->status == PIR_OK)
        *ret_found = found;
    return o->status;
}

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
    return pir_obstacle_init(&search->obstacle, p, q, allocator);
}

void pir_depth_search_finish(pir_depth_search *search) {
    PIR_FREE(&search->obstacle.allocator, search->heap, search->heap_room);
    pir_free_parts_finish(&search->parts);
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

/* --- sums about a point --- */

/* Whether a point may be in the sum of two boxes. */
static inline bool boxes_hold(const pir_space_box *a, const pir_space_box *b, const pir_obstacle_point *p) {
    const double room = p->err + 0x1p-46;
    for (int k = 0; k < 3; k++)
        if (p->x[k] < a->low[k] + b->low[k] - room || p->x[k] > a->high[k] + b->high[k] + room)
            return false;
    return true;
}

/* How deep a point is in a sum at least, where it is inside of it; below 0 where it is not or, unless `exact`, where
 * doubles do not tell. */
static double depth_within(pir_obstacle *o, const pir_obstacle_sum *sum, uint32_t point, bool exact) {
    const pir_obstacle_point p = o->point[point];
    double least = HUGE_VAL;
    bool sure = true;
    for (int k = 0; k < 3 && p.kind != PIR_OBSTACLE_VERTICES; k++)
        if (p.of[k] != PIR_OBSTACLE_NONE && p.of[k] - sum->first < sum->count)
            return -1;
    for (uint32_t f = sum->first; f < sum->first + sum->count; f++) {
        const pir_obstacle_plane *plane = &o->plane[f];
        const double s = plane->d - (plane->n[0] * p.x[0] + plane->n[1] * p.x[1] + plane->n[2] * p.x[2]);
        const double bound = plane->err + p.err + 0x1p-50;
        if (s < -bound)
            return -1;
        sure = sure && s > bound;
        if (!sure && !exact)
            return -1;
        least = s - bound < least ? s - bound : least;
    }
    for (uint32_t f = sum->first; f < sum->first + sum->count && !sure; f++)
        if (pir_obstacle_side(o, f, point) >= 0)
            return -1;
    return least > 0 ? least : 0;
}

/* Makes a pair the first of those that have covered points of late. */
static void note_cover(pir_depth_search *s, uint32_t pair) {
    uint32_t at = 0;
    while (at < s->cover_count && s->cover[at] != pair)
        at++;
    if (at == s->cover_count && s->cover_count < PIR_DEPTH_COVERS)
        s->cover_count++;
    at = at < PIR_DEPTH_COVERS ? at : PIR_DEPTH_COVERS - 1;
    for (; at > 0; at--)
        s->cover[at] = s->cover[at - 1];
    s->cover[0] = pair;
}

/* The deepest of those sums, if a point is inside of any. */
static uint32_t late_cover(pir_depth_search *s, uint32_t point) {
    pir_obstacle *o = &s->obstacle;
    double deepest = 0;
    uint32_t best = PIR_OBSTACLE_NONE;
    for (uint32_t i = 0; i < s->cover_count; i++) {
        const double depth = depth_within(o, pir_obstacle_open(o, s->cover[i]), point, false);
        if (depth > deepest) {
            deepest = depth;
            best = s->cover[i];
        }
    }
    return best;
}

/* The pair in whose sum a point is deepest inside, or none. */
static uint32_t deepest_cover(pir_obstacle *o, uint32_t point) {
    const pir_framed_body *p = &o->frame.body[0], *q = &o->frame.body[1];
    uint32_t best = PIR_OBSTACLE_NONE;
    double deepest = -1;
    for (uint32_t i = 0; i < p->of->count; i++) {
        if (!boxes_hold(&p->box[i], &q->whole, &o->point[point]))
            continue;
        for (uint32_t j = 0; j < q->of->count && o->status == PIR_OK; j++) {
            if (!boxes_hold(&p->box[i], &q->box[j], &o->point[point]))
                continue;
            const uint32_t pair = i * q->of->count + j;
            const pir_obstacle_sum *sum = pir_obstacle_open(o, pair);
            const double depth = o->status == PIR_OK ? depth_within(o, sum, point, true) : -1;
            if (depth > deepest) {
                deepest = depth;
                best = pair;
            }
        }
    }
    return best;
}

/* A pair in whose sum a point is inside: one of those of late, or the deepest; or none. */
static uint32_t cover_of(pir_depth_search *s, uint32_t point) {
    uint32_t cover = late_cover(s, point);
    if (cover == PIR_OBSTACLE_NONE)
        cover = deepest_cover(&s->obstacle, point);
    if (cover != PIR_OBSTACLE_NONE)
        note_cover(s, cover);
    return cover;
}

/* --- covered facets --- */

/* Facets with more corners are divided at once. */
#define MOST_CORNERS 32

/* Whether all of some points, within 2^-47, are inside of a sum by doubles. */
static bool holds_all(const pir_obstacle *o, const pir_obstacle_sum *sum, uint32_t count, double (*point)[3]) {
    for (uint32_t f = sum->first; f < sum->first + sum->count; f++) {
        const pir_obstacle_plane *plane = &o->plane[f];
        const double most = plane->d - plane->err - 0x1p-46;
        for (uint32_t i = 0; i < count; i++)
            if (!(plane->n[0] * point[i][0] + plane->n[1] * point[i][1] + plane->n[2] * point[i][2] < most))
                return false;
    }
    return true;
}

/* The corners of a facet by doubles; count 0 where they are not known so. */
struct facet_corners {
    uint32_t count;
    double at[MOST_CORNERS][3];
};

/* Whether all of a facet is inside of one other sum that has covered points of late: then none of it is free. */
static bool is_covered(pir_depth_search *s, uint32_t facet, struct facet_corners *corners) {
    pir_obstacle *o = &s->obstacle;
    for (uint32_t i = 0; i < s->cover_count && corners->count > 0; i++) {
        const uint32_t cover = s->cover[i];
        if (cover != o->plane[facet].pair && o->sum[cover].count > 0 &&
            holds_all(o, &o->sum[cover], corners->count, corners->at)) {
            note_cover(s, cover);
            return true;
        }
    }
    return false;
}

static double square_between(const double a[3], const double b[3]) {
    const double to[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    return to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
}

/*
 * A lower bound of how far a facet is from the place of P: no less than `least`, which its plane is. Where the foot is
 * beyond a side, that is how far the nearest side is. Corners and place are within 2^-46, and feet on sides by doubles
 * are no farther than that from the true ones.
 */
static double facet_distance(const pir_obstacle *o, uint32_t facet, const struct facet_corners *corners, double least) {
    const double *n = o->plane[facet].n, *t = o->point[0].x;
    double square = HUGE_VAL;
    bool left = false, right = false;
    for (uint32_t i = 0; i < corners->count; i++) {
        const double *a = corners->at[i], *b = corners->at[i + 1 < corners->count ? i + 1 : 0];
        const double e[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, w[3] = {t[0] - a[0], t[1] - a[1], t[2] - a[2]};
        const double side = n[0] * (e[1] * w[2] - e[2] * w[1]) + n[1] * (e[2] * w[0] - e[0] * w[2]) +
                            n[2] * (e[0] * w[1] - e[1] * w[0]);
        const double part = (e[0] * w[0] + e[1] * w[1] + e[2] * w[2]) / (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
        const double by = part > 0 ? (part < 1 ? part : 1) : 0;
        const double foot[3] = {a[0] + by * e[0], a[1] + by * e[1], a[2] + by * e[2]};
        square = fmin(square, square_between(foot, t));
        left = left || side > 0;
        right = right || side < 0;
    }
    return left && right ? fmax(least, sqrt(square) - 0x1p-42) : least;
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

/* The planes of a pair's facets that the place of P is strictly below. */
static void push_planes(pir_depth_search *s, const pir_depth_item *item) {
    pir_obstacle *o = &s->obstacle;
    const pir_obstacle_sum sum = *pir_obstacle_open(o, item->number);
    const double *t = o->point[0].x;
    for (uint32_t f = sum.first; f < sum.first + sum.count && o->status == PIR_OK; f++) {
        const pir_obstacle_plane *plane = &o->plane[f];
        const double slack = plane->d - (plane->n[0] * t[0] + plane->n[1] * t[1] + plane->n[2] * t[2]);
        const double room = plane->err + o->point[0].err + 0x1p-50;
        if (slack < -room || (slack <= room && pir_obstacle_exact_side(o, f, 0) >= 0))
            continue;
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

/* The plane of a facet: the facet, where it may be free, by how far it is itself. */
static void look_at_plane(pir_depth_search *s, const pir_depth_item *item) {
    struct facet_corners corners;
    corners.count = pir_free_parts_corners(&s->obstacle, item->number, MOST_CORNERS, corners.at);
    if (!is_covered(s, item->number, &corners))
        push(s, facet_distance(&s->obstacle, item->number, &corners, item->least), PIR_DEPTH_FACET, item->number);
}

/* A part: what is left of it, or, where its nearest point is free, what was found and no farther than *most. */
static void look_at_part(pir_depth_search *s, const pir_depth_item *item, pir_depth_found *found, double *most) {
    pir_obstacle *o = &s->obstacle;
    const pir_free_part part = s->parts.part[item->number];
    const uint32_t cover = cover_of(s, part.nearest);
    if (cover != PIR_OBSTACLE_NONE) {
        push_parts(s, pir_free_parts_subtract(&s->parts, item->number, pir_obstacle_open(o, cover)), item->least);
    } else if (found->plane == PIR_OBSTACLE_NONE || comes_before(o, &part, found, *most)) {
        *found = (pir_depth_found){part.plane, part.nearest};
        *most = fmin(*most, part.most);
    }
}

pir_status pir_depth_search_nearest(pir_depth_search *search, const pir_pair_input *input, pir_depth_found *ret_found) {
    pir_depth_search *s = search;
    pir_obstacle *o = &s->obstacle;
    const pir_status status = pir_obstacle_set(o, input, NULL);
    if (status != PIR_OK)
        return status;
    s->heap_count = s->parts.count = s->parts.used = 0;
    for (uint32_t pair = 0; pair < o->pairs; pair++)
        push(s, box_distance(o, pair), PIR_DEPTH_PAIR, pair);
    pir_depth_found found = {PIR_OBSTACLE_NONE, 0};
    double most = HUGE_VAL; // what was found is no farther
    while (s->heap_count > 0 && s->heap[0].least <= most && o->status == PIR_OK) {
        const pir_depth_item item = pop(s);
        switch (item.kind) {
        case PIR_DEPTH_PAIR:
            push_planes(s, &item);
            break;
        case PIR_DEPTH_PLANE:
            look_at_plane(s, &item);
            break;
        case PIR_DEPTH_FACET:
            push_parts(s, pir_free_parts_facet(&s->parts, item.number), item.least);
            break;
        case PIR_DEPTH_PART:
            look_at_part(s, &item, &found, &most);
            break;
        }
    }
    if (o->status == PIR_OK && found.plane == PIR_OBSTACLE_NONE)
        o->status = PIR_ERR_INTERNAL;
    if (o->status == PIR_OK)
        *ret_found = found;
    return o->status;
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
    for (uint32_t cover = cover_of(search, 0); cover != PIR_OBSTACLE_NONE && o->status == PIR_OK;
         cover = cover_of(search, found.point)) {
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

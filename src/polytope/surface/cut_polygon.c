/* SPDX-License-Identifier: MIT */
/*
 * See cut_polygon.h. A part of the polygon is the corners on one facet of the hull, in the order of the polygon, where
 * these are not all on a line. The parts make up the polygon when each side of the polygon is a side of one part, and
 * every other side of a part is also a side of another part, walked the other way.
 */
#include "polytope/surface/cut_polygon.h"

#include <stdlib.h>
#include <string.h>

#include "base/sort.h"

/* A facet and the position of a corner on it; or a side of a part, from a lower position to twice a higher one, plus 1
 * when walked back. */
struct pair {
    uint32_t first, second;
};

struct polygon_cut {
    const pir_allocator *allocator;
    const uint32_t *corner; /* of the polygon */
    uint32_t count;
    uint32_t room;      /* of the four arrays below */
    struct pair *pairs; /* facets and positions, then sorted */
    struct pair *sides; /* of parts, those of the polygon left out */
    uint32_t *order, *work;
    uint32_t side_count;
    uint8_t *seen; /* per side of the polygon: a part has it */
};

static bool pair_before(void *context, uint32_t a, uint32_t b) {
    const struct pair *pair = context;
    return pair[a].first != pair[b].first ? pair[a].first < pair[b].first : pair[a].second < pair[b].second;
}

/* Puts cut->order in the order of `count` pairs. */
static void sort_pairs(struct polygon_cut *cut, struct pair *pairs, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        cut->order[i] = i;
    pir_sort(cut->order, count, cut->work, pair_before, pairs);
}

static bool init_cut(struct polygon_cut *cut, const struct pir_on_hull *on, const uint32_t *corner, uint32_t count) {
    *cut = (struct polygon_cut){.allocator = on->allocator, .corner = corner, .count = count};
    for (uint32_t i = 0; i < count; i++)
        cut->room += pir_on_hull_degree(on, corner[i]);
    cut->pairs = PIR_NEW(on->allocator, struct pair, cut->room);
    cut->sides = PIR_NEW(on->allocator, struct pair, cut->room);
    cut->order = PIR_NEW(on->allocator, uint32_t, cut->room);
    cut->work = PIR_NEW(on->allocator, uint32_t, cut->room);
    cut->seen = PIR_ZEROED(on->allocator, uint8_t, count);
    return cut->pairs && cut->sides && cut->order && cut->work && cut->seen;
}

static void finish_cut(struct polygon_cut *cut) {
    PIR_FREE(cut->allocator, cut->seen, cut->count);
    PIR_FREE(cut->allocator, cut->work, cut->room);
    PIR_FREE(cut->allocator, cut->order, cut->room);
    PIR_FREE(cut->allocator, cut->sides, cut->room);
    PIR_FREE(cut->allocator, cut->pairs, cut->room);
}

/* Notes the sides of the part whose corners' positions are `position`, rising; false when a side of the polygon is in
 * two parts. */
static bool note_sides(struct polygon_cut *cut, const uint32_t *position, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        uint32_t from = position[i], to = position[i + 1 < count ? i + 1 : 0];
        if (to == (from + 1) % cut->count) {
            if (cut->seen[from]++)
                return false;
        } else {
            cut->sides[cut->side_count++] = from < to ? (struct pair){from, 2 * to} : (struct pair){to, 2 * from + 1};
        }
    }
    return true;
}

/* Whether the corners at these positions are on a line. */
static bool on_a_line(struct pir_on_hull *on, const struct polygon_cut *cut, const uint32_t *position, uint32_t count) {
    for (uint32_t i = 2; i < count; i++)
        if (!pir_collinear(&on->points, cut->corner[position[0]], cut->corner[position[1]], cut->corner[position[i]]))
            return false;
    return true;
}

/* Every side of a part that is none of the polygon must be walked as often one way as the other. */
static bool sides_cancel(struct polygon_cut *cut) {
    sort_pairs(cut, cut->sides, cut->side_count);
    const struct pair *sides = cut->sides;
    for (uint32_t i = 0, end; i < cut->side_count; i = end) {
        const struct pair *side = &sides[cut->order[i]];
        uint32_t back = 0;
        for (end = i; end < cut->side_count && sides[cut->order[end]].first == side->first &&
                      sides[cut->order[end]].second / 2 == side->second / 2;
             end++)
            back += sides[cut->order[end]].second % 2;
        if (2 * back != end - i)
            return false;
    }
    return true;
}

/* Adds the parts to `volumes`; whether they make up the polygon. */
static bool add_parts(struct pir_on_hull *on, struct polygon_cut *cut, bool turned, struct pir_six_volumes *volumes) {
    uint32_t *position = cut->work, *corner = cut->order;
    for (uint32_t i = 0, end; i < cut->room; i = end) {
        for (end = i; end < cut->room && cut->pairs[end].first == cut->pairs[i].first; end++) {
            position[end - i] = cut->pairs[end].second;
            corner[end - i] = cut->corner[cut->pairs[end].second];
        }
        if (end - i < 3 || on_a_line(on, cut, position, end - i))
            continue;
        if (!note_sides(cut, position, end - i))
            return false;
        pir_six_volumes_add(volumes, corner, end - i, turned);
    }
    return memchr(cut->seen, 0, cut->count) == NULL && sides_cancel(cut);
}

/* Cuts a polygon whose corners are all found, and not all on one facet. */
static enum pir_on_hull_answer cut_polygon(struct pir_on_hull *on, const uint32_t *corner, uint32_t count, bool turned,
                                           struct pir_six_volumes *volumes) {
    struct polygon_cut cut;
    enum pir_on_hull_answer answer = PIR_ON_HULL_NO_MEMORY;
    if (init_cut(&cut, on, corner, count)) {
        // sorted by facets: the corners on each, in the order of the polygon
        uint32_t filled = 0;
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t k = 0; k < pir_on_hull_degree(on, corner[i]); k++)
                cut.sides[filled++] = (struct pair){pir_on_hull_facet(on, corner[i], k), i};
        sort_pairs(&cut, cut.sides, cut.room);
        for (uint32_t i = 0; i < cut.room; i++)
            cut.pairs[i] = cut.sides[cut.order[i]];
        answer = add_parts(on, &cut, turned, volumes) ? PIR_IS_ON_HULL : PIR_IS_OFF_HULL;
    }
    finish_cut(&cut);
    return answer;
}

enum pir_on_hull_answer pir_cut_polygon(struct pir_on_hull *on, const uint32_t *corner, uint32_t count, bool turned,
                                        struct pir_six_volumes *volumes) {
    if (count == 0)
        return PIR_IS_ON_HULL;
    if (!pir_on_hull_find(on, corner, count))
        return PIR_IS_OFF_HULL;
    if (!pir_on_hull_is_on_one(on, corner, count))
        return count > 3 ? cut_polygon(on, corner, count, turned, volumes) : PIR_IS_OFF_HULL;
    pir_six_volumes_add(volumes, corner, count, turned);
    return PIR_IS_ON_HULL;
}

/* SPDX-License-Identifier: MIT */
/*
 * See subtract.h. A fragment is cut by one plane after the other; what is above a plane stays, and what is left in the
 * end is covered. A fragment that the set does not meet is left as it is, so nothing is cut in vain: that is asked
 * first, by doubles alone, then with every plane exactly, and once more while cutting.
 */
#include "solid/sum/subtract.h"

#include <math.h>

#include "solid/space/record.h"

void pir_fragments_finish(pir_fragments *fragments, pir_space *space) {
    pir_space_shrink(space, fragments->polygon, fragments->room, sizeof *fragments->polygon);
    pir_space_shrink(space, fragments->spare, fragments->spare_room, sizeof *fragments->spare);
    *fragments = (pir_fragments){0};
}

void pir_fragments_add(pir_fragments *fragments, pir_space *space, uint32_t polygon) {
    if (pir_space_grow(space, (void **)&fragments->polygon, &fragments->room, fragments->count,
                       sizeof *fragments->polygon))
        fragments->polygon[fragments->count++] = polygon;
}

static bool is_above(const pir_polygons *polygons, pir_polygon p, uint32_t half) {
    const pir_space *space = polygons->space;
    const pir_space_plane *f = &space->plane[half >> 1];
    const double turn = half & 1 ? -1 : 1;
    for (uint32_t i = 0; i < p.count; i++) {
        const pir_space_point *x = &space->point[polygons->point[p.first + i]];
        if (!(turn * (f->n[0] * x->x[0] + f->n[1] * x->x[1] + f->n[2] * x->x[2] - f->d) > f->err + x->err + 0x1p-48))
            return false;
    }
    return true;
}

bool pir_polygon_is_apart(const pir_polygons *polygons, uint32_t polygon, const uint32_t *half, uint32_t count,
                          uint32_t *apart) {
    const pir_polygon p = polygons->polygon[polygon];
    uint32_t h = *apart;
    if (h >= count || !is_above(polygons, p, half[h]))
        for (h = 0; h < count && !is_above(polygons, p, half[h]); h++)
            ;
    if (h == count)
        return false;
    if (polygons->space->record)
        pir_record_parted(polygons, polygon, half[h]);
    *apart = h;
    return true;
}

/* The sign of the scalar product of two normals that are parallel, as half-spaces. */
static bool faces_same_way(const pir_space *space, uint32_t a, uint32_t b) {
    const double *m = space->plane[a >> 1].n, *n = space->plane[b >> 1].n;
    return (m[0] * n[0] + m[1] * n[1] + m[2] * n[2] > 0) == !((a ^ b) & 1);
}

enum meeting { MEETS, APART };

/* Whether doubles say that all of a ball is below a half-space. */
static bool is_ball_below(const pir_space *space, const pir_ball *ball, uint32_t half) {
    const pir_space_plane *f = &space->plane[half >> 1];
    return pir_ball_side(ball, f, pir_ball_depth(ball, f)) * (half & 1 ? -1 : 1) < 0;
}

/* Whether a fragment meets the set; the half-spaces that cut it are counted, and stand first in `cutter`, before all
 * others. Recorded is what tells that it does not: that a half-space cuts the fragment need not stay so. */
static enum meeting find_cutters(pir_polygons *polygons, uint32_t fragment, const uint32_t *half, uint32_t count,
                                 uint32_t *cutter, uint32_t *ret_cutters) {
    pir_space *space = polygons->space;
    pir_side_record *record = space->record;
    const pir_ball ball = pir_polygons_ball(polygons, fragment);
    uint32_t cutters = 0, others = count;
    space->record = NULL;
    enum meeting meeting = MEETS;
    for (uint32_t h = 0; h < count && meeting == MEETS; h++) {
        const unsigned sides =
            is_ball_below(space, &ball, half[h]) ? 1 : pir_polygons_sides(polygons, fragment, half[h]);
        if (sides == 2 || (sides == 0 && faces_same_way(space, polygons->polygon[fragment].half, half[h]))) {
            space->record = record;
            if (record)
                pir_polygons_sides(polygons, fragment, half[h]);
            meeting = APART;
        }
        cutter[sides == 3 ? cutters++ : --others] = half[h];
    }
    space->record = record;
    *ret_cutters = cutters;
    return meeting;
}

/* Records that half-spaces do not cut a fragment. */
static void record_below(pir_polygons *polygons, uint32_t fragment, const uint32_t *half, uint32_t count) {
    const pir_ball ball = pir_polygons_ball(polygons, fragment);
    for (uint32_t h = 0; h < count; h++)
        if (is_ball_below(polygons->space, &ball, half[h]))
            pir_record_polygon(polygons, fragment, half[h], -1);
        else
            pir_polygons_sides(polygons, fragment, half[h]);
}

/* Puts the half-space first that cuts most off a fragment, as its middle has it: the fewer parts are there in the end.
 * */
static void choose_cutter(const pir_polygons *polygons, uint32_t fragment, uint32_t *cutter, uint32_t count) {
    const pir_ball ball = pir_polygons_ball(polygons, fragment);
    double least = (double)INFINITY;
    uint32_t best = 0;
    for (uint32_t h = 0; h < count; h++) {
        const double depth = pir_ball_depth(&ball, &polygons->space->plane[cutter[h] >> 1]) * (cutter[h] & 1 ? -1 : 1);
        best = depth < least ? h : best;
        least = depth < least ? depth : least;
    }
    const uint32_t first = cutter[best];
    cutter[best] = cutter[0];
    cutter[0] = first;
}

static void subtract_one(pir_fragments *fragments, uint32_t at, pir_polygons *polygons, const uint32_t *half,
                         uint32_t count, pir_fragments *covered, uint32_t *apart) {
    pir_space *space = polygons->space;
    uint32_t rest = fragments->polygon[at], cutters = 0;
    if (pir_polygon_is_apart(polygons, rest, half, count, apart) ||
        !pir_space_grow(space, (void **)&fragments->spare, &fragments->spare_room, count, sizeof *fragments->spare))
        return;
    if (find_cutters(polygons, rest, half, count, fragments->spare, &cutters) == APART)
        return;
    const uint32_t before = fragments->count, polygon_count = polygons->count;
    for (uint32_t h = 0; h < cutters && space->status == PIR_OK; h++) {
        choose_cutter(polygons, rest, fragments->spare + h, cutters - h);
        const unsigned sides = pir_polygons_sides(polygons, rest, fragments->spare[h]);
        if (sides == 2) {
            // the set is beside what is left: the fragment was not met at all
            fragments->count = before;
            pir_polygons_truncate(polygons, polygon_count);
            return;
        }
        if (sides != 3)
            continue;
        uint32_t parts[2] = {0};
        pir_polygons_cut(polygons, rest, fragments->spare[h], parts);
        pir_fragments_add(fragments, space, parts[1]);
        rest = parts[0];
    }
    if (space->record) {
        record_below(polygons, fragments->polygon[at], fragments->spare + cutters, count - cutters);
        pir_record_met(polygons, rest, space->record->set);
    }
    if (covered)
        pir_fragments_add(covered, space, rest);
    fragments->polygon[at] = PIR_SPACE_NONE;
}

void pir_fragments_subtract(pir_fragments *fragments, pir_polygons *polygons, const uint32_t *half, uint32_t count,
                            pir_fragments *covered, uint32_t *apart) {
    const uint32_t before = fragments->count;
    for (uint32_t i = 0; i < before && polygons->space->status == PIR_OK; i++)
        subtract_one(fragments, i, polygons, half, count, covered, apart);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < fragments->count; i++)
        if (fragments->polygon[i] != PIR_SPACE_NONE)
            fragments->polygon[kept++] = fragments->polygon[i];
    fragments->count = kept;
}

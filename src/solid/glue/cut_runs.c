/* SPDX-License-Identifier: MIT */
/*
 * See cut_runs.h. The ends of runs are vertices; each cuts all runs that it lies on, those of its line and those of
 * other lines that have it within. Edges of the closed boundary do not cross within each other; where one is no side of
 * that, crossings are found as well: a point where a plane through one meets the other.
 */
#include "solid/glue/cut_runs.h"

#include "base/sort.h"
#include "solid/space/boxes.h"

/* Whether a point lies within a run, not at its ends: in both planes that meet in its line, and between the ends. */
static bool is_within(pir_union_outline *o, const pir_run *run, uint32_t point) {
    const uint32_t direction = o->line_direction[run->line], *plane = o->line_plane[run->line];
    return point != run->a && point != run->b && pir_space_side(o->space, pir_half(plane[0], false), point) == 0 &&
           pir_space_side(o->space, pir_half(plane[1], false), point) == 0 &&
           pir_space_order(o->space, direction, run->a, point) > 0 &&
           pir_space_order(o->space, direction, point, run->b) > 0;
}

void pir_union_outline_touch(pir_union_outline *outline, uint32_t line, uint32_t point) {
    pir_union_outline *o = outline;
    if (pir_space_grow(o->space, (void **)&o->touch, &o->touch_room, o->touch_count, sizeof *o->touch))
        o->touch[o->touch_count++] = (pir_outline_touch){line, point};
}

static bool touch_before(void *context, uint32_t a, uint32_t b) {
    const pir_union_outline *o = context;
    return o->touch[a].line < o->touch[b].line;
}

/* Notes the runs that a vertex lies within; `found` has room for all runs. */
static void find_touches(pir_union_outline *o, const pir_boxes *boxes, uint32_t point, uint32_t *found) {
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    pir_space_box_add(&box, &o->space->point[point]);
    for (uint32_t i = 0, count = pir_boxes_find(boxes, &box, found); i < count; i++)
        if (is_within(o, &o->run[found[i]], point))
            pir_union_outline_touch(o, o->run[found[i]].line, point);
}

/* Notes where runs r and s cross within each other. */
static void find_crossing(pir_union_outline *o, const pir_run *r, const pir_run *s) {
    pir_space *space = o->space;
    for (int k = 0; k < 2 && r->line != s->line; k++) {
        const uint32_t plane = o->line_plane[s->line][k], other = o->line_plane[s->line][1 - k];
        const int a = pir_space_side(space, pir_half(plane, false), r->a);
        if (a * pir_space_side(space, pir_half(plane, false), r->b) >= 0)
            continue;
        const uint32_t *own = o->line_plane[r->line];
        const uint32_t made = pir_space_add_meet(space, own[0], own[1], plane);
        if (pir_space_side(space, pir_half(other, false), made) != 0)
            return;
        const uint32_t point = pir_places_point(&o->points, made), along = o->line_direction[s->line];
        if (point == s->a || point == s->b || pir_space_order(space, along, s->a, point) <= 0 ||
            pir_space_order(space, along, point, s->b) <= 0)
            return;
        pir_union_outline_touch(o, r->line, point);
        pir_union_outline_touch(o, s->line, point);
        return;
    }
}

/* The crossings of a loose run with all others; of two loose ones, the earlier looks. */
static void find_crossings(pir_union_outline *o, const pir_boxes *boxes, uint32_t r, const pir_space_box *box,
                           uint32_t *found) {
    if (o->run[r].group < o->loose)
        return;
    for (uint32_t i = 0, count = pir_boxes_find(boxes, box, found); i < count && o->space->status == PIR_OK; i++)
        if (o->run[found[i]].group < o->loose || found[i] > r)
            find_crossing(o, &o->run[r], &o->run[found[i]]);
}

static void list_touches(pir_union_outline *o) {
    const pir_allocator *a = &o->space->allocator;
    pir_space_box *box = PIR_NEW(a, pir_space_box, o->run_count);
    uint32_t *found = PIR_NEW(a, uint32_t, o->run_count);
    for (uint32_t r = 0; r < o->run_count && box; r++) {
        box[r] = PIR_SPACE_BOX_EMPTY;
        pir_space_box_add(&box[r], &o->space->point[o->run[r].a]);
        pir_space_box_add(&box[r], &o->space->point[o->run[r].b]);
    }
    pir_boxes boxes;
    if (!box || !found || !pir_boxes_init(&boxes, a, box, o->run_count)) {
        o->space->status = PIR_ERR_MEMORY;
    } else {
        for (uint32_t r = 0; r < o->run_count && o->space->status == PIR_OK; r++) {
            // each vertex of a boundary begins one of its runs
            const pir_run run = o->run[r];
            find_touches(o, &boxes, run.sign > 0 ? run.a : run.b, found);
            if (run.group >= PIR_GROUP_CROSSING)
                find_touches(o, &boxes, run.b, found);
            find_crossings(o, &boxes, r, &box[r], found);
        }
        pir_boxes_finish(&boxes, a);
    }
    PIR_FREE(a, box, o->run_count);
    PIR_FREE(a, found, o->run_count);
}

/* Puts the touches in order of their lines. */
static void sort_touches(pir_union_outline *o) {
    if (!pir_union_outline_sort(o, o->touch_count, touch_before))
        return;
    const uint32_t count = o->touch_count;
    for (uint32_t i = 0; i < count; i++)
        if (pir_space_grow(o->space, (void **)&o->touch, &o->touch_room, count + i, sizeof *o->touch))
            o->touch[count + i] = o->touch[o->order[i]];
    for (uint32_t i = 0; i < count && o->space->status == PIR_OK; i++)
        o->touch[i] = o->touch[count + i];
}

static bool run_before(void *context, uint32_t a, uint32_t b) {
    const pir_union_outline *o = context;
    return o->run[a].line < o->run[b].line;
}

/* Cuts the runs order[0 .. count), which are on one line; the parts go to `side`. *touch is the first touch of the line
 * or of one after it, and becomes that of the next line. */
static void cut_line(pir_union_outline *o, const uint32_t *order, uint32_t count, uint32_t *touch) {
    o->place_count = 0;
    for (; *touch < o->touch_count && o->touch[*touch].line <= o->run[order[0]].line; ++*touch)
        pir_union_outline_push_place(o, o->touch[*touch].point);
    for (uint32_t i = 0; i < count; i++) {
        pir_union_outline_push_place(o, o->run[order[i]].a);
        pir_union_outline_push_place(o, o->run[order[i]].b);
    }
    if (!pir_union_outline_sort_places(o, o->run[order[0]].line))
        return;
    for (uint32_t i = 0; i < count && o->space->status == PIR_OK; i++) {
        pir_run run = o->run[order[i]];
        const uint32_t end = run.b;
        uint32_t at = 0;
        while (at < o->place_count && o->place[at] != run.a)
            at++;
        for (; run.a != end && at + 1 < o->place_count && o->space->status == PIR_OK; run.a = run.b) {
            run.b = o->place[++at];
            pir_union_outline_push_side(o, run);
        }
        if (run.a != end)
            pir_space_fault(o->space);
    }
}

static bool part_before(void *context, uint32_t a, uint32_t b) {
    const pir_union_outline *o = context;
    return o->side[a].group < o->side[b].group;
}

/* The sides, by group, become the runs. */
void pir_union_outline_sort_runs(pir_union_outline *outline) {
    pir_union_outline *o = outline;
    if (!pir_union_outline_sort(o, o->side_count, part_before))
        return;
    o->run_count = 0;
    for (uint32_t i = 0; i < o->side_count; i++)
        pir_union_outline_push(o, o->side[o->order[i]]);
}

void pir_union_outline_cut(pir_union_outline *outline) {
    pir_union_outline *o = outline;
    uint32_t touch = 0;
    o->side_count = 0;
    list_touches(o);
    sort_touches(o);
    if (!pir_union_outline_sort(o, o->run_count, run_before))
        return;
    for (uint32_t i = 0, end; i < o->run_count; i = end) {
        for (end = i + 1; end < o->run_count && !run_before(o, o->order[i], o->order[end]); end++)
            ;
        cut_line(o, o->order + i, end - i, &touch);
    }
    pir_union_outline_sort_runs(o);
}

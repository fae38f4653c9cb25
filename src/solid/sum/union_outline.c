/* SPDX-License-Identifier: MIT */
/*
 * See union_outline.h. Along each line of a plane, sides lead one way or the other; between neighbouring ends on
 * the line they add up to 1, 0 or −1, and where that is not 0 the union has its boundary. A boundary goes on
 * straight over ends at which the sum stays the same. What is left then as the end of a run is a vertex, and cuts
 * all runs that it lies on: those of its line, and those of other lines that have it within.
 */
#include "solid/sum/union_outline.h"

#include "base/sort.h"
#include "solid/space/boxes.h"
#include "solid/space/exact.h"

void pir_outline_init(pir_outline *outline, pir_space *space) {
    *outline = (pir_outline){.space = space};
    pir_intern_init(&outline->points, space, 4);
    pir_intern_init(&outline->lines, space, 6);
}

void pir_outline_finish(pir_outline *outline) {
    pir_space *space = outline->space;
    if (!space)
        return;
    pir_intern_finish(&outline->points);
    pir_intern_finish(&outline->lines);
    pir_space_shrink(space, outline->line_direction, outline->line_room, sizeof *outline->line_direction);
    pir_space_shrink(space, outline->line_of, outline->line_of_room, sizeof *outline->line_of);
    pir_space_shrink(space, outline->run, outline->run_room, sizeof *outline->run);
    pir_space_shrink(space, outline->side, outline->side_room, sizeof *outline->side);
    pir_space_shrink(space, outline->touch, outline->touch_room, sizeof *outline->touch);
    pir_space_shrink(space, outline->order, outline->order_room, sizeof *outline->order);
    pir_space_shrink(space, outline->work, outline->work_room, sizeof *outline->work);
    pir_space_shrink(space, outline->place, outline->place_room, sizeof *outline->place);
    *outline = (pir_outline){0};
}

/* --- lines --- */

/* The line where plane g cuts the plane of the group, f; its direction is made with it. */
static uint32_t line_of(pir_outline *o, uint32_t f, uint32_t g) {
    pir_space *space = o->space;
    const uint32_t before = o->line_of_room;
    if (!pir_space_grow(space, (void **)&o->line_of, &o->line_of_room, g, sizeof *o->line_of))
        return 0;
    for (uint32_t k = before; k < o->line_of_room; k++)
        o->line_of[k] = PIR_SPACE_NONE;
    if (o->line_of[g] != PIR_SPACE_NONE)
        return o->line_of[g];
    const uint32_t known = o->lines.count, line = pir_intern_line(&o->lines, f, g);
    if (!pir_space_grow(space, (void **)&o->line_direction, &o->line_room, line, sizeof *o->line_direction))
        return 0;
    if (line == known) {
        mpz_t *t = space->t + 8;
        for (uint32_t k = 0; k < 3; k++)
            mpz_set(t[k], space->number[o->lines.first[line] + k]);
        o->line_direction[line] = pir_space_add_direction(space, t[0], t[1], t[2]);
    }
    return o->line_of[g] = line;
}

static void forget_lines(pir_outline *o, const pir_polygons *polygons, pir_polygon p) {
    for (uint32_t i = 0; i < p.count; i++)
        if (polygons->wall[p.first + i] >> 1 < o->line_of_room)
            o->line_of[polygons->wall[p.first + i] >> 1] = PIR_SPACE_NONE;
}

static void push_run(pir_outline *o, pir_run run) {
    if (pir_space_grow(o->space, (void **)&o->run, &o->run_room, o->run_count, sizeof *o->run))
        o->run[o->run_count++] = run;
}

static void push_side(pir_outline *o, pir_run side) {
    if (pir_space_grow(o->space, (void **)&o->side, &o->side_room, o->side_count, sizeof *o->side))
        o->side[o->side_count++] = side;
}

static bool sort(pir_outline *o, uint32_t count, bool (*before)(void *, uint32_t, uint32_t)) {
    if (!pir_space_grow(o->space, (void **)&o->order, &o->order_room, count, sizeof *o->order) ||
        !pir_space_grow(o->space, (void **)&o->work, &o->work_room, count, sizeof *o->work))
        return false;
    for (uint32_t i = 0; i < count; i++)
        o->order[i] = i;
    pir_sort(o->order, count, o->work, before, o);
    return true;
}

/* --- the places of ends along a line --- */

struct along {
    pir_space *space;
    uint32_t direction;
};

static bool place_before(void *context, uint32_t a, uint32_t b) {
    const struct along *along = context;
    return a != b && pir_space_order(along->space, along->direction, a, b) > 0;
}

static void push_place(pir_outline *o, uint32_t point) {
    if (pir_space_grow(o->space, (void **)&o->place, &o->place_room, o->place_count, sizeof *o->place))
        o->place[o->place_count++] = point;
}

/* Puts the collected ends in order along the line, each once. */
static bool sort_places(pir_outline *o, uint32_t line) {
    if (!pir_space_grow(o->space, (void **)&o->work, &o->work_room, o->place_count, sizeof *o->work))
        return false;
    struct along along = {o->space, o->line_direction[line]};
    pir_sort(o->place, o->place_count, o->work, place_before, &along);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < o->place_count; i++)
        if (kept == 0 || o->place[kept - 1] != o->place[i])
            o->place[kept++] = o->place[i];
    o->place_count = kept;
    return true;
}

/* --- the boundary of a union --- */

static bool side_before(void *context, uint32_t a, uint32_t b) {
    const pir_outline *o = context;
    return o->side[a].line < o->side[b].line;
}

/* What the sides order[first .. end), which are on one line, add up to between two neighbouring ends. */
static int sum_between(const pir_outline *o, const uint32_t *order, uint32_t count, const uint32_t *rank, uint32_t at) {
    int sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        const pir_run *side = &o->side[order[i]];
        sum += rank[side->a] <= at && at < rank[side->b] ? side->sign : 0;
    }
    return sum;
}

/* The runs of one line, from its sides. */
static void add_line(pir_outline *o, const uint32_t *order, uint32_t count, uint32_t *rank) {
    const pir_run first = o->side[order[0]];
    o->place_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        push_place(o, o->side[order[i]].a);
        push_place(o, o->side[order[i]].b);
    }
    if (!sort_places(o, first.line))
        return;
    for (uint32_t i = 0; i < o->place_count; i++)
        rank[o->place[i]] = i;
    int sum = 0;
    uint32_t from = 0;
    for (uint32_t i = 0; i < o->place_count; i++) {
        const int next = i + 1 < o->place_count ? sum_between(o, order, count, rank, i) : 0;
        if (next == sum)
            continue;
        if (sum != 0)
            push_run(o, (pir_run){first.half, first.line, o->place[from], o->place[i], sum > 0 ? 1 : -1});
        sum = next;
        from = i;
    }
}

static void add_sides(pir_outline *o, const pir_polygons *polygons, uint32_t polygon) {
    const pir_polygon p = polygons->polygon[polygon];
    for (uint32_t i = 0; i < p.count && o->space->status == PIR_OK; i++) {
        const uint32_t line = line_of(o, p.half >> 1, polygons->wall[p.first + i] >> 1);
        const uint32_t a = pir_intern_point(&o->points, polygons->point[p.first + i]);
        const uint32_t b = pir_intern_point(&o->points, polygons->point[p.first + (i + 1 < p.count ? i + 1 : 0)]);
        if (o->space->status != PIR_OK)
            return;
        const bool along = pir_space_order(o->space, o->line_direction[line], a, b) > 0;
        push_side(o, (pir_run){p.half, line, along ? a : b, along ? b : a, along ? 1 : -1});
    }
}

void pir_outline_add(pir_outline *outline, const pir_polygons *polygons, const uint32_t *polygon, uint32_t count) {
    pir_outline *o = outline;
    o->side_count = 0;
    for (uint32_t i = 0; i < count; i++)
        add_sides(o, polygons, polygon[i]);
    for (uint32_t i = 0; i < count; i++)
        forget_lines(o, polygons, polygons->polygon[polygon[i]]);
    const uint32_t points = o->space->point_count;
    uint32_t *rank = PIR_NEW(&o->space->allocator, uint32_t, points);
    if (!rank)
        o->space->status = PIR_ERR_MEMORY;
    if (rank && sort(o, o->side_count, side_before))
        for (uint32_t i = 0, end; i < o->side_count; i = end) {
            for (end = i + 1; end < o->side_count && !side_before(o, o->order[i], o->order[end]); end++)
                ;
            add_line(o, o->order + i, end - i, rank);
        }
    PIR_FREE(&o->space->allocator, rank, points);
}

/* --- runs cut at each other's ends --- */

/* Whether a point lies within a run, not at its ends. */
static bool is_within(pir_outline *o, const pir_run *run, uint32_t point) {
    const uint32_t direction = o->line_direction[run->line];
    return point != run->a && point != run->b && pir_space_order(o->space, direction, run->a, point) > 0 &&
           pir_space_order(o->space, direction, point, run->b) > 0 && pir_space_side(o->space, run->half, point) == 0 &&
           pir_space_turn(o->space, run->half, run->a, run->b, point) == 0;
}

static bool touch_before(void *context, uint32_t a, uint32_t b) {
    const pir_outline *o = context;
    return o->touch[a].line < o->touch[b].line;
}

/* Notes which runs a vertex lies within; `found` has room for all runs. */
static void find_touches(pir_outline *o, const pir_boxes *boxes, uint32_t *found) {
    for (uint32_t r = 0; r < o->run_count && o->space->status == PIR_OK; r++) {
        const uint32_t point = o->run[r].sign > 0 ? o->run[r].a : o->run[r].b;
        pir_box box = PIR_BOX_EMPTY;
        pir_box_add(&box, &o->space->point[point]);
        for (uint32_t i = 0, count = pir_boxes_find(boxes, &box, found); i < count; i++) {
            const pir_run *run = &o->run[found[i]];
            if (is_within(o, run, point) &&
                pir_space_grow(o->space, (void **)&o->touch, &o->touch_room, o->touch_count, sizeof *o->touch))
                o->touch[o->touch_count++] = (pir_touch){run->line, point};
        }
    }
}

static void list_touches(pir_outline *o) {
    const pir_allocator *a = &o->space->allocator;
    pir_box *box = PIR_NEW(a, pir_box, o->run_count);
    uint32_t *found = PIR_NEW(a, uint32_t, o->run_count);
    o->touch_count = 0;
    for (uint32_t r = 0; r < o->run_count && box; r++) {
        box[r] = PIR_BOX_EMPTY;
        pir_box_add(&box[r], &o->space->point[o->run[r].a]);
        pir_box_add(&box[r], &o->space->point[o->run[r].b]);
    }
    pir_boxes boxes;
    if (!box || !found) {
        o->space->status = PIR_ERR_MEMORY;
    } else if (pir_boxes_init(&boxes, o->space, box, o->run_count)) {
        find_touches(o, &boxes, found);
        pir_boxes_finish(&boxes, a);
    }
    PIR_FREE(a, box, o->run_count);
    PIR_FREE(a, found, o->run_count);
}

/* Puts the touches in order of their lines. */
static void sort_touches(pir_outline *o) {
    if (!sort(o, o->touch_count, touch_before))
        return;
    const uint32_t count = o->touch_count;
    for (uint32_t i = 0; i < count; i++)
        if (pir_space_grow(o->space, (void **)&o->touch, &o->touch_room, count + i, sizeof *o->touch))
            o->touch[count + i] = o->touch[o->order[i]];
    for (uint32_t i = 0; i < count && o->space->status == PIR_OK; i++)
        o->touch[i] = o->touch[count + i];
}

static bool run_before(void *context, uint32_t a, uint32_t b) {
    const pir_outline *o = context;
    return o->run[a].line < o->run[b].line;
}

/* Cuts the runs order[0 .. count), which are on one line; the parts go to `side`. *touch is the first touch of the line
 * or of one after it, and becomes that of the next line. */
static void cut_line(pir_outline *o, const uint32_t *order, uint32_t count, uint32_t *touch) {
    o->place_count = 0;
    for (; *touch < o->touch_count && o->touch[*touch].line <= o->run[order[0]].line; ++*touch)
        push_place(o, o->touch[*touch].point);
    for (uint32_t i = 0; i < count; i++) {
        push_place(o, o->run[order[i]].a);
        push_place(o, o->run[order[i]].b);
    }
    if (!sort_places(o, o->run[order[0]].line))
        return;
    for (uint32_t i = 0; i < count; i++) {
        pir_run run = o->run[order[i]];
        uint32_t at = 0;
        while (o->place[at] != run.a)
            at++;
        for (const uint32_t end = run.b; run.a != end && o->space->status == PIR_OK; run.a = run.b) {
            run.b = o->place[++at];
            push_side(o, run);
        }
    }
}

static bool part_before(void *context, uint32_t a, uint32_t b) {
    const pir_outline *o = context;
    return o->side[a].half < o->side[b].half;
}

void pir_outline_cut(pir_outline *outline) {
    pir_outline *o = outline;
    uint32_t touch = 0;
    o->side_count = 0;
    list_touches(o);
    sort_touches(o);
    if (!sort(o, o->run_count, run_before))
        return;
    for (uint32_t i = 0, end; i < o->run_count; i = end) {
        for (end = i + 1; end < o->run_count && !run_before(o, o->order[i], o->order[end]); end++)
            ;
        cut_line(o, o->order + i, end - i, &touch);
    }
    if (!sort(o, o->side_count, part_before))
        return;
    o->run_count = 0;
    for (uint32_t i = 0; i < o->side_count; i++)
        push_run(o, o->side[o->order[i]]);
}

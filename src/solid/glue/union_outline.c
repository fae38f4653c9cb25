/* SPDX-License-Identifier: MIT */
/*
 * See union_outline.h. Along each line of a plane, sides lead one way or the other; between neighbouring ends on
 * the line they add up to 1, 0 or −1, and where that is not 0 the union has its boundary. A boundary goes on
 * straight over ends at which the sum stays the same. What is left then as the end of a run is a vertex. Edges that
 * are no side of a polygon add up along lines likewise.
 */
#include "solid/glue/union_outline.h"

#include "base/sort.h"
#include "solid/space/exact.h"

void pir_union_outline_init(pir_union_outline *outline, pir_space *space) {
    *outline = (pir_union_outline){.space = space, .loose = PIR_SPACE_NONE};
    pir_places_init(&outline->points, space);
    pir_places_init(&outline->lines, space);
}

void pir_union_outline_finish(pir_union_outline *outline) {
    pir_space *space = outline->space;
    if (!space)
        return;
    pir_places_finish(&outline->points);
    pir_places_finish(&outline->lines);
    pir_space_shrink(space, outline->line_direction, outline->line_room, sizeof *outline->line_direction);
    pir_space_shrink(space, outline->line_plane, outline->line_plane_room, sizeof *outline->line_plane);
    pir_space_shrink(space, outline->line_of, outline->line_of_room, sizeof *outline->line_of);
    pir_space_shrink(space, outline->run, outline->run_room, sizeof *outline->run);
    pir_space_shrink(space, outline->side, outline->side_room, sizeof *outline->side);
    pir_space_shrink(space, outline->touch, outline->touch_room, sizeof *outline->touch);
    pir_space_shrink(space, outline->order, outline->order_room, sizeof *outline->order);
    pir_space_shrink(space, outline->work, outline->work_room, sizeof *outline->work);
    pir_space_shrink(space, outline->place, outline->place_room, sizeof *outline->place);
    pir_space_shrink(space, outline->rank, outline->rank_room, sizeof *outline->rank);
    pir_space_shrink(space, outline->chain, outline->chain_room, sizeof *outline->chain);
    *outline = (pir_union_outline){0};
}

void pir_union_outline_clear(pir_union_outline *outline) {
    pir_places_clear(&outline->points);
    pir_places_clear(&outline->lines);
    outline->run_count = outline->side_count = outline->touch_count = outline->chain_count = 0;
    outline->loose = PIR_SPACE_NONE;
}

/* --- lines --- */

uint32_t pir_union_outline_line(pir_union_outline *outline, uint32_t f, uint32_t g) {
    pir_union_outline *o = outline;
    pir_space *space = o->space;
    const uint32_t known = o->lines.count, line = pir_places_line(&o->lines, f, g);
    if (!pir_space_grow(space, (void **)&o->line_direction, &o->line_room, line, sizeof *o->line_direction) ||
        !pir_space_grow(space, (void **)&o->line_plane, &o->line_plane_room, line, sizeof *o->line_plane))
        return 0;
    if (line == known) {
        o->line_direction[line] = pir_space_add_line_direction(space, f, g);
        o->line_plane[line][0] = f;
        o->line_plane[line][1] = g;
    }
    return line;
}

/* The line where plane g cuts the plane of the group, f. */
static uint32_t line_of(pir_union_outline *o, uint32_t f, uint32_t g) {
    const uint32_t before = o->line_of_room;
    if (!pir_space_grow(o->space, (void **)&o->line_of, &o->line_of_room, g, sizeof *o->line_of))
        return 0;
    for (uint32_t k = before; k < o->line_of_room; k++)
        o->line_of[k] = PIR_SPACE_NONE;
    if (o->line_of[g] == PIR_SPACE_NONE)
        o->line_of[g] = pir_union_outline_line(o, f, g);
    return o->line_of[g];
}

void pir_union_outline_push(pir_union_outline *o, pir_run run) {
    if (pir_space_grow(o->space, (void **)&o->run, &o->run_room, o->run_count, sizeof *o->run))
        o->run[o->run_count++] = run;
}

void pir_union_outline_push_side(pir_union_outline *o, pir_run side) {
    if (pir_space_grow(o->space, (void **)&o->side, &o->side_room, o->side_count, sizeof *o->side))
        o->side[o->side_count++] = side;
}

bool pir_union_outline_order(pir_union_outline *o, uint32_t count, bool (*before)(void *, uint32_t, uint32_t),
                             void *context) {
    if (!pir_space_grow(o->space, (void **)&o->order, &o->order_room, count, sizeof *o->order) ||
        !pir_space_grow(o->space, (void **)&o->work, &o->work_room, count, sizeof *o->work))
        return false;
    for (uint32_t i = 0; i < count; i++)
        o->order[i] = i;
    pir_sort(o->order, count, o->work, before, context);
    return true;
}

bool pir_union_outline_sort(pir_union_outline *o, uint32_t count, bool (*before)(void *, uint32_t, uint32_t)) {
    return pir_union_outline_order(o, count, before, o);
}

/* --- the places of ends along a line --- */

struct outline_along {
    pir_space *space;
    uint32_t direction;
};

static bool place_before(void *context, uint32_t a, uint32_t b) {
    const struct outline_along *along = context;
    return a != b && pir_space_order(along->space, along->direction, a, b) > 0;
}

void pir_union_outline_push_place(pir_union_outline *o, uint32_t point) {
    if (pir_space_grow(o->space, (void **)&o->place, &o->place_room, o->place_count, sizeof *o->place))
        o->place[o->place_count++] = point;
}

/* Puts the collected ends in order along the line, each once. */
bool pir_union_outline_sort_places(pir_union_outline *o, uint32_t line) {
    if (!pir_space_grow(o->space, (void **)&o->work, &o->work_room, o->place_count, sizeof *o->work))
        return false;
    struct outline_along along = {o->space, o->line_direction[line]};
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
    const pir_union_outline *o = context;
    return o->side[a].line < o->side[b].line;
}

/* The sign of what the sides order[0 .. count), which are on one line, add up to between two neighbouring ends. */
static int sum_between(const pir_union_outline *o, const uint32_t *order, uint32_t count, const uint32_t *rank,
                       uint32_t at) {
    int sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        const pir_run *side = &o->side[order[i]];
        sum += rank[side->a] <= at && at < rank[side->b] ? side->sign : 0;
    }
    return (sum > 0) - (sum < 0);
}

static void push_link(pir_union_outline *o, uint32_t number) {
    if (pir_space_grow(o->space, (void **)&o->chain, &o->chain_room, o->chain_count, sizeof *o->chain))
        o->chain[o->chain_count++] = number;
}

/* Notes the places of a line. */
static void keep_chain(pir_union_outline *o, uint32_t line) {
    if (!o->keeps_chains || o->place_count < 3)
        return;
    push_link(o, o->line_plane[line][1]);
    push_link(o, o->place_count);
    for (uint32_t i = 0; i < o->place_count; i++)
        push_link(o, o->place[i]);
}

/* The runs of one line, from its sides. */
static void add_line(pir_union_outline *o, const uint32_t *order, uint32_t count) {
    uint32_t *rank = o->rank;
    const pir_run first = o->side[order[0]];
    o->place_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        pir_union_outline_push_place(o, o->side[order[i]].a);
        pir_union_outline_push_place(o, o->side[order[i]].b);
    }
    if (!pir_union_outline_sort_places(o, first.line))
        return;
    keep_chain(o, first.line);
    for (uint32_t i = 0; i < o->place_count; i++)
        rank[o->place[i]] = i;
    int sum = 0;
    uint32_t from = 0;
    for (uint32_t i = 0; i < o->place_count; i++) {
        const int next = i + 1 < o->place_count ? sum_between(o, order, count, rank, i) : 0;
        if (next == sum)
            continue;
        if (sum != 0)
            pir_union_outline_push(
                o, (pir_run){first.group, first.half, first.line, o->place[from], o->place[i], sum > 0 ? 1 : -1});
        sum = next;
        from = i;
    }
}

/* A side from p to q as a run. */
static void add_side(pir_union_outline *o, pir_run side, uint32_t p, uint32_t q) {
    const uint32_t a = pir_places_point(&o->points, p), b = pir_places_point(&o->points, q);
    if (o->space->status != PIR_OK)
        return;
    const bool along = pir_space_order(o->space, o->line_direction[side.line], a, b) > 0;
    side.a = along ? a : b;
    side.b = along ? b : a;
    side.sign = along ? 1 : -1;
    pir_union_outline_push_side(o, side);
}

/* The runs of all sides, line by line. */
static void add_lines(pir_union_outline *o) {
    if (!pir_space_grow(o->space, (void **)&o->rank, &o->rank_room, o->space->point_count, sizeof *o->rank) ||
        !pir_union_outline_sort(o, o->side_count, side_before))
        return;
    for (uint32_t i = 0, end; i < o->side_count && o->space->status == PIR_OK; i = end) {
        for (end = i + 1; end < o->side_count && !side_before(o, o->order[i], o->order[end]); end++)
            ;
        add_line(o, o->order + i, end - i);
    }
}

void pir_union_outline_add(pir_union_outline *outline, uint32_t group, uint32_t half, const pir_segment *edge,
                           uint32_t count) {
    pir_union_outline *o = outline;
    o->side_count = 0;
    for (uint32_t i = 0; i < count && o->space->status == PIR_OK; i++) {
        const uint32_t line = line_of(o, half >> 1, edge[i].plane[1]);
        add_side(o, (pir_run){.group = group, .half = half, .line = line}, edge[i].a, edge[i].b);
    }
    for (uint32_t i = 0; i < count; i++)
        if (edge[i].plane[1] < o->line_of_room)
            o->line_of[edge[i].plane[1]] = PIR_SPACE_NONE;
    add_lines(o);
}

void pir_union_outline_add_segments(pir_union_outline *outline, uint32_t group, const pir_segment *segment,
                                    uint32_t count) {
    pir_union_outline *o = outline;
    o->side_count = 0;
    for (uint32_t i = 0; i < count && o->space->status == PIR_OK; i++) {
        const pir_segment *s = &segment[i];
        const uint32_t line = pir_union_outline_line(o, s->plane[0], s->plane[1]);
        add_side(o, (pir_run){.group = group, .half = pir_half(s->plane[0], false), .line = line}, s->a, s->b);
    }
    // the union has no way to go: all sides lead along their lines
    for (uint32_t i = 0; i < o->side_count; i++)
        o->side[i].sign = 1;
    add_lines(o);
}

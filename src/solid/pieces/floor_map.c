/* SPDX-License-Identifier: MIT */
/* See floor_map.h. A line is drawn from corner to corner: in a face whose inside it leads through it divides the face,
 * along a side it closes that. */
#include "solid/pieces/floor_map.h"

#include "solid/space/polygons.h"

int pir_facet_rise(const pir_shell_body *body, uint32_t facet) {
    const pir_space *space = body->space;
    const pir_space_plane *plane = &space->plane[body->plane[facet]];
    return mpz_sgn(space->number[space->direction[plane->direction[0]].exact + 2]) * (plane->turned ? -1 : 1);
}

static uint32_t target_of(const pir_floor_map *map, uint32_t side) {
    return map->side[map->side[side].next].origin;
}

static int side_of(const pir_floor_map *map, uint32_t wall, uint32_t point) {
    return pir_space_side(map->space, wall, point);
}

uint32_t pir_floor_wall(pir_floor_map *map, uint32_t a, uint32_t b) {
    const uint32_t direction[2] = {pir_polygons_direction(map->space, a, b), map->up};
    return pir_half(pir_space_add_plane(map->space, direction, false, (const uint32_t[]){a, PIR_SPACE_NONE}), false);
}

/* --- the floors of a body --- */

static uint32_t add_side(pir_floor_map *map, pir_floor_side side) {
    if (!pir_space_grow(map->space, (void **)&map->side, &map->side_room, map->side_count, sizeof *map->side))
        return 0;
    map->side[map->side_count] = side;
    return map->side_count++;
}

static uint32_t add_face(pir_floor_map *map, pir_floor_face face) {
    if (!pir_space_grow(map->space, (void **)&map->face, &map->face_room, map->face_count, sizeof *map->face))
        return 0;
    map->face[map->face_count] = face;
    return map->face_count++;
}

/* Whether the loop of halfedges has an area. */
static bool has_area(const pir_shell_body *body, uint32_t half) {
    uint32_t h = half;
    do {
        const uint32_t after = body->next[h];
        if (pir_space_turn(body->space, pir_shell_body_half(body, body->facet[h]), body->origin[half], body->origin[h],
                           body->origin[after]) != 0)
            return true;
        h = after;
    } while (h != half);
    return false;
}

/* The face of a loop of halfedges, which is clockwise from above, with sides of no length left out. */
static void add_loop(pir_floor_map *map, const pir_shell_body *body, uint32_t half, uint32_t *side_at) {
    const uint32_t number = map->face_count, first = map->side_count;
    add_face(map, (pir_floor_face){pir_shell_body_half(body, body->facet[half]), first, number, PIR_SPACE_NONE});
    uint32_t h = half;
    do {
        const uint32_t from = body->origin[body->next[h]], to = body->origin[h], before = body->prev[h];
        if (from != to) {
            side_at[h] = map->side_count;
            const uint32_t at = map->side_count;
            add_side(map, (pir_floor_side){from, pir_floor_wall(map, from, to), at + 1, at - 1, PIR_SPACE_NONE, number,
                                           true});
        }
        h = before;
    } while (h != half && map->space->status == PIR_OK);
    if (map->space->status != PIR_OK)
        return;
    map->side[map->side_count - 1].next = first;
    map->side[first].prev = map->side_count - 1;
}

static void join_sides(pir_floor_map *map, const pir_shell_body *body, const uint32_t *side_at) {
    for (uint32_t h = 0; h < body->half_count; h++) {
        const uint32_t own = side_at[h], other = own == PIR_SPACE_NONE ? own : side_at[body->twin[h]];
        if (other == PIR_SPACE_NONE || body->twin[h] < h)
            continue;
        map->side[own].twin = other;
        map->side[other].twin = own;
        map->side[other].wall = map->side[own].wall ^ 1;
        map->side[own].closed = map->side[other].closed = false;
    }
    for (uint32_t e = 0; e < body->edge_count; e++) {
        const uint32_t own = side_at[body->edge[e].half];
        if (body->edge[e].bend != PIR_BEND_REFLEX || own == PIR_SPACE_NONE)
            continue;
        map->side[own].closed = true;
        if (map->side[own].twin != PIR_SPACE_NONE)
            map->side[map->side[own].twin].closed = true;
    }
}

void pir_floor_map_init(pir_floor_map *map, const pir_shell_body *body) {
    pir_space *space = body->space;
    *map = (pir_floor_map){.space = space};
    mpz_t one, zero;
    mpz_init_set_ui(one, 1);
    mpz_init(zero);
    map->up = pir_space_add_direction(space, zero, zero, one);
    mpz_clears(one, zero, NULL);
    uint32_t *side_at = NULL, room = 0;
    bool *seen = NULL;
    uint32_t seen_room = 0;
    if (pir_space_grow(space, (void **)&side_at, &room, body->half_count, sizeof *side_at) &&
        pir_space_grow(space, (void **)&seen, &seen_room, body->half_count, sizeof *seen)) {
        for (uint32_t h = 0; h < body->half_count; h++)
            side_at[h] = PIR_SPACE_NONE, seen[h] = body->next[h] == PIR_SPACE_NONE;
        for (uint32_t h = 0; h < body->half_count && space->status == PIR_OK; h++) {
            if (seen[h])
                continue;
            for (uint32_t k = h; !seen[k]; k = body->next[k])
                seen[k] = true;
            if (pir_facet_rise(body, body->facet[h]) < 0 && has_area(body, h))
                add_loop(map, body, h, side_at);
        }
        if (space->status == PIR_OK)
            join_sides(map, body, side_at);
    }
    pir_space_shrink(space, side_at, room, sizeof *side_at);
    pir_space_shrink(space, seen, seen_room, sizeof *seen);
}

void pir_floor_map_finish(pir_floor_map *map) {
    pir_space_shrink(map->space, map->side, map->side_room, sizeof *map->side);
    pir_space_shrink(map->space, map->face, map->face_room, sizeof *map->face);
    *map = (pir_floor_map){0};
}

/* --- divisions --- */

static void close_side(pir_floor_map *map, uint32_t side) {
    map->closings += !map->side[side].closed;
    map->side[side].closed = true;
    if (map->side[side].twin != PIR_SPACE_NONE)
        map->side[map->side[side].twin].closed = true;
}

/* A side from the new point to the target of `side`, which ends there. */
static uint32_t part_side(pir_floor_map *map, uint32_t side, uint32_t point) {
    pir_floor_side rest = map->side[side];
    rest.origin = point;
    rest.prev = side;
    const uint32_t made = add_side(map, rest);
    if (map->space->status != PIR_OK)
        return side;
    map->side[map->side[made].next].prev = made;
    map->side[side].next = made;
    return made;
}

/* Divides a side, and its twin, where a vertical plane meets it; the side that begins there. */
static uint32_t split_side(pir_floor_map *map, uint32_t side, uint32_t plane) {
    const uint32_t floor = map->face[map->side[side].face].half >> 1, twin = map->side[side].twin;
    const uint32_t point = pir_space_add_meet(map->space, floor, map->side[side].wall >> 1, plane);
    const uint32_t made = part_side(map, side, point);
    if (twin == PIR_SPACE_NONE || map->space->status != PIR_OK)
        return made;
    const uint32_t other = part_side(map, twin, point);
    if (map->space->status != PIR_OK)
        return made;
    map->side[side].twin = other;
    map->side[other].twin = side;
    map->side[made].twin = twin;
    map->side[twin].twin = made;
    return made;
}

/* The side of a wall on which a face lies whose sides from `side` to before `end` have corners off it. */
static int side_of_run(const pir_floor_map *map, uint32_t wall, uint32_t side, uint32_t end) {
    int sign = 0;
    do {
        sign = side_of(map, wall, map->side[side].origin);
        side = map->side[side].next;
    } while (sign == 0 && side != end);
    return sign;
}

/* Joins the origins of two sides of a face by a side from a's to b's with its twin; that side. */
static uint32_t join_corners(pir_floor_map *map, uint32_t a, uint32_t b, uint32_t wall, bool closed) {
    const uint32_t face = map->side[a].face, before[2] = {map->side[a].prev, map->side[b].prev};
    const uint32_t to_b = add_side(map, (pir_floor_side){map->side[a].origin, wall, b, before[0], 0, face, closed});
    const uint32_t to_a = add_side(map, (pir_floor_side){map->side[b].origin, wall ^ 1, a, before[1], to_b, 0, closed});
    pir_floor_face part = map->face[face];
    const uint32_t made = add_face(map, part);
    if (map->space->status != PIR_OK)
        return a;
    map->face[made].side = to_a;
    map->face[made].link = map->face[part.part].link;
    map->face[part.part].link = made;
    map->face[face].side = to_b;
    map->side[to_b].twin = to_a;
    map->side[a].prev = to_a;
    map->side[before[1]].next = to_a;
    map->side[b].prev = to_b;
    map->side[before[0]].next = to_b;
    uint32_t s = to_a;
    do {
        map->side[s].face = made;
        s = map->side[s].next;
    } while (s != to_a);
    return to_b;
}

/* Divides a face with corners on both sides of a wall; the side along it, its face on the left. */
static uint32_t cut_face(pir_floor_map *map, uint32_t face, uint32_t wall, bool closed) {
    uint32_t at[2] = {0}, count = 0, s = map->face[face].side;
    const uint32_t first = s;
    do {
        const uint32_t next = map->side[s].next;
        const int from = side_of(map, wall, map->side[s].origin), to = side_of(map, wall, map->side[next].origin);
        if (from == 0 && count < 2)
            at[count++] = s;
        else if (from * to < 0 && count < 2)
            at[count++] = split_side(map, s, wall >> 1);
        s = next;
    } while (s != first && map->space->status == PIR_OK);
    if (count != 2)
        pir_space_fault(map->space);
    if (map->space->status != PIR_OK)
        return first;
    // from at[0] on to at[1] the face is on one side: the new side from at[1] to at[0] has it on its left
    const int sign = side_of_run(map, wall, at[0], at[1]);
    return sign < 0 ? join_corners(map, at[1], at[0], wall, closed) : join_corners(map, at[0], at[1], wall, closed);
}

/* --- lines --- */

/* From the corner at the origin of `side`, on the line of a wall, along it in this face: the side that begins at the
 * next corner there, or none. */
static uint32_t step_in(pir_floor_map *map, uint32_t side, uint32_t wall, bool again) {
    const uint32_t before = map->side[side].prev, face = map->side[side].face;
    const int right = side_of(map, wall, target_of(map, side)), left = side_of(map, wall, map->side[before].origin);
    if (right > 0 && left < 0) {
        const uint32_t made = cut_face(map, face, wall, true);
        return map->side[made].next;
    }
    if (right != 0 && left != 0)
        return PIR_SPACE_NONE;
    const int sign = side_of_run(map, wall, map->side[side].next, side);
    const uint32_t along = right == 0 && sign < 0 ? side : left == 0 && sign > 0 ? before : PIR_SPACE_NONE;
    if (along == PIR_SPACE_NONE || (map->side[along].closed && !again))
        return PIR_SPACE_NONE;
    close_side(map, along);
    return along == side ? map->side[side].next : before;
}

/* The side after `side` round its origin, one way or the other, or none. */
static uint32_t turn(const pir_floor_map *map, uint32_t side, bool left) {
    if (left)
        return map->side[map->side[side].prev].twin;
    const uint32_t twin = map->side[side].twin;
    return twin == PIR_SPACE_NONE ? twin : map->side[twin].next;
}

static bool is_closed_between(const pir_floor_map *map, uint32_t side, bool left) {
    return map->side[left ? map->side[side].prev : side].closed;
}

/* Steps from the origin of `start` along a wall: in faces of a part, or where that is none, in those that open sides
 * join with that of `start`. */
static uint32_t step(pir_floor_map *map, uint32_t start, uint32_t wall, uint32_t part) {
    for (int way = 0; way < 2; way++)
        for (uint32_t s = start, n = 0; s != PIR_SPACE_NONE && n < map->side_count; n++) {
            if (part == PIR_SPACE_NONE || map->face[map->side[s].face].part == part) {
                const uint32_t made = step_in(map, s, wall, part != PIR_SPACE_NONE);
                if (made != PIR_SPACE_NONE || map->space->status != PIR_OK)
                    return made;
            }
            if (part == PIR_SPACE_NONE && is_closed_between(map, s, way == 0))
                break;
            s = turn(map, s, way == 0);
            if (s == start)
                return PIR_SPACE_NONE;
        }
    return PIR_SPACE_NONE;
}

/* The face of a part that holds a point of its floor. */
static uint32_t face_at(const pir_floor_map *map, uint32_t part, uint32_t point) {
    for (uint32_t f = part; f != PIR_SPACE_NONE; f = map->face[f].link) {
        uint32_t s = map->face[f].side;
        bool holds = true;
        do {
            holds = side_of(map, map->side[s].wall, point) <= 0;
            s = map->side[s].next;
        } while (holds && s != map->face[f].side);
        if (holds)
            return f;
    }
    pir_space_fault(map->space);
    return part;
}

/* Whether the line of a wall and a vertical plane meet at the origin of a side, 2, or within the side, 1: the point of
 * the floor that both hold is on the side's line. */
static int meets_side(const pir_floor_map *map, uint32_t side, uint32_t wall, uint32_t plane) {
    const uint32_t across[2] = {wall, pir_half(plane, false)}, ends[2] = {map->side[side].origin, target_of(map, side)};
    const int from[2] = {side_of(map, across[0], ends[0]), side_of(map, across[1], ends[0])};
    const int to[2] = {side_of(map, across[0], ends[1]), side_of(map, across[1], ends[1])};
    if (from[0] == 0 && from[1] == 0)
        return 2;
    // along the wall it is the plane that parts the ends
    const int k = from[0] == 0 && to[0] == 0;
    return from[k] * to[k] < 0;
}

/* The side that begins where the line of a wall and a vertical plane meet in a part, which is made a corner. */
static uint32_t corner_at(pir_floor_map *map, uint32_t part, uint32_t wall, uint32_t plane) {
    const uint32_t point = pir_space_add_meet(map->space, map->face[part].half >> 1, wall >> 1, plane);
    const uint32_t face = face_at(map, part, point), first = map->face[face].side;
    uint32_t s = first, on = PIR_SPACE_NONE;
    do {
        if (side_of(map, map->side[s].wall, point) == 0) {
            const int meets = meets_side(map, s, wall, plane);
            if (meets == 2)
                return s;
            on = meets == 1 ? s : on;
        }
        s = map->side[s].next;
    } while (s != first && map->space->status == PIR_OK);
    if (on == PIR_SPACE_NONE)
        on = cut_face(map, face, pir_half(plane, false), false);
    if (map->space->status != PIR_OK)
        return first;
    const bool along = side_of(map, wall, map->side[on].origin) == 0;
    return split_side(map, on, along ? plane : wall >> 1);
}

void pir_floor_map_draw(pir_floor_map *map, uint32_t part, uint32_t wall, const uint32_t ends[2]) {
    const uint32_t end = corner_at(map, part, wall, ends[1]), last = map->side[end].origin;
    uint32_t at = corner_at(map, part, wall, ends[0]);
    for (uint32_t n = 0; map->space->status == PIR_OK && map->side[at].origin != last; n++) {
        at = step(map, at, wall, part);
        if (at == PIR_SPACE_NONE || n > map->side_count) {
            pir_space_fault(map->space);
            return;
        }
    }
}

/* Whether a side round the origin of `start` is closed, other than those to the point `from`. */
static bool meets_closed(const pir_floor_map *map, uint32_t start, uint32_t from) {
    uint32_t s = start;
    for (uint32_t n = 0; n < map->side_count; n++) {
        if (map->side[s].closed && target_of(map, s) != from)
            return true;
        s = turn(map, s, true);
        if (s == start)
            return false;
        if (s == PIR_SPACE_NONE)
            return true;
    }
    return true;
}

void pir_floor_map_extend(pir_floor_map *map, uint32_t side) {
    if (!map->side[side].closed)
        return;
    const uint32_t wall = map->side[side].wall ^ 1;
    uint32_t from = map->side[side].origin, at = step(map, side, wall, PIR_SPACE_NONE);
    while (at != PIR_SPACE_NONE && map->space->status == PIR_OK && !meets_closed(map, at, from)) {
        from = map->side[at].origin;
        at = step(map, at, wall, PIR_SPACE_NONE);
    }
}

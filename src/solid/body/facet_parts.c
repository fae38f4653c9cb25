/* SPDX-License-Identifier: MIT */
/*
 * A facet that is not convex loses one ear after the other (Meisters 1975), in its halfedges: a diagonal becomes two
 * twins. Loops may touch themselves at corners and along slits: then several corners are at one place, and each has its
 * own wedge of the facet there. Whatever the order of the cuts, the triangles, all counter-clockwise, add up to the
 * facet that the loop goes round, or the loop is refused. Then each diagonal and each flat edge between facets goes,
 * when both its ends stay convex without it (Hertel and Mehlhorn 1983). O(n²) for a facet of n corners, O(n) for the
 * joins.
 */
#include "solid/body/facet_parts.h"

#include "solid/space/polygons.h"

static int turn_at(pir_shell_body *body, uint32_t half) {
    const uint32_t *origin = body->origin;
    return pir_space_turn(body->space, pir_shell_body_half(body, body->facet[half]), origin[body->prev[half]],
                          origin[half], origin[body->next[half]]);
}

/* Whether the loop that begins at `half` is convex and goes round once: seen from its first corner no side is
 * turned back. */
static bool is_convex(pir_shell_body *body, uint32_t half) {
    const uint32_t plane = pir_shell_body_half(body, body->facet[half]), apex = body->origin[half];
    uint32_t h = half;
    do {
        const uint32_t after = body->next[h];
        if (turn_at(body, h) < 0 || pir_space_turn(body->space, plane, apex, body->origin[h], body->origin[after]) < 0)
            return false;
        h = after;
    } while (h != half);
    return true;
}

/* Whether a point is strictly left of both lines from p over q to r. */
static bool is_between(pir_shell_body *body, uint32_t plane, const uint32_t pqr[3], uint32_t x) {
    return pir_space_turn(body->space, plane, pqr[0], pqr[1], x) > 0 &&
           pir_space_turn(body->space, plane, pqr[1], pqr[2], x) > 0;
}

/* Whether the loop's corner at `half` is in the way of a cut from the last to the first of three other corners, which
 * are those of a triangle. Where it is at the same place as one of them, its sides must not lead into the triangle. */
static bool is_in_the_way(pir_shell_body *body, uint32_t plane, const uint32_t abc[3], uint32_t half) {
    const uint32_t x = body->origin[half];
    for (int k = 0; k < 3; k++) {
        const uint32_t round[3] = {abc[(k + 2) % 3], abc[k], abc[(k + 1) % 3]};
        if (x == abc[k])
            return is_between(body, plane, round, body->origin[body->prev[half]]) ||
                   is_between(body, plane, round, body->origin[body->next[half]]);
    }
    for (int k = 0; k < 3; k++)
        if (pir_space_turn(body->space, plane, abc[k], abc[(k + 1) % 3], x) < 0)
            return false;
    return true;
}

/* Whether the corner at `half` can go: no other corner of the loop is in the triangle that it makes. A straight
 * corner can, and one that leads back, the end of a slit. Where corners are in the triangle, the one that is farthest
 * from the cut is not convex: so those that are, as `convex` says of each halfedge, are passed over. */
static bool is_ear(pir_shell_body *body, uint32_t half, const bool *convex) {
    const uint32_t plane = pir_shell_body_half(body, body->facet[half]), *origin = body->origin;
    const uint32_t abc[3] = {origin[body->prev[half]], origin[half], origin[body->next[half]]};
    const int turn = pir_space_turn(body->space, plane, abc[0], abc[1], abc[2]);
    if (turn <= 0)
        return turn == 0;
    for (uint32_t h = body->next[body->next[half]]; h != body->prev[half]; h = body->next[h])
        if (!convex[h] && is_in_the_way(body, plane, abc, h))
            return false;
    return true;
}

/* Cuts off the corner at `half`; the halfedge of the loop that is left, in its place. */
static uint32_t cut_ear(pir_shell_body *body, uint32_t half) {
    const uint32_t before = body->prev[half], after = body->next[half], ear = body->half_count, rest = ear + 1;
    body->half_count += 2;
    body->facet[ear] = body->facet[rest] = body->facet[half];
    body->twin[ear] = rest;
    body->twin[rest] = ear;
    body->origin[ear] = body->origin[after];
    body->origin[rest] = body->origin[before];
    body->next[rest] = after;
    body->prev[rest] = body->prev[before];
    body->next[body->prev[before]] = rest;
    body->prev[after] = rest;
    body->next[half] = ear;
    body->prev[ear] = half;
    body->next[ear] = before;
    body->prev[before] = ear;
    return rest;
}

/* `convex` has room for all halfedges. */
static bool cut_facet(pir_shell_body *body, uint32_t facet, bool *convex) {
    uint32_t half = body->source.start[facet], left = body->source.start[facet + 1] - half;
    if (is_convex(body, half))
        return true;
    for (uint32_t i = 0; i < left; i++)
        convex[half + i] = turn_at(body, half + i) > 0;
    for (uint32_t passed = 0; left > 3;) {
        if (is_ear(body, half, convex)) {
            const uint32_t rest = cut_ear(body, half);
            half = body->prev[rest];
            convex[rest] = turn_at(body, rest) > 0;
            convex[body->next[rest]] = turn_at(body, body->next[rest]) > 0;
            left--;
            passed = 0;
        } else {
            half = body->next[half];
            if (++passed > left)
                return false;
        }
        if (body->space->status != PIR_OK)
            return true;
    }
    return turn_at(body, half) >= 0;
}

/* Whether the corner that is left at the origin of `half`, when it goes with its twin, is convex. */
static bool may_lose(pir_shell_body *body, uint32_t half, uint32_t plane) {
    const uint32_t from = body->origin[body->prev[half]], over = body->next[body->twin[half]];
    const uint32_t to = body->origin[body->next[over]];
    return from != to && pir_space_turn(body->space, plane, from, body->origin[half], to) >= 0;
}

/* Whether both sides of a slit are in one loop. */
static bool is_own_neighbour(const pir_shell_body *body, uint32_t half) {
    const uint32_t twin = body->twin[half];
    bool is = false;
    if (half < body->source.start[body->source.facet_count] && body->facet[half] == body->facet[twin])
        for (uint32_t h = body->next[half]; h != half && !is; h = body->next[h])
            is = h == twin;
    return is;
}

/* Joins the parts on both sides of `half` if that leaves a convex one. */
static void join(pir_shell_body *body, uint32_t half) {
    const uint32_t twin = body->twin[half], plane = pir_shell_body_half(body, body->facet[half]);
    if (is_own_neighbour(body, half) || body->group[body->facet[half]] != body->group[body->facet[twin]] ||
        !may_lose(body, half, plane) || !may_lose(body, twin, plane))
        return;
    const uint32_t ends[2][2] = {{body->prev[half], body->next[twin]}, {body->prev[twin], body->next[half]}};
    for (int k = 0; k < 2; k++) {
        body->next[ends[k][0]] = ends[k][1];
        body->prev[ends[k][1]] = ends[k][0];
    }
    body->next[half] = body->next[twin] = PIR_SPACE_NONE;
}

/* Keeps the loop that begins at `half` as a part, without its straight corners; marks its halfedges as seen. */
static void keep_part(pir_shell_body *body, uint32_t half, bool *seen) {
    const uint32_t first = body->corner_count;
    uint32_t h = half;
    do {
        seen[h] = true;
        if (turn_at(body, h) > 0)
            body->part_corner[body->corner_count++] = body->origin[h];
        h = body->next[h];
    } while (h != half);
    if (body->corner_count - first < 3) {
        body->corner_count = first;
        return;
    }
    body->part_facet[body->part_count++] = body->facet[half];
    body->part_start[body->part_count] = body->corner_count;
}

bool pir_shell_body_cut_parts(pir_shell_body *body, uint32_t *ret_facet) {
    bool *seen = PIR_ZEROED(&body->space->allocator, bool, body->half_room);
    if (!seen)
        body->space->status = PIR_ERR_MEMORY;
    bool cut = true;
    for (uint32_t f = 0; f < body->source.facet_count && seen && cut; f++) {
        cut = cut_facet(body, f, seen);
        *ret_facet = f;
    }
    for (uint32_t h = 0; h < body->half_room && seen; h++)
        seen[h] = false;
    if (!cut || !seen) {
        PIR_FREE(&body->space->allocator, seen, body->half_room);
        return cut;
    }
    for (uint32_t h = 0; h < body->half_count; h++)
        if (body->next[h] != PIR_SPACE_NONE && h < body->twin[h])
            join(body, h);
    body->part_start[0] = 0;
    for (uint32_t h = 0; h < body->half_count; h++)
        if (body->next[h] != PIR_SPACE_NONE && !seen[h])
            keep_part(body, h, seen);
    PIR_FREE(&body->space->allocator, seen, body->half_room);
    for (uint32_t p = 0; p < body->part_count; p++)
        for (uint32_t first = body->part_start[p], end = body->part_start[p + 1], i = first; i < end; i++)
            body->part_direction[i] = pir_polygons_direction(body->space, body->part_corner[i],
                                                             body->part_corner[i + 1 < end ? i + 1 : first]);
    return true;
}

/* SPDX-License-Identifier: MIT */
/*
 * Surfaces in D: see inner_surface.h.
 *
 * Errors. A corner less the centre is off by at most `error` in length and is at most `reach` long. A det is a
 * product of three of them, so it is off by 3 · error · reach² and by less than error · reach² from rounding,
 * error being at least 2^-46 reach. A normal is a product of two sides of at most 2 · reach, each off by 2 · error:
 * by 8 · error · reach, and by less than 2 · error · reach from rounding.
 */
#include <string.h>

#include "pair/surface/inner_surface.h"

/* How often a hole is widened for one vertex; most take none. */
#define MOST_WIDENED 9

bool pir_surface_place(const pir_surface *surface, const pir_frame *frame, pir_vec3 centre, double error, double reach,
                       pir_surface_room *room) {
    pir_surface_set_centre(centre, error, reach, room);
    room->loops->corners(surface, frame, room);
    return room->loops->planes(room, surface->corner[0], surface->count, &room->plane) == 0;
}

/* --- holes --- */

static void put(pir_surface *surface, uint32_t t, uint32_t i, uint32_t j, uint32_t k) {
    surface->corner[0][t] = (uint8_t)i;
    surface->corner[1][t] = (uint8_t)j;
    surface->corner[2][t] = (uint8_t)k;
}

void pir_surface_begin(pir_surface *surface, const uint32_t a[4], const uint32_t b[4]) {
    surface->lows.is_known = false;
    surface->used = 15;
    surface->count = 4;
    // loops take whole lanes, past the count too
    memset(surface->corner, 0, sizeof surface->corner);
    for (uint32_t i = 0; i < 4; i++) {
        surface->a[i] = a[i];
        surface->b[i] = b[i];
    }
    put(surface, 0, 0, 1, 2);
    put(surface, 1, 0, 2, 3);
    put(surface, 2, 0, 3, 1);
    put(surface, 3, 1, 3, 2);
}

/* The corners of a triangle. */
struct three {
    uint32_t a, b, c;
};

static inline struct three corners_of(const pir_surface *surface, uint32_t t) {
    return (struct three){surface->corner[0][t], surface->corner[1][t], surface->corner[2][t]};
}

/* Lists the sides of a triangle: bit j of side[i] for (i, j). */
static inline void list_side(struct three of, uint32_t side[PIR_SURFACE_CORNERS]) {
    side[of.a] |= 1u << of.b;
    side[of.b] |= 1u << of.c;
    side[of.c] |= 1u << of.a;
}

/* Bit j of side[i]: a triangle has the side (i, j). */
static void list_sides(const pir_surface *surface, uint32_t side[PIR_SURFACE_CORNERS]) {
    memset(side, 0, PIR_SURFACE_CORNERS * sizeof *side);
    for (uint32_t t = 0; t < surface->count; t++)
        list_side(corners_of(surface, t), side);
}

/* Notes that triangle t has these corners. */
static inline void note_sides(pir_surface_room *room, struct three of, uint32_t t) {
    room->triangle[of.a][of.b] = room->triangle[of.b][of.c] = room->triangle[of.c][of.a] = (uint8_t)t;
}

/* Notes all triangles, where that has not been done at this placement. */
static void need_sides(const pir_surface *surface, pir_surface_room *room) {
    if (room->has_sides)
        return;
    for (uint32_t t = 0; t < surface->count; t++)
        note_sides(room, corners_of(surface, t), t);
    room->has_sides = true;
}

/* The triangle beside the one that has the directed side (i, j). */
static inline uint32_t beside(const pir_surface_room *room, uint32_t i, uint32_t j) {
    return room->triangle[j][i];
}

/*
 * The rim of the hole that triangles leave, as the first two corners of a fan: the sides that they do not share.
 * Returns the corners that it passes twice. Nothing branches on what a side is, for nothing would foresee it.
 */
static uint32_t list_rim(const pir_surface *surface, const pir_surface_room *room, uint64_t gone,
                         pir_surface_fan *fan) {
    uint32_t count = 0, rim = 0, twice = 0, corners = 0;
    for (uint64_t rest = gone; rest; rest &= rest - 1) {
        uint32_t t = (uint32_t)__builtin_ctzll(rest);
        for (int k = 0; k < 3; k++) {
            uint32_t i = surface->corner[k][t], j = surface->corner[k < 2 ? k + 1 : 0][t];
            uint32_t out = (uint32_t)(~gone >> beside(room, i, j)) & 1, at = count % PIR_SURFACE_TRIANGLES;
            fan->corner[0][at] = (uint8_t)i;
            fan->corner[1][at] = (uint8_t)j;
            count += out;
            twice |= rim & out << i;
            rim |= out << i;
            corners |= 1u << i;
        }
    }
    fan->count = count;
    fan->rim = rim;
    fan->lost = corners & ~rim;
    return twice;
}

/* Whether these triangles and the rim around them are one disk, by Euler's formula. */
static bool is_disk(uint64_t gone, const pir_surface_fan *fan) {
    uint32_t twice = fan->count;
    for (uint32_t rest = fan->lost; rest; rest &= rest - 1)
        twice += 2;
    for (; gone; gone &= gone - 1)
        twice--;
    return twice == 2;
}

/* The ones of `part`, and of these triangles those that sides join to them. */
static uint64_t joined_to(const pir_surface *surface, const pir_surface_room *room, uint64_t part, uint64_t triangles) {
    for (uint64_t rest = part; rest;) {
        struct three of = corners_of(surface, (uint32_t)__builtin_ctzll(rest));
        uint64_t near =
            1ull << beside(room, of.a, of.b) | 1ull << beside(room, of.b, of.c) | 1ull << beside(room, of.c, of.a);
        rest &= rest - 1;
        near &= triangles & ~part;
        part |= near;
        rest |= near;
    }
    return part;
}

/* The triangles at any of these corners. */
static uint64_t about_all(const pir_surface *surface, const pir_surface_room *room, uint32_t corners) {
    uint64_t found = 0;
    for (; corners; corners &= corners - 1)
        found |= room->loops->about(surface, (uint32_t)__builtin_ctz(corners));
    return found;
}

/* The triangles across the sides of the rim at which a fan is not certain. */
static uint64_t across(const pir_surface_room *room, uint64_t uncertain) {
    const pir_surface_fan *fan = &room->fan;
    uint64_t found = 0;
    for (; uncertain; uncertain &= uncertain - 1) {
        uint32_t s = (uint32_t)__builtin_ctzll(uncertain);
        found |= 1ull << beside(room, fan->corner[0][s], fan->corner[1][s]);
    }
    return found;
}

/* Sets the fan from corner i, which is placed, to the rim that it has. Returns its triangles that are not certain. */
static uint64_t set_fan(pir_surface_room *room, uint32_t i) {
    pir_surface_fan *fan = &room->fan;
    memset(fan->corner[2], (int)i, fan->count);
    return room->loops->planes(room, fan->corner[0], fan->count, &fan->plane);
}

/*
 * Sets the fan from corner i in place of triangles. Where its rim passes a corner twice, all that is about that corner
 * goes too. Where a triangle of it is not certain, the one across its side of the rim goes, and those of `seen` that
 * are joined to it. False where nothing spans the hole in `most` times. *gone becomes the triangles that go.
 */
static bool span(const pir_surface *surface, pir_surface_room *room, uint32_t i, uint64_t seen, uint32_t most,
                 uint64_t *gone) {
    for (uint32_t times = 0; times < most; times++) {
        uint64_t more = about_all(surface, room, list_rim(surface, room, *gone, &room->fan));
        if (room->fan.count == 0)
            return false;
        if (more == 0) {
            uint64_t uncertain = set_fan(room, i);
            if (uncertain == 0)
                return true;
            more = across(room, uncertain);
        }
        *gone = joined_to(surface, room, *gone | more, seen);
    }
    return false;
}

/* --- changing --- */

/* Puts triangle `from` of a fan, or of the surface, in place of triangle t. */
static inline void put_plane(const pir_surface_planes *planes, uint32_t from, uint32_t t, pir_surface_room *room) {
    room->plane.nx[t] = planes->nx[from];
    room->plane.ny[t] = planes->ny[from];
    room->plane.nz[t] = planes->nz[from];
    room->plane.det[t] = planes->det[from];
    room->plane.low[t] = planes->low[from];
}

static inline void put_of_fan(pir_surface *surface, uint32_t from, uint32_t t, pir_surface_room *room) {
    const pir_surface_fan *fan = &room->fan;
    put(surface, t, fan->corner[0][from], fan->corner[1][from], fan->corner[2][from]);
    note_sides(room, corners_of(surface, t), t);
    put_plane(&fan->plane, from, t, room);
}

static inline void move_triangle(pir_surface *surface, uint32_t from, uint32_t t, pir_surface_room *room) {
    put(surface, t, surface->corner[0][from], surface->corner[1][from], surface->corner[2][from]);
    note_sides(room, corners_of(surface, t), t);
    put_plane(&room->plane, from, t, room);
}

/* Of corners that no triangle of a hole has any more, those that are not part of the surface elsewhere. */
static uint32_t really_lost(const pir_surface *surface, const pir_surface_room *room, uint32_t lost) {
    uint32_t gone = 0;
    for (uint32_t rest = lost; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest);
        gone |= (uint32_t)(room->loops->about(surface, i) == 0) << i;
    }
    return gone;
}

/*
 * Puts the fan in place of triangles: first where those were, then at the end. Where it has fewer, the last ones of the
 * surface move to the places that are left.
 */
static void put_fan(pir_surface *surface, uint64_t gone, pir_surface_room *room) {
    uint32_t from = 0, count = surface->count;
    for (; gone && from < room->fan.count; gone &= gone - 1)
        put_of_fan(surface, from++, (uint32_t)__builtin_ctzll(gone), room);
    while (from < room->fan.count)
        put_of_fan(surface, from++, count++, room);
    while (gone) {
        // the last of them first: what is after it stays
        uint32_t t = 63 - (uint32_t)__builtin_clzll(gone);
        gone &= ~(1ull << t);
        if (t != --count)
            move_triangle(surface, count, t, room);
    }
    surface->count = count;
    surface->used &= ~really_lost(surface, room, room->fan.lost);
    PIR_ASSERT(pir_surface_is_valid(surface));
}

/* Whether there is room for the fan in place of triangles. */
static bool fits(const pir_surface *surface, uint64_t gone, const pir_surface_fan *fan) {
    uint32_t count = surface->count + fan->count;
    for (; gone; gone &= gone - 1)
        count--;
    return count <= PIR_SURFACE_TRIANGLES;
}

/*
 * Sets the fan from corner i, which is placed, in place of what it sees about t. Returns what goes, 0 for nothing.
 * Where the centre has left the surface through t, the vertex may be too near for a certain fan, and others come. But
 * what is not one disk there seldom comes to anything.
 */
static uint64_t make_way(const pir_surface *surface, uint32_t t, uint64_t least, uint32_t i, pir_surface_room *room) {
    uint64_t seen = room->loops->seen(surface, room, pir_surface_corner(room, i)) | least, uncertain = 0;
    const bool left = !(room->plane.low[t] > 0);
    if (list_rim(surface, room, seen, &room->fan) == 0 && is_disk(seen, &room->fan)) {
        uncertain = set_fan(room, i);
        if (uncertain == 0 || left)
            return seen;
    }
    if (left)
        return 0;
    uint64_t gone = joined_to(surface, room, least, seen);
    uint32_t most = MOST_WIDENED;
    // what is seen is one hole whose fan is set already, which is the first time
    if (uncertain != 0 && gone == seen) {
        gone = joined_to(surface, room, gone | across(room, uncertain), seen);
        most--;
    }
    return span(surface, room, i, seen, most, &gone) ? gone : 0;
}

uint32_t pir_surface_add(pir_surface *surface, uint32_t t, const pir_surface_vertex *vertex, pir_surface_room *room) {
    uint32_t same = room->loops->either(surface->a, vertex->a, vertex->a) &
                    room->loops->either(surface->b, vertex->b, vertex->b) & surface->used;
    if (same == 0 && surface->used == UINT32_MAX)
        return PIR_SURFACE_CORNERS;
    uint32_t i = (uint32_t)__builtin_ctz(same != 0 ? same : ~surface->used);
    uint64_t least = 1ull << t | (same != 0 ? room->loops->about(surface, i) : 0);
    need_sides(surface, room);
    room->at[i][0] = vertex->at.x;
    room->at[i][1] = vertex->at.y;
    room->at[i][2] = vertex->at.z;
    uint64_t gone = make_way(surface, t, least, i, room);
    if (gone == 0 || !fits(surface, gone, &room->fan))
        return PIR_SURFACE_CORNERS;
    put_fan(surface, gone, room);
    surface->used |= 1u << i;
    surface->a[i] = vertex->a;
    surface->b[i] = vertex->b;
    return i;
}

/* --- turning sides --- */

/* The triangles on either side of a side: (i, j, near) and (j, i, far). */
struct beside {
    uint32_t of, other;
    uint32_t i, j, near, far;
};

/* The third corner of triangle t, which has these two. */
static inline uint32_t third_of(const pir_surface *surface, uint32_t t, uint32_t i, uint32_t j) {
    struct three of = corners_of(surface, t);
    return of.a ^ of.b ^ of.c ^ i ^ j;
}

/* Whether a triangle has the directed side (i, j). */
static bool has_side(const pir_surface *surface, const pir_surface_room *room, uint32_t i, uint32_t j) {
    uint32_t t = room->triangle[i][j];
    if (t >= surface->count)
        return false;
    struct three of = corners_of(surface, t);
    return (of.a == i && of.b == j) || (of.b == i && of.c == j) || (of.c == i && of.a == j);
}

/* Sets the fan from corner i to the sides between the corners of a path. Returns its triangles that are not certain. */
static uint64_t set_fan_to(pir_surface_room *room, uint32_t i, const uint32_t *path, uint32_t sides) {
    pir_surface_fan *fan = &room->fan;
    for (uint32_t s = 0; s < sides; s++) {
        fan->corner[0][s] = (uint8_t)path[s];
        fan->corner[1][s] = (uint8_t)path[s + 1];
    }
    fan->count = sides;
    return set_fan(room, i);
}

/*
 * Sets the fan in place of two triangles: the two on the other diagonal of what they span. Where that is not certain
 * because an end of the side that they share is within the triangle of the other corners, it is that triangle, and a
 * third one goes with the corner. Returns what goes, 0 where none of that is certain.
 */
static uint64_t set_turned(const pir_surface *surface, const struct beside *at, pir_surface_room *room) {
    const uint32_t path[3] = {at->j, at->near, at->i};
    uint64_t uncertain = set_fan_to(room, at->far, path, 2), gone = 1ull << at->of | 1ull << at->other;
    room->fan.lost = 0;
    if (uncertain == 0)
        return has_side(surface, room, at->near, at->far) ? 0 : gone;
    if (uncertain == 3 || surface->count == 4)
        return 0;
    uint32_t within = uncertain == 1 ? at->j : at->i;
    uint32_t third = within == at->j ? beside(room, within, at->near) : beside(room, at->near, within);
    if (third_of(surface, third, within, at->near) != at->far)
        return 0;
    set_fan_to(room, at->far, within == at->j ? &path[1] : path, 1);
    room->fan.lost = 1u << within;
    return gone | 1ull << third;
}

bool pir_surface_turn(pir_surface *surface, uint32_t t, pir_surface_room *room) {
    pir_vec3 n = pir_surface_normal(room, t);
    struct beside most = {.of = t};
    double along = room->plane.det[t] + room->det_error;
    bool found = false;
    need_sides(surface, room);
    for (int k = 0; k < 3; k++) {
        struct beside at = {.of = t, .i = surface->corner[k][t], .j = surface->corner[k < 2 ? k + 1 : 0][t]};
        at.near = surface->corner[k > 0 ? k - 1 : 2][t];
        at.other = beside(room, at.i, at.j);
        at.far = third_of(surface, at.other, at.i, at.j);
        double far = pir_vec_dot(n, pir_surface_corner(room, at.far));
        if (far > along)
            along = far, most = at, found = true;
    }
    uint64_t gone = found ? set_turned(surface, &most, room) : 0;
    if (gone == 0)
        return false;
    put_fan(surface, gone, room);
    return true;
}

/* --- taking corners away --- */

/* How far each corner is from the centre, by the least of its triangles. */
static void list_distances(const pir_surface *surface, const pir_surface_room *room,
                           double distance[PIR_SURFACE_CORNERS]) {
    for (uint32_t i = 0; i < PIR_SURFACE_CORNERS; i++)
        distance[i] = HUGE_VAL;
    for (uint32_t t = 0; t < surface->count; t++)
        for (int k = 0; k < 3; k++) {
            double *of = &distance[surface->corner[k][t]];
            *of = room->plane.low[t] < *of ? room->plane.low[t] : *of;
        }
}

/* The corners that are farther than the mean. */
static uint32_t far_corners(uint32_t corners, const double distance[PIR_SURFACE_CORNERS]) {
    double sum = 0;
    uint32_t count = 0, found = 0;
    for (uint32_t rest = corners; rest; rest &= rest - 1) {
        sum += distance[__builtin_ctz(rest)];
        count++;
    }
    for (uint32_t i = 0; i < PIR_SURFACE_CORNERS; i++)
        found |= (uint32_t)(distance[i] * count > sum) << i;
    return found & corners;
}

/*
 * Lists the corners about corner c in the order in which the rim of the hole without it passes them. Returns how many
 * there are; 0 where they are no single ring.
 */
static uint32_t list_around(const pir_surface *surface, const pir_surface_room *room, uint32_t c, uint64_t about,
                            uint8_t around[PIR_SURFACE_CORNERS]) {
    struct three of = corners_of(surface, (uint32_t)__builtin_ctzll(about));
    const uint32_t first = of.a == c ? of.b : of.b == c ? of.c : of.a;
    uint32_t i = first, count = 0;
    do {
        around[count++] = (uint8_t)i;
        uint32_t t = room->triangle[c][i];
        about &= ~(1ull << t);
        i = third_of(surface, t, c, i);
    } while (i != first && count < PIR_SURFACE_CORNERS);
    return about == 0 && i == first ? count : 0;
}

/*
 * Sets the fan from the corner at place v of a ring in place of what is about the corner within. False where it is not
 * certain, or has a side that triangles have which stay.
 */
static bool span_from(const pir_surface *surface, pir_surface_room *room, const uint8_t *ring, uint32_t count,
                      uint32_t v) {
    uint32_t path[PIR_SURFACE_CORNERS];
    for (uint32_t s = 1; s < count; s++)
        path[s - 1] = ring[v + s < count ? v + s : v + s - count];
    if (set_fan_to(room, ring[v], path, count - 2) != 0)
        return false;
    for (uint32_t s = 1; s + 2 < count; s++)
        if (has_side(surface, room, ring[v], path[s]))
            return false;
    return true;
}

/* Takes corner c away and closes the surface by triangles from a corner beside it. False where none spans the hole. */
static bool take_corner(pir_surface *surface, uint32_t c, pir_surface_room *room) {
    uint8_t ring[PIR_SURFACE_CORNERS];
    uint64_t gone = room->loops->about(surface, c);
    uint32_t v = 0, count = list_around(surface, room, c, gone, ring);
    if (count < 3 || surface->count == 4)
        return false;
    while (v < count && !span_from(surface, room, ring, count, v))
        v++;
    if (v == count)
        return false;
    room->fan.lost = 1u << c;
    put_fan(surface, gone, room);
    return true;
}

bool pir_surface_trim(pir_surface *surface, pir_surface_room *room) {
    double distance[PIR_SURFACE_CORNERS];
    uint32_t taken = 0;
    need_sides(surface, room);
    list_distances(surface, room, distance);
    for (uint32_t rest = far_corners(surface->used, distance); rest && taken < PIR_SURFACE_CORNERS / 4;
         rest &= rest - 1)
        taken += take_corner(surface, (uint32_t)__builtin_ctz(rest), room);
    return taken > 0;
}

bool pir_surface_is_valid(const pir_surface *surface) {
    uint32_t side[PIR_SURFACE_CORNERS], sides = 0;
    list_sides(surface, side);
    for (uint32_t i = 0; i < PIR_SURFACE_CORNERS; i++)
        sides += (uint32_t)__builtin_popcount(side[i]);
    for (uint32_t i = 0; i < PIR_SURFACE_CORNERS; i++)
        for (uint32_t j = 0; j < PIR_SURFACE_CORNERS; j++)
            if ((side[i] >> j & 1) != (side[j] >> i & 1))
                return false;
    return surface->count >= 4 && sides == 3 * surface->count;
}

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

#include "pair/surface/surface_loops.h"

/* --- planes --- */

/* The plane of triangle t, and a lower bound on its distance from the centre. */
static inline void make_plane(const pir_surface *surface, uint32_t t, pir_surface_room *room) {
    const double *a = room->at[surface->corner[0][t]], *b = room->at[surface->corner[1][t]];
    const double *c = room->at[surface->corner[2][t]];
    double ex = b[0] - a[0], ey = b[1] - a[1], ez = b[2] - a[2];
    double fx = c[0] - a[0], fy = c[1] - a[1], fz = c[2] - a[2];
    double nx = ey * fz - ez * fy, ny = ez * fx - ex * fz, nz = ex * fy - ey * fx;
    double det = nx * a[0] + ny * a[1] + nz * a[2];
    room->nx[t] = nx;
    room->ny[t] = ny;
    room->nz[t] = nz;
    room->det[t] = det;
    room->low[t] = (det - room->det_error) / (sqrt(nx * nx + ny * ny + nz * nz) + room->normal_error);
}

static bool make_planes(const pir_surface *surface, uint32_t from, pir_surface_room *room) {
    bool certain = true;
    for (uint32_t t = from; t < surface->count; t++) {
        make_plane(surface, t, room);
        certain &= room->low[t] > 0;
    }
    return certain;
}

static void place_corners(const pir_surface *surface, const pir_frame *frame, pir_surface_room *room) {
    for (uint32_t rest = surface->used; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest);
        pir_vec3 w = pir_vec_sub(pir_frame_vertex(frame, surface->a[i], surface->b[i]), room->centre);
        room->at[i][0] = w.x;
        room->at[i][1] = w.y;
        room->at[i][2] = w.z;
    }
}

static uint64_t find_below(const pir_surface *surface, const pir_surface_room *room, double limit) {
    uint64_t found = 0;
    for (uint32_t t = 0; t < surface->count; t++)
        found |= (uint64_t)(room->low[t] <= limit) << t;
    return found;
}

static double find_least(const pir_surface *surface, const pir_surface_room *room) {
    double least = HUGE_VAL;
    for (uint32_t t = 0; t < surface->count; t++)
        least = room->low[t] < least ? room->low[t] : least;
    return least;
}

static const pir_surface_loops plain = {"plain", place_corners, make_planes, find_below, find_least};

const pir_surface_loops *pir_surface_loops_version(unsigned index) {
    if (index == 0)
        return &plain;
#if PIR_HAVE_X86_SURFACE
    if (index == 1 && __builtin_cpu_supports("avx2"))
        return &pir_surface_avx2;
#endif
    return NULL;
}

const pir_surface_loops *pir_surface_loops_best(void) {
    unsigned index = 0;
    while (pir_surface_loops_version(index + 1))
        index++;
    return pir_surface_loops_version(index);
}

bool pir_surface_place(const pir_surface *surface, const pir_frame *frame, pir_vec3 centre, double error, double reach,
                       pir_surface_room *room) {
    room->centre = centre;
    room->det_error = 4 * error * reach * reach;
    room->normal_error = 10 * error * reach;
    room->has_sides = false;
    room->loops->corners(surface, frame, room);
    return room->loops->planes(surface, 0, room);
}

/* Notes which triangle has which directed side. */
static void note_sides(const pir_surface *surface, uint32_t t, pir_surface_room *room) {
    uint32_t i = surface->corner[0][t], j = surface->corner[1][t], k = surface->corner[2][t];
    room->beside[i][j] = room->beside[j][k] = room->beside[k][i] = (uint8_t)t;
}

static void note_all_sides(const pir_surface *surface, pir_surface_room *room) {
    for (uint32_t t = 0; t < surface->count && !room->has_sides; t++)
        note_sides(surface, t, room);
    room->has_sides = true;
}

/* --- making and changing --- */

static void put(pir_surface *surface, uint32_t t, uint32_t i, uint32_t j, uint32_t k) {
    surface->corner[0][t] = (uint8_t)i;
    surface->corner[1][t] = (uint8_t)j;
    surface->corner[2][t] = (uint8_t)k;
}

void pir_surface_begin(pir_surface *surface, const uint32_t a[4], const uint32_t b[4]) {
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

/* Whether the triangle (i, j, w) has a det that is certain to be positive. */
static bool is_certain(const pir_surface_room *room, uint32_t i, uint32_t j, pir_vec3 w) {
    return pir_vec_dot(pir_vec_cross(pir_surface_corner(room, i), pir_surface_corner(room, j)), w) > room->det_error;
}

/* Triangles that make way for a new corner, in the order in which their neighbours are looked at. */
struct cut {
    uint64_t gone;
    uint32_t count;
    uint8_t open[PIR_SURFACE_TRIANGLES];
};

static void cut_triangle(struct cut *cut, uint32_t t) {
    if (cut->gone >> t & 1)
        return;
    cut->gone |= 1ull << t;
    cut->open[cut->count++] = (uint8_t)t;
}

/*
 * The triangles that make way for w: `t`, those that have corner `same` already, and from there across their sides
 * those with which w makes no certain triangle, and where `wide` those that w is beyond.
 */
static uint64_t find_cut(const pir_surface *surface, const pir_surface_room *room, pir_vec3 w, uint32_t t,
                         uint32_t same, bool wide) {
    struct cut cut = {.gone = 0, .count = 0};
    cut_triangle(&cut, t);
    for (uint32_t each = 0; same < PIR_SURFACE_CORNERS && each < surface->count; each++)
        if (surface->corner[0][each] == same || surface->corner[1][each] == same || surface->corner[2][each] == same)
            cut_triangle(&cut, each);
    for (uint32_t k = 0; k < cut.count; k++)
        for (int side = 0; side < 3; side++) {
            uint32_t i = surface->corner[side][cut.open[k]], j = surface->corner[side < 2 ? side + 1 : 0][cut.open[k]];
            uint32_t next = room->beside[j][i];
            if (cut.gone >> next & 1)
                continue;
            bool sees = wide && pir_vec_dot(pir_surface_normal(room, next), w) > room->det[next];
            if (sees || !is_certain(room, i, j, w))
                cut_triangle(&cut, next);
        }
    return cut.gone;
}

/* The sides between what goes and what stays. */
struct rim {
    uint32_t count, corners; /* a bit for each corner on it */
    uint8_t from[PIR_SURFACE_TRIANGLES], to[PIR_SURFACE_TRIANGLES];
};

/* False where there are none, or they pass a corner twice. */
static bool list_rim(const pir_surface *surface, const pir_surface_room *room, uint64_t gone, struct rim *rim) {
    rim->count = rim->corners = 0;
    for (uint64_t rest = gone; rest; rest &= rest - 1) {
        uint32_t t = (uint32_t)__builtin_ctzll(rest);
        for (int side = 0; side < 3; side++) {
            uint32_t i = surface->corner[side][t], j = surface->corner[side < 2 ? side + 1 : 0][t];
            if (gone >> room->beside[j][i] & 1)
                continue;
            if (rim->corners >> i & 1)
                return false;
            rim->corners |= 1u << i;
            rim->from[rim->count] = (uint8_t)i;
            rim->to[rim->count++] = (uint8_t)j;
        }
    }
    return rim->count > 0;
}

/* The corner that is vertex (a, b) of D; PIR_SURFACE_CORNERS where there is none. */
static uint32_t find_corner(const pir_surface *surface, uint32_t a, uint32_t b) {
    for (uint32_t rest = surface->used; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest);
        if (surface->a[i] == a && surface->b[i] == b)
            return i;
    }
    return PIR_SURFACE_CORNERS;
}

/* The corners of a triangle: a bit for each. */
static uint32_t corners_of(const pir_surface *surface, uint32_t t) {
    return 1u << surface->corner[0][t] | 1u << surface->corner[1][t] | 1u << surface->corner[2][t];
}

/* Moves triangle `from` to a place that is free. */
static void move_triangle(pir_surface *surface, uint32_t from, uint32_t to, pir_surface_room *room) {
    put(surface, to, surface->corner[0][from], surface->corner[1][from], surface->corner[2][from]);
    note_sides(surface, to, room);
    room->nx[to] = room->nx[from];
    room->ny[to] = room->ny[from];
    room->nz[to] = room->nz[from];
    room->det[to] = room->det[from];
    room->low[to] = room->low[from];
}

/* Whether the surface is a sphere at which no two parts touch at a corner: it has the fewest triangles then. */
static bool is_simple(const pir_surface *surface) {
    uint32_t corners = 0;
    for (uint32_t rest = surface->used; rest; rest &= rest - 1)
        corners++;
    return surface->count + 4 == 2 * corners;
}

/*
 * Takes triangles away. The last of those that stay move to the places that become free. A corner that is not on the
 * rim of what goes is lost, unless some other part of the surface touches there.
 */
static void take_away(pir_surface *surface, uint64_t gone, uint32_t rim, pir_surface_room *room) {
    uint32_t kept = surface->count, lost = 0;
    bool simple = is_simple(surface);
    for (; gone; gone &= gone - 1) {
        uint32_t free = (uint32_t)__builtin_ctzll(gone);
        lost |= free < kept ? corners_of(surface, free) : 0;
        while (kept > free && gone >> (kept - 1) & 1)
            lost |= corners_of(surface, --kept);
        if (kept > free)
            move_triangle(surface, --kept, free, room);
    }
    surface->count = kept;
    lost &= ~rim;
    for (uint32_t t = 0; !simple && lost && t < kept; t++)
        lost &= ~corners_of(surface, t);
    surface->used &= ~lost;
}

/* Adds the triangles from corner i to all sides of the rim that are not its own. */
static void add_fan(pir_surface *surface, uint32_t i, const struct rim *rim, pir_surface_room *room) {
    uint32_t first = surface->count;
    for (uint32_t s = 0; s < rim->count; s++) {
        if (rim->from[s] == i || rim->to[s] == i)
            continue;
        put(surface, surface->count, rim->from[s], rim->to[s], i);
        note_sides(surface, surface->count++, room);
    }
    room->loops->planes(surface, first, room);
    PIR_ASSERT(pir_surface_is_valid(surface));
}

uint32_t pir_surface_add(pir_surface *surface, uint32_t t, const pir_surface_vertex *vertex, pir_surface_room *room) {
    struct rim rim;
    uint32_t i = find_corner(surface, vertex->a, vertex->b);
    note_all_sides(surface, room);
    uint64_t gone = find_cut(surface, room, vertex->at, t, i, true);
    if (!list_rim(surface, room, gone, &rim)) {
        gone = find_cut(surface, room, vertex->at, t, i, false);
        if (!list_rim(surface, room, gone, &rim))
            return PIR_SURFACE_CORNERS;
    }
    uint32_t stay = surface->count - (uint32_t)__builtin_popcountll(gone);
    if (stay + rim.count > PIR_SURFACE_TRIANGLES || (i == PIR_SURFACE_CORNERS && surface->used == UINT32_MAX))
        return PIR_SURFACE_CORNERS;
    i = i == PIR_SURFACE_CORNERS ? (uint32_t)__builtin_ctz(~surface->used) : i;
    take_away(surface, gone, rim.corners, room);
    surface->used |= 1u << i;
    surface->a[i] = vertex->a;
    surface->b[i] = vertex->b;
    room->at[i][0] = vertex->at.x;
    room->at[i][1] = vertex->at.y;
    room->at[i][2] = vertex->at.z;
    add_fan(surface, i, &rim, room);
    return i;
}

/* --- taking corners away --- */

/*
 * Whether some triangle has the side (i, j), of a surface whose sides are noted. Notes of triangles that are gone stay,
 * so the triangle is looked at.
 */
static bool has_side(const pir_surface *surface, const pir_surface_room *room, uint32_t i, uint32_t j) {
    uint32_t t = room->beside[i][j];
    if (t >= surface->count)
        return false;
    uint32_t a = surface->corner[0][t], b = surface->corner[1][t], c = surface->corner[2][t];
    return (a == i && b == j) || (b == i && c == j) || (c == i && a == j);
}

/* How far each corner is from the centre, by the least of its triangles. */
static void list_distances(const pir_surface *surface, const pir_surface_room *room,
                           double distance[PIR_SURFACE_CORNERS]) {
    for (uint32_t i = 0; i < PIR_SURFACE_CORNERS; i++)
        distance[i] = HUGE_VAL;
    for (uint32_t t = 0; t < surface->count; t++)
        for (int k = 0; k < 3; k++) {
            double *of = &distance[surface->corner[k][t]];
            *of = room->low[t] < *of ? room->low[t] : *of;
        }
}

/* The farthest of these corners; PIR_SURFACE_CORNERS where there are none. */
static uint32_t farthest_of(uint32_t corners, const double distance[PIR_SURFACE_CORNERS]) {
    uint32_t farthest = PIR_SURFACE_CORNERS;
    for (uint32_t rest = corners; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest);
        if (farthest == PIR_SURFACE_CORNERS || distance[i] > distance[farthest])
            farthest = i;
    }
    return farthest;
}

/* Whether triangles from corner v to all sides of the rim are certain, and have no side that others have. */
static bool spans(const pir_surface *surface, const pir_surface_room *room, const struct rim *rim, uint32_t v) {
    uint32_t beside = 0; // the neighbours of v on the rim
    for (uint32_t s = 0; s < rim->count; s++)
        beside |= (rim->from[s] == v ? 1u << rim->to[s] : 0) | (rim->to[s] == v ? 1u << rim->from[s] : 0);
    for (uint32_t s = 0; s < rim->count; s++) {
        uint32_t i = rim->from[s], j = rim->to[s];
        if (i == v || j == v)
            continue;
        if ((!(beside >> i & 1) && has_side(surface, room, v, i)) ||
            (!(beside >> j & 1) && has_side(surface, room, v, j)) ||
            !is_certain(room, i, j, pir_surface_corner(room, v)))
            return false;
    }
    return true;
}

/* Takes corner c away and closes the surface by triangles from a corner beside it. False where none spans the hole. */
static bool take_corner(pir_surface *surface, uint32_t c, pir_surface_room *room) {
    struct rim rim;
    uint32_t v = 0;
    uint64_t gone = 0;
    for (uint32_t t = 0; t < surface->count; t++)
        gone |= (uint64_t)(corners_of(surface, t) >> c & 1) << t;
    if (!list_rim(surface, room, gone, &rim) || rim.count < 3)
        return false;
    while (v < rim.count && !spans(surface, room, &rim, rim.from[v]))
        v++;
    if (v == rim.count)
        return false;
    v = rim.from[v];
    take_away(surface, gone, rim.corners, room);
    add_fan(surface, v, &rim, room);
    return true;
}

bool pir_surface_trim(pir_surface *surface, pir_surface_room *room) {
    double distance[PIR_SURFACE_CORNERS];
    uint32_t left = surface->used, taken = 0;
    note_all_sides(surface, room);
    list_distances(surface, room, distance);
    for (uint32_t c; taken < PIR_SURFACE_CORNERS / 4 && (c = farthest_of(left, distance)) < PIR_SURFACE_CORNERS;) {
        left &= ~(1u << c);
        taken += take_corner(surface, c, room);
    }
    return taken > 0;
}

/* Bit j of side[i]: some triangle has the side (i, j). */
static void list_sides(const pir_surface *surface, uint32_t side[PIR_SURFACE_CORNERS]) {
    memset(side, 0, PIR_SURFACE_CORNERS * sizeof *side);
    for (uint32_t t = 0; t < surface->count; t++)
        for (int k = 0; k < 3; k++)
            side[surface->corner[k][t]] |= 1u << surface->corner[(k + 1) % 3][t];
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

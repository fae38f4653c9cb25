/* SPDX-License-Identifier: MIT */
/*
 * Surfaces in D: see inner_surface.h.
 *
 * Errors. A corner less the centre is off by at most `error` in length and is at most `reach` long. A det is a
 * product of three of them, so it is off by 3 · error · reach² and by less than error · reach² from rounding, error
 * being at least 2^-46 reach. A normal is a product of two sides of at most 2 · reach, each off by 2 · error: by 8
 * · error · reach, and by less than 2 · error · reach from rounding.
 */
#include "pair/inner_surface.h"

/* --- planes --- */

/* The plane of triangle t, and a lower bound on its distance from the centre. */
static inline void make_plane(pir_surface_room *room, const pir_surface *surface, uint32_t t) {
    uint32_t i = surface->corner[0][t], j = surface->corner[1][t], k = surface->corner[2][t];
    double ax = room->x[i], ay = room->y[i], az = room->z[i];
    double ex = room->x[j] - ax, ey = room->y[j] - ay, ez = room->z[j] - az;
    double fx = room->x[k] - ax, fy = room->y[k] - ay, fz = room->z[k] - az;
    double nx = ey * fz - ez * fy, ny = ez * fx - ex * fz, nz = ex * fy - ey * fx;
    double det = nx * ax + ny * ay + nz * az;
    room->nx[t] = nx;
    room->ny[t] = ny;
    room->nz[t] = nz;
    room->det[t] = det;
    room->low[t] = (det - room->det_error) / (sqrt(nx * nx + ny * ny + nz * nz) + room->normal_error);
}

static void place_corner(pir_surface_room *room, const pir_frame *frame, uint32_t i, uint32_t a, uint32_t b) {
    pir_vec3 w = pir_vec_sub(pir_frame_vertex(frame, a, b), room->centre);
    room->x[i] = w.x;
    room->y[i] = w.y;
    room->z[i] = w.z;
}

/* Notes which triangle has which directed side. */
static void note_sides(const pir_surface *surface, uint32_t t, pir_surface_room *room) {
    for (int k = 0; k < 3; k++)
        room->beside[surface->corner[k][t]][surface->corner[(k + 1) % 3][t]] = (uint8_t)t;
}

bool pir_surface_place(const pir_surface *surface, const pir_frame *frame, pir_vec3 centre, double error, double reach,
                       pir_surface_room *room, uint32_t *ret_worst) {
    room->centre = centre;
    room->reach = reach;
    room->error = error;
    room->det_error = 4 * error * reach * reach;
    room->normal_error = 10 * error * reach;
    for (uint32_t rest = surface->used; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest);
        place_corner(room, frame, i, surface->a[i], surface->b[i]);
    }
    uint32_t worst = 0;
    for (uint32_t t = 0; t < surface->count; t++) {
        make_plane(room, surface, t);
        note_sides(surface, t, room);
        worst = room->low[t] < room->low[worst] ? t : worst;
    }
    *ret_worst = worst;
    return room->low[worst] > 0;
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
    pir_vec3 a = pir_surface_corner(room, i), b = pir_surface_corner(room, j);
    pir_vec3 n = pir_vec_cross(pir_vec_sub(b, a), pir_vec_sub(w, a));
    return pir_vec_dot(n, a) > room->det_error;
}

/*
 * The triangles that make way for w: `t`, and from there across their sides those with which w makes no certain
 * triangle, and where `wide` those that w is beyond.
 */
static uint64_t find_cut(const pir_surface *surface, const pir_surface_room *room, pir_vec3 w, uint32_t t, bool wide) {
    uint64_t gone = 1ull << t;
    uint8_t open[PIR_SURFACE_TRIANGLES];
    for (uint32_t count = 1, k = (open[0] = (uint8_t)t, 0); k < count; k++)
        for (int side = 0; side < 3; side++) {
            uint32_t i = surface->corner[side][open[k]], j = surface->corner[(side + 1) % 3][open[k]];
            uint32_t next = room->beside[j][i];
            if (gone >> next & 1)
                continue;
            bool sees = wide && pir_vec_dot(pir_surface_normal(room, next), w) > room->det[next];
            if (!sees && is_certain(room, i, j, w))
                continue;
            gone |= 1ull << next;
            open[count++] = (uint8_t)next;
        }
    return gone;
}

/* The sides between what goes and what stays; false where there are none, or they pass a corner twice. */
static bool list_rim(const pir_surface *surface, const pir_surface_room *room, uint64_t gone, uint8_t from[],
                     uint8_t to[], uint32_t *ret_count) {
    uint32_t count = 0, left = 0;
    for (uint64_t rest = gone; rest; rest &= rest - 1) {
        uint32_t t = (uint32_t)__builtin_ctzll(rest);
        for (int side = 0; side < 3; side++) {
            uint32_t i = surface->corner[side][t], j = surface->corner[(side + 1) % 3][t];
            if (gone >> room->beside[j][i] & 1)
                continue;
            if (left >> i & 1)
                return false;
            left |= 1u << i;
            from[count] = (uint8_t)i;
            to[count++] = (uint8_t)j;
        }
    }
    *ret_count = count;
    return count > 0;
}

static bool has_corner(const pir_surface *surface, uint32_t a, uint32_t b) {
    for (uint32_t rest = surface->used; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest);
        if (surface->a[i] == a && surface->b[i] == b)
            return true;
    }
    return false;
}

/* Takes triangles away; those that stay move down. Returns how many stay, and the corners that they have. */
static uint32_t take_away(pir_surface *surface, uint64_t gone, pir_surface_room *room, uint32_t *ret_used) {
    uint32_t kept = 0, used = 0;
    for (uint32_t t = 0; t < surface->count; t++) {
        if (gone >> t & 1)
            continue;
        uint32_t i = surface->corner[0][t], j = surface->corner[1][t], k = surface->corner[2][t];
        used |= 1u << i | 1u << j | 1u << k;
        if (kept != t) {
            put(surface, kept, i, j, k);
            note_sides(surface, kept, room);
            room->nx[kept] = room->nx[t];
            room->ny[kept] = room->ny[t];
            room->nz[kept] = room->nz[t];
            room->det[kept] = room->det[t];
            room->low[kept] = room->low[t];
        }
        kept++;
    }
    *ret_used = used;
    return kept;
}

bool pir_surface_add(pir_surface *surface, const pir_frame *frame, uint32_t t, uint32_t a, uint32_t b,
                     pir_surface_room *room) {
    uint8_t from[PIR_SURFACE_TRIANGLES], to[PIR_SURFACE_TRIANGLES];
    uint32_t rim = 0, used;
    if (has_corner(surface, a, b))
        return false;
    pir_vec3 w = pir_vec_sub(pir_frame_vertex(frame, a, b), room->centre);
    uint64_t gone = find_cut(surface, room, w, t, true);
    if (!list_rim(surface, room, gone, from, to, &rim)) {
        gone = find_cut(surface, room, w, t, false);
        if (!list_rim(surface, room, gone, from, to, &rim))
            return false;
    }
    uint32_t stay = surface->count - (uint32_t)__builtin_popcountll(gone);
    if (stay + rim > PIR_SURFACE_TRIANGLES || surface->used == UINT32_MAX)
        return false;
    surface->count = take_away(surface, gone, room, &used);
    uint32_t i = (uint32_t)__builtin_ctz(~surface->used);
    surface->a[i] = a;
    surface->b[i] = b;
    place_corner(room, frame, i, a, b);
    for (uint32_t s = 0; s < rim; s++) {
        put(surface, surface->count, from[s], to[s], i);
        note_sides(surface, surface->count, room);
        make_plane(room, surface, surface->count++);
        used |= 1u << from[s] | 1u << i;
    }
    surface->used = used;
    PIR_ASSERT(pir_surface_is_valid(surface));
    return true;
}

bool pir_surface_is_valid(const pir_surface *surface) {
    uint32_t side[PIR_SURFACE_CORNERS] = {0}, sides = 0; // bit j of side[i]: some triangle has the side (i, j)
    for (uint32_t t = 0; t < surface->count; t++)
        for (int k = 0; k < 3; k++)
            side[surface->corner[k][t]] |= 1u << surface->corner[(k + 1) % 3][t];
    for (uint32_t i = 0; i < PIR_SURFACE_CORNERS; i++)
        sides += (uint32_t)__builtin_popcount(side[i]);
    for (uint32_t i = 0; i < PIR_SURFACE_CORNERS; i++)
        for (uint32_t j = 0; j < PIR_SURFACE_CORNERS; j++)
            if ((side[i] >> j & 1) != (side[j] >> i & 1))
                return false;
    return surface->count >= 4 && sides == 3 * surface->count;
}

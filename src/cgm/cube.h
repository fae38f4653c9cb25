/* SPDX-License-Identifier: MIT */
/*
 * The cube that Gaussian maps are projected on, as numbers: six maps, four sides and corners each, six planes through
 * the origin.
 *
 * Map m stands for the cube face at sign·axis: −x, −y, −z, +x, +y, +z for m = 0 to 5. Its axes X and Y are those
 * of Fogel and Halperin's Table 1, so that X, Y and the outward normal are right-handed. Corners are numbered in
 * lexicographic order of (X, Y); sides go counter-clockwise from corner 0: bottom, right, top, left.
 *
 * Each side lies in one of the six planes x = ±y, y = ±z, z = ±x. As lines of the projected sphere they are the
 * vectors
 *
 *     plane 2k: e_k − e_(k+1),   plane 2k + 1: e_k + e_(k+1)
 *
 * and a signed line 2·plane + reversed stands for the vector or its opposite. A side's signed line is positive inside
 * the square.
 */
#ifndef PIR_CGM_CUBE_H
#define PIR_CGM_CUBE_H

#include <stdint.h>

#define PIR_CUBE_PLANES 6
#define PIR_CUBE_EDGES  12

static inline uint32_t pir_map_axis(uint32_t map) {
    return map % 3;
}

static inline int pir_map_sign(uint32_t map) {
    return map < 3 ? -1 : 1;
}

/* The space axis that is the map's X (0) or Y (1). */
static inline uint32_t pir_map_plane_axis(uint32_t map, uint32_t k) {
    return (pir_map_axis(map) + (map < 3 ? 2 - k : 1 + k)) % 3;
}

/* The corner that side `side` starts from. */
static inline uint32_t pir_side_corner(uint32_t side) {
    return (uint32_t[4]){0, 2, 3, 1}[side];
}

/* The axis across which a side is, and the sign of that coordinate on it. */
static inline uint32_t pir_side_axis(uint32_t map, uint32_t side) {
    return pir_map_plane_axis(map, side % 2 == 0);
}

static inline int pir_side_sign(uint32_t side) {
    return side == 1 || side == 2 ? 1 : -1;
}

/* The map beyond a side. */
static inline uint32_t pir_side_neighbor(uint32_t map, uint32_t side) {
    return pir_side_axis(map, side) + (pir_side_sign(side) < 0 ? 0 : 3);
}

/* The signed line of a side. */
static inline uint32_t pir_side_line(uint32_t map, uint32_t side) {
    uint32_t d = pir_map_axis(map), w = pir_side_axis(map, side);
    int at_d = pir_map_sign(map), at_w = -pir_side_sign(side);
    uint32_t first = (d + 1) % 3 == w ? d : w;
    int at_first = first == d ? at_d : at_w;
    return 2 * (2 * first + (at_d == at_w)) + (at_first < 0);
}

/* The side of the map beyond a side along which it joins. */
static inline uint32_t pir_side_beyond(uint32_t map, uint32_t side) {
    uint32_t other = pir_side_neighbor(map, side), line = pir_side_line(map, side) ^ 1, k = 0;
    while (pir_side_line(other, k) != line)
        k++;
    return k;
}

/* The coordinates, ±1, of corner `corner` of a map. */
static inline void pir_map_corner(uint32_t map, uint32_t corner, int ret_coordinates[3]) {
    ret_coordinates[pir_map_axis(map)] = pir_map_sign(map);
    ret_coordinates[pir_map_plane_axis(map, 0)] = corner & 2 ? 1 : -1;
    ret_coordinates[pir_map_plane_axis(map, 1)] = corner & 1 ? 1 : -1;
}

/* A map's corner as a corner of the cube: bits 0 to 2 are set where x, y, z are positive. */
static inline uint32_t pir_cube_corner(uint32_t map, uint32_t corner) {
    int c[3];
    pir_map_corner(map, corner, c);
    return (c[0] > 0) | (uint32_t)(c[1] > 0) << 1 | (uint32_t)(c[2] > 0) << 2;
}

/* The vector of plane `plane`. */
static inline void pir_cube_plane(uint32_t plane, int ret_vector[3]) {
    uint32_t k = plane / 2;
    ret_vector[k] = 1;
    ret_vector[(k + 1) % 3] = plane % 2 ? 1 : -1;
    ret_vector[(k + 2) % 3] = 0;
}

#endif

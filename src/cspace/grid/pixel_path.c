/* SPDX-License-Identifier: MIT */
/* The path of pixel_path.h. */
#include "cspace/grid/pixel_path.h"

#include <stdbool.h>

/* How a face's curve lies: its coordinates are first exchanged, then counted from the other side. */
enum { FROM_RIGHT = 1, FROM_TOP = 2, EXCHANGED = 4 };

/* The faces in the order of the path. */
static const uint8_t face_at[12] = {0, 1, 2, 6, 9, 5, 8, 4, 3, 7, 10, 11};
static const uint8_t way_of[12] = {0,
                                   FROM_TOP,
                                   FROM_RIGHT | FROM_TOP,
                                   EXCHANGED,
                                   EXCHANGED,
                                   EXCHANGED,
                                   FROM_RIGHT | FROM_TOP,
                                   FROM_RIGHT | FROM_TOP,
                                   FROM_RIGHT | FROM_TOP,
                                   FROM_RIGHT | FROM_TOP,
                                   FROM_RIGHT | FROM_TOP | EXCHANGED,
                                   FROM_TOP};

/* One quarter of the curve, or its place in a square of side `side`, turned into that of the whole. */
static void turn(uint32_t side, bool right, bool upper, uint32_t at[2]) {
    if (upper)
        return;
    if (right) {
        at[0] = side - 1 - at[0];
        at[1] = side - 1 - at[1];
    }
    uint32_t first = at[0];
    at[0] = at[1];
    at[1] = first;
}

/* Place `rank` of Hilbert's curve from (0, 0) to (2^level − 1, 0). */
static void curve_at(uint32_t level, uint32_t rank, uint32_t ret_at[2]) {
    ret_at[0] = ret_at[1] = 0;
    for (uint32_t k = 0; k < level; k++, rank >>= 2) {
        bool right = rank >> 1 & 1, upper = (rank ^ (uint32_t)right) & 1;
        turn((uint32_t)1 << k, right, upper, ret_at);
        ret_at[0] += (uint32_t)right << k;
        ret_at[1] += (uint32_t)upper << k;
    }
}

static uint32_t curve_rank(uint32_t level, const uint32_t at[2]) {
    uint32_t rank = 0, left[2] = {at[0], at[1]};
    for (uint32_t k = level; k-- > 0;) {
        bool right = left[0] >> k & 1, upper = left[1] >> k & 1;
        rank = rank << 2 | (3 * (uint32_t)right ^ (uint32_t)upper);
        left[0] &= ((uint32_t)1 << k) - 1;
        left[1] &= ((uint32_t)1 << k) - 1;
        turn((uint32_t)1 << k, right, upper, left);
    }
    return rank;
}

pir_pixel pir_pixel_path_at(uint32_t level, uint32_t rank) {
    uint32_t side = (uint32_t)1 << level, at[2], face = face_at[rank >> (2 * level)], way = way_of[face];
    curve_at(level, rank & (side * side - 1), at);
    uint32_t i = at[way & EXCHANGED ? 1 : 0], j = at[way & EXCHANGED ? 0 : 1];
    return (pir_pixel){face, way & FROM_RIGHT ? side - 1 - i : i, way & FROM_TOP ? side - 1 - j : j};
}

uint32_t pir_pixel_path_rank(uint32_t level, pir_pixel pixel) {
    uint32_t side = (uint32_t)1 << level, way = way_of[pixel.face], place = 0;
    uint32_t i = way & FROM_RIGHT ? side - 1 - pixel.i : pixel.i, j = way & FROM_TOP ? side - 1 - pixel.j : pixel.j;
    while (face_at[place] != pixel.face)
        place++;
    return (place << (2 * level)) + curve_rank(level, way & EXCHANGED ? (uint32_t[2]){j, i} : (uint32_t[2]){i, j});
}

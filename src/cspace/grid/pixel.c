/* SPDX-License-Identifier: MIT */
/* HEALPix pixels by the integers of pixel.h. */
#include "cspace/grid/pixel.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* The centres of faces. */
static const int8_t face_x[12] = {1, 3, 5, 7, 0, 2, 4, 6, 1, 3, 5, 7};
static const int8_t face_y[12] = {1, 1, 1, 1, 0, 0, 0, 0, -1, -1, -1, -1};

pir_pixel_centre pir_pixel_centre_of(uint32_t level, pir_pixel pixel) {
    const int32_t n = (int32_t)1 << level, face = face_x[pixel.face], i = (int32_t)pixel.i, j = (int32_t)pixel.j;
    const int32_t y = n * face_y[pixel.face] + i + j + 1 - n, across = i - j;
    if (abs(y) <= n) {
        int32_t x = n * face + across;
        double whole = 6.0 * n;
        return (pir_pixel_centre){(uint32_t)(x < 0 ? x + 8 * n : x), 8 * (uint32_t)n, (3 * n + 2 * y) / whole,
                                  (3 * n - 2 * y) / whole};
    }
    int32_t s = 2 * n - abs(y), x = face * s + across;
    double near = (double)s * s / (6.0 * n * n), far = (6.0 * n * n - (double)s * s) / (6.0 * n * n);
    return (pir_pixel_centre){(uint32_t)x, 8 * (uint32_t)s, y > 0 ? far : near, y > 0 ? near : far};
}

/* The low 16 bits of `bits`, each followed by a zero. */
static uint64_t spread(uint32_t bits) {
    uint64_t wide = 0;
    for (int k = 0; k < 16; k++)
        wide |= (uint64_t)(bits >> k & 1) << (2 * k);
    return wide;
}

uint64_t pir_pixel_nested(uint32_t level, pir_pixel pixel) {
    return ((uint64_t)pixel.face << (2 * level)) + (spread(pixel.i) | spread(pixel.j) << 1);
}

/* --- circles of latitude --- */

uint32_t pir_pixel_circle_count(uint32_t level, int32_t y) {
    const int32_t n = (int32_t)1 << level;
    return 4 * (uint32_t)(abs(y) <= n ? n : 2 * n - abs(y));
}

uint32_t pir_pixel_circle_first(uint32_t level, int32_t y) {
    const int32_t n = (int32_t)1 << level;
    // towards a pole longitudes are odd; between, X + Y and N + 1 are both odd or both even
    return abs(y) <= n ? (uint32_t)(abs(y) + n + 1) & 1 : 1;
}

/* The pixel at X, Y: the faces lie in squares of side N along the diagonals of the plane. */
static pir_pixel pixel_at(int32_t n, int32_t x, int32_t y) {
    // both sums are positive: X ≥ 0, |Y| < 2N
    int32_t up = (x + y + 3 * n) / (2 * n) - 1, down = (y - x + 11 * n) / (2 * n) - 5;
    int32_t along = up - down, row = up + down;
    uint32_t face = ((uint32_t)along & 7) / 2 + (row > 0 ? 0 : row == 0 ? 4 : 8);
    int32_t i = (x + y - 2 * n * up + n - 1) / 2, j = (y - x - 2 * n * down + n - 1) / 2;
    return (pir_pixel){face, (uint32_t)i, (uint32_t)j};
}

pir_pixel pir_pixel_on_circle(uint32_t level, int32_t y, uint32_t k) {
    const int32_t n = (int32_t)1 << level;
    if (abs(y) <= n)
        return pixel_at(n, (int32_t)(2 * k + pir_pixel_circle_first(level, y)), y);
    // s pixels of each face, in the plane about the face's middle
    int32_t s = 2 * n - abs(y), quarter = (int32_t)k / s, face = 2 * quarter + 1;
    return pixel_at(n, face * n + 2 * (int32_t)k + 1 - face * s, y);
}

double pir_pixel_y_of(uint32_t level, double z) {
    const double n = (double)((uint32_t)1 << level), height = fabs(z);
    double y = height <= 2.0 / 3 ? 1.5 * n * height : 2 * n - n * sqrt(fmax(0, 3 * (1 - height)));
    return z < 0 ? -y : y;
}

double pir_pixel_z_of(uint32_t level, int32_t y) {
    const double n = (double)((uint32_t)1 << level), s = 2 * n - abs(y);
    double height = abs(y) <= n ? 2 * abs(y) / (3 * n) : 1 - s * s / (3 * n * n);
    return y < 0 ? -height : height;
}

/* --- a path through all pixels --- */

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

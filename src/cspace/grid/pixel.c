/* SPDX-License-Identifier: MIT */
/* HEALPix pixels by the integers of pixel.h. */
#include "cspace/grid/pixel.h"

#include <math.h>
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

/* SPDX-License-Identifier: MIT */
/*
 * HEALPix: 12·N² pixels of equal area on the sphere, N = 2^level, whose centres lie on 4N − 1 circles of latitude.
 *
 * The map is a plane one (Calabretta and Roukema, Mapping on the HEALPix grid, Mon. Not. R. Astron. Soc. 381, 2007).
 * Twelve squares that stand on a corner, the faces, lie in three rows of four; each has N × N pixels. With half the
 * diagonal of a pixel as unit the centre of pixel (i, j) of face f is at the integers
 *
 *     X = N·x_f + i − j        0 … 8N − 1, once round the sphere
 *     Y = N·y_f + i + j + 1 − N        from south, 1 − 2N, to north, 2N − 1
 *
 * where (x_f, y_f) is the centre of the face: (1, 1), (3, 1), (5, 1), (7, 1) in the north, (0, 0), (2, 0), (4, 0), (6,
 * 0) at the equator, (1, −1) … (7, −1) in the south. Where |Y| ≤ N, latitude and longitude are
 *
 *     z = 2Y/3N,      φ = X/8N of a full turn,
 *
 * and towards a pole the circle s = 2N − |Y| has 4s pixels, s of each face:
 *
 *     z = ±(1 − s²/3N²),      φ = (x_f·s + X − N·x_f)/8s of a full turn.
 *
 * A pixel's nested number is f·N² with the bits of i and j behind it, in turn, those of i at the even places.
 */
#ifndef PIR_CSPACE_GRID_PIXEL_H
#define PIR_CSPACE_GRID_PIXEL_H

#include <stdint.h>

typedef struct pir_pixel {
    uint32_t face, i, j;
} pir_pixel;

/* The centre of a pixel: its longitude num/den of a full turn, and halves of 1 + z and 1 − z, each a square. */
typedef struct pir_pixel_centre {
    uint32_t num, den;
    double upper, lower;
} pir_pixel_centre;

pir_pixel_centre pir_pixel_centre_of(uint32_t level, pir_pixel pixel);

uint64_t pir_pixel_nested(uint32_t level, pir_pixel pixel);

/* The circle of latitude Y: how many pixels it has. */
uint32_t pir_pixel_circle_count(uint32_t level, int32_t y);

/* The longitude of its pixel 0, in parts 1/2·count of a full turn (0 or 1); pixel k is 2k such parts further on. */
uint32_t pir_pixel_circle_first(uint32_t level, int32_t y);

/* Pixel k of the circle of latitude Y. */
pir_pixel pir_pixel_on_circle(uint32_t level, int32_t y, uint32_t k);

/* Y, not rounded, of the latitude with sine z; and back. */
double pir_pixel_y_of(uint32_t level, double z);
double pir_pixel_z_of(uint32_t level, int32_t y);

/* --- a path through all pixels --- */

/*
 * Each pixel is a neighbour of the one before. Within a face the path is Hilbert's curve, which begins and ends at two
 * corners of one side. The faces follow each other such that the curve of one ends beside the place where that of the
 * next begins; a table says in which order, and how each face's curve is turned or reflected.
 */

/* Pixel `rank` of the path, of 12·4^level, and back. O(level). */
pir_pixel pir_pixel_path_at(uint32_t level, uint32_t rank);
uint32_t pir_pixel_path_rank(uint32_t level, pir_pixel pixel);

#endif

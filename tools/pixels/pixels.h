/* SPDX-License-Identifier: MIT */
/*
 * Pictures of bodies that need not be convex: pixels that keep the nearest of what is drawn at each.
 *
 * Coordinates are those of the picture, in pixels: right, down, and towards the viewer, who is far away. A picture is
 * drawn several samples to a pixel each way and averaged. All is in floats: no answer depends on it.
 *
 * Invariants: `depth` is that of what `colour` shows at each sample, −∞ where nothing was drawn.
 */
#ifndef TOOLS_PIXELS_PIXELS_H
#define TOOLS_PIXELS_PIXELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PIXELS_SAMPLES 3

struct pixel_colour {
    uint8_t red, green, blue;
};

/* Zeroed or made, pixels_clear releases it. */
struct pixels {
    size_t width, height; /* in pixels */
    float *depth;         /* per sample, row by row */
    struct pixel_colour *colour;
};

/* White. False when out of memory. */
bool pixels_make(struct pixels *pixels, size_t width, size_t height);
void pixels_clear(struct pixels *pixels);

/*
 * Fills a polygon, which may be of any shape: what its loop goes round an odd number of times. Sides that are walked
 * both ways bound nothing. Its points are in one plane, z = plane[0]·x + plane[1]·y + plane[2]. `crossings` has room
 * for `count` numbers.
 */
void pixels_fill(struct pixels *pixels, const float (*at)[3], size_t count, const double plane[3],
                 struct pixel_colour colour, double *crossings);

/* Draws a line, of `thick` samples, where nothing is nearer than it by more than `before` pixels. */
void pixels_line(struct pixels *pixels, const float a[3], const float b[3], float before, int thick,
                 struct pixel_colour colour);

/* The mean of the samples of each pixel of a row, to width · 3 bytes. */
void pixels_row(const struct pixels *pixels, size_t row, uint8_t *ret_bytes);

#endif

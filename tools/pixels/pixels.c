/* SPDX-License-Identifier: MIT */
/* See pixels.h. A sample is in the middle of its square. */
#include "pixels/pixels.h"

#include <math.h>
#include <stdlib.h>

#define SCALE ((double)PIXELS_SAMPLES)

bool pixels_make(struct pixels *pixels, size_t width, size_t height) {
    const size_t samples = width * height * PIXELS_SAMPLES * PIXELS_SAMPLES;
    *pixels =
        (struct pixels){width, height, malloc(samples * sizeof(float)), malloc(samples * sizeof(struct pixel_colour))};
    for (size_t i = 0; i < samples && pixels->depth && pixels->colour; i++) {
        pixels->depth[i] = -INFINITY;
        pixels->colour[i] = (struct pixel_colour){255, 255, 255};
    }
    return pixels->depth && pixels->colour;
}

void pixels_clear(struct pixels *pixels) {
    free(pixels->depth);
    free(pixels->colour);
    *pixels = (struct pixels){0};
}

/* The first sample at or after a coordinate in pixels, of 0 to `count`. */
static size_t sample_from(double at, size_t count) {
    const double sample = ceil(at * SCALE - 0.5);
    return sample > 0 ? (sample < (double)count ? (size_t)sample : count) : 0;
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void pixels_fill(struct pixels *pixels, const float (*at)[3], size_t count, const double plane[3],
                 struct pixel_colour colour, double *crossings) {
    const size_t columns = pixels->width * PIXELS_SAMPLES, rows = pixels->height * PIXELS_SAMPLES;
    float top = INFINITY, bottom = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        top = fminf(top, at[i][1]);
        bottom = fmaxf(bottom, at[i][1]);
    }
    for (size_t row = sample_from(top, rows), end = sample_from(bottom, rows); row < end; row++) {
        const double y = ((double)row + 0.5) / SCALE;
        size_t crossed = 0;
        for (size_t i = 0; i < count; i++) {
            const float *a = at[i], *b = at[i + 1 < count ? i + 1 : 0];
            // always from the upper end to the lower, so that a side walked back crosses where it did before
            if (((double)a[1] <= y) == ((double)b[1] <= y))
                continue;
            const float *upper = a[1] < b[1] ? a : b, *lower = a[1] < b[1] ? b : a;
            const double share = (y - (double)upper[1]) / ((double)lower[1] - (double)upper[1]);
            crossings[crossed++] = (double)upper[0] + share * ((double)lower[0] - (double)upper[0]);
        }
        qsort(crossings, crossed, sizeof *crossings, by_size);
        for (size_t k = 0; k + 1 < crossed; k += 2)
            for (size_t x = sample_from(crossings[k], columns), last = sample_from(crossings[k + 1], columns); x < last;
                 x++) {
                const size_t sample = row * columns + x;
                const float z = (float)(plane[0] * ((double)x + 0.5) / SCALE + plane[1] * y + plane[2]);
                if (z <= pixels->depth[sample])
                    continue;
                pixels->depth[sample] = z;
                pixels->colour[sample] = colour;
            }
    }
}

/* Colours the samples about one, where nothing is nearer than z. */
static void dot(struct pixels *pixels, double x, double y, float z, int thick, struct pixel_colour colour) {
    const double columns = (double)(pixels->width * PIXELS_SAMPLES), rows = (double)(pixels->height * PIXELS_SAMPLES);
    const double first_x = floor(x - thick * 0.5 + 0.5), first_y = floor(y - thick * 0.5 + 0.5);
    for (int i = 0; i < thick * thick; i++) {
        const double column = first_x + i % thick, row = first_y + i / thick;
        if (column < 0 || row < 0 || column >= columns || row >= rows)
            continue;
        const size_t sample = (size_t)row * (size_t)columns + (size_t)column;
        if (z >= pixels->depth[sample])
            pixels->colour[sample] = colour;
    }
}

void pixels_line(struct pixels *pixels, const float a[3], const float b[3], float before, int thick,
                 struct pixel_colour colour) {
    const double way[3] = {(double)b[0] - (double)a[0], (double)b[1] - (double)a[1], (double)b[2] - (double)a[2]};
    const size_t steps = (size_t)ceil(fmax(fabs(way[0]), fabs(way[1])) * SCALE) + 1;
    for (size_t s = 0; s <= steps; s++) {
        const double share = (double)s / (double)steps;
        dot(pixels, ((double)a[0] + share * way[0]) * SCALE, ((double)a[1] + share * way[1]) * SCALE,
            (float)((double)a[2] + share * way[2]) + before, thick, colour);
    }
}

void pixels_row(const struct pixels *pixels, size_t row, uint8_t *ret_bytes) {
    const size_t columns = pixels->width * PIXELS_SAMPLES;
    for (size_t x = 0; x < pixels->width; x++) {
        unsigned sum[3] = {0, 0, 0};
        for (size_t i = 0; i < PIXELS_SAMPLES * PIXELS_SAMPLES; i++) {
            const struct pixel_colour colour = pixels->colour[(row * PIXELS_SAMPLES + i / PIXELS_SAMPLES) * columns +
                                                              x * PIXELS_SAMPLES + i % PIXELS_SAMPLES];
            sum[0] += colour.red;
            sum[1] += colour.green;
            sum[2] += colour.blue;
        }
        for (size_t k = 0; k < 3; k++)
            ret_bytes[3 * x + k] =
                (uint8_t)((sum[k] + PIXELS_SAMPLES * PIXELS_SAMPLES / 2) / (PIXELS_SAMPLES * PIXELS_SAMPLES));
    }
}

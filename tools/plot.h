/* SPDX-License-Identifier: MIT */
/* A chart, in SVG, of times over frames, or one in so many: frames along, times up on a logarithmic scale. */
#ifndef TOOLS_PLOT_H
#define TOOLS_PLOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct plot_series {
    const char *label, *colour;
    const double *times; /* nanoseconds by frame, NaN where not measured; NULL: draw the median alone, as a level */
    double median;
};

struct plot {
    const char *title, *subtitle;
    size_t frames;   /* at least 1 */
    uint64_t stride; /* that one of them stands for, at least 1 */
    struct plot_series series[3];
    size_t count;
};

/* False, with a complaint, when out of memory. */
bool plot_write(const struct plot *plot, FILE *file);

#endif

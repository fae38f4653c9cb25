/* SPDX-License-Identifier: MIT */
/* Charts with logarithmic axes as SVG: lines for what depends on x, or points beside the diagonal for one
   figure against another. */
#ifndef BENCH_CHART_H
#define BENCH_CHART_H

#include <stdbool.h>
#include <stdio.h>

#define CHART_SERIES_MAX 8
#define CHART_POINTS_MAX 128

struct chart_series {
    const char *label;
    unsigned count;
    double x[CHART_POINTS_MAX], y[CHART_POINTS_MAX]; /* all positive */
};

struct chart {
    const char *title, *subtitle, *x_label, *y_label;
    bool scatter; /* points without lines, and the diagonal x = y */
    unsigned count;
    struct chart_series series[CHART_SERIES_MAX];
};

void chart_add(struct chart_series *series, double x, double y);

void chart_write(const struct chart *chart, FILE *file);

#endif

/* SPDX-License-Identifier: MIT */
/* The charts of chart.h. Colours are those of Okabe and Ito, which the colour-blind can tell apart;
   labels stand at the right. */
#include "chart.h"

#include <assert.h>
#include <math.h>

enum { WIDTH = 860, HEIGHT = 520, LEFT = 80, RIGHT = 210, TOP = 70, BOTTOM = 60 };

static const char *const colours[CHART_SERIES_MAX] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                      "#e69f00", "#56b4e9", "#000000", "#7f7f7f"};

void chart_add(struct chart_series *series, double x, double y) {
    assert(series->count < CHART_POINTS_MAX);
    series->x[series->count] = x;
    series->y[series->count++] = y;
}

/* Decades from low to high, and where they are drawn. */
struct axis {
    double low, high; /* log10, whole numbers */
    double from, to;
};

static void stretch(struct axis *axis, double value) {
    axis->low = fmin(axis->low, floor(log10(value)));
    axis->high = fmax(axis->high, ceil(log10(value)));
}

static double place(const struct axis *axis, double value) {
    return axis->from + (axis->to - axis->from) * (log10(value) - axis->low) / (axis->high - axis->low);
}

static void write_ticks(FILE *file, const struct axis *x, const struct axis *y) {
    for (double e = x->low; e <= x->high; e++) {
        double at = place(x, pow(10, e));
        fprintf(file, "<path class='g' d='M%.1f %dV%d'/><text x='%.1f' y='%d' text-anchor='middle'>%g</text>\n", at,
                HEIGHT - BOTTOM, TOP, at, HEIGHT - BOTTOM + 18, pow(10, e));
    }
    for (double e = y->low; e <= y->high; e++) {
        double at = place(y, pow(10, e));
        fprintf(file, "<path class='g' d='M%d %.1fH%d'/><text x='%d' y='%.1f' text-anchor='end'>%g</text>\n", LEFT, at,
                WIDTH - RIGHT, LEFT - 8, at + 4, pow(10, e));
    }
}

static void write_series(FILE *file, const struct chart *chart, unsigned i, const struct axis *x,
                         const struct axis *y) {
    const struct chart_series *s = &chart->series[i];
    if (!chart->scatter) {
        fprintf(file, "<path fill='none' stroke='%s' stroke-width='2' d='", colours[i]);
        for (unsigned k = 0; k < s->count; k++)
            fprintf(file, "%c%.1f %.1f", k == 0 ? 'M' : 'L', place(x, s->x[k]), place(y, s->y[k]));
        fprintf(file, "'/>\n");
    }
    for (unsigned k = 0; k < s->count; k++)
        fprintf(file, "<circle cx='%.1f' cy='%.1f' r='3' fill='%s'/>\n", place(x, s->x[k]), place(y, s->y[k]),
                colours[i]);
    double at = TOP + 14 + 22 * (double)i;
    fprintf(file, "<circle cx='%d' cy='%.1f' r='5' fill='%s'/><text x='%d' y='%.1f'>%s</text>\n", WIDTH - RIGHT + 20,
            at - 4, colours[i], WIDTH - RIGHT + 32, at, s->label);
}

void chart_write(const struct chart *chart, FILE *file) {
    struct axis x = {INFINITY, -INFINITY, LEFT, WIDTH - RIGHT}, y = {INFINITY, -INFINITY, HEIGHT - BOTTOM, TOP};
    for (unsigned i = 0; i < chart->count; i++)
        for (unsigned k = 0; k < chart->series[i].count; k++) {
            stretch(&x, chart->series[i].x[k]);
            stretch(&y, chart->series[i].y[k]);
        }
    fprintf(
        file,
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %d %d' font-family='sans-serif' font-size='12'>\n"
        "<style>.g{stroke:#ddd}.d{stroke:#888;stroke-dasharray:5 4}</style>\n<rect width='%d' height='%d' "
        "fill='#fff'/>\n"
        "<text x='%d' y='28' font-size='17' font-weight='bold'>%s</text><text x='%d' y='48' fill='#555'>%s</text>\n",
        WIDTH, HEIGHT, WIDTH, HEIGHT, LEFT, chart->title, LEFT, chart->subtitle);
    write_ticks(file, &x, &y);
    if (chart->scatter) {
        double from = pow(10, fmax(x.low, y.low)), to = pow(10, fmin(x.high, y.high));
        fprintf(file, "<path class='d' d='M%.1f %.1fL%.1f %.1f'/>\n", place(&x, from), place(&y, from), place(&x, to),
                place(&y, to));
    }
    for (unsigned i = 0; i < chart->count; i++)
        write_series(file, chart, i, &x, &y);
    fprintf(file,
            "<text x='%d' y='%d' text-anchor='middle'>%s</text>\n"
            "<text transform='translate(18 %d) rotate(-90)' text-anchor='middle'>%s</text>\n</svg>\n",
            (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 16, chart->x_label, (TOP + HEIGHT - BOTTOM) / 2, chart->y_label);
}

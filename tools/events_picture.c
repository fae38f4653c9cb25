/* SPDX-License-Identifier: MIT */
/* The chart: a line in steps, with a mark below for every event. */
#include "events_picture.h"

#include <inttypes.h>
#include <math.h>

#include "text.h"

#define WIDTH  960
#define HEIGHT 420
#define LEFT   78
#define RIGHT  24
#define TOP    70
#define BOTTOM 70

static double place_x(const struct events_chart *chart, double degrees) {
    return LEFT + (degrees - chart->from) / (chart->to - chart->from) * (WIDTH - LEFT - RIGHT);
}

/* The greatest of 1, 2, 5 times a power of ten up to `number`, at least `least`. */
static double round_step(double number, double least) {
    const double decade = pow(10, floor(log10(number)));
    const double step = number >= 5 * decade ? 5 * decade : number >= 2 * decade ? 2 * decade : decade;
    return fmax(step, least);
}

static void draw_angles(FILE *file, const struct events_chart *chart) {
    const double span = chart->to - chart->from, step = span == 360 ? 30 : round_step(span / 8, 0);
    for (double degrees = ceil(chart->from / step) * step; degrees <= chart->to; degrees += step) {
        const double x = place_x(chart, degrees);
        fprintf(file, "<path d='M%.1f %dV%d' stroke='#e4e4e4'/>\n", x, TOP, HEIGHT - BOTTOM);
        fprintf(file, "<text x='%.1f' y='%d' text-anchor='middle'>%g°</text>\n", x, HEIGHT - BOTTOM + 34, degrees);
    }
}

/* Levels of facets: from a round number below the least, or 0 where that is near, to one above the most. */
struct levels {
    double low, high, step, unit; /* a facet is so high */
};

static struct levels levels_of(const struct events_chart *chart) {
    double least = chart->facets, most = chart->facets;
    for (size_t i = 0; i < chart->count; i++) {
        least = fmin(least, chart->event[i].facets);
        most = fmax(most, chart->event[i].facets);
    }
    struct levels levels = {.low = 0};
    if (2 * least > most && least < most) {
        levels.step = round_step((most - least) / 4, 1);
        levels.low = fmax(0, floor(least / levels.step - 0.5) * levels.step);
    } else {
        levels.step = round_step(fmax(most, 1) / 5, 1);
    }
    levels.high = (floor(most / levels.step) + 1) * levels.step;
    levels.unit = (HEIGHT - TOP - BOTTOM) / (levels.high - levels.low);
    return levels;
}

static double place_y(const struct levels *levels, double facets) {
    return HEIGHT - BOTTOM - (facets - levels->low) * levels->unit;
}

static void draw_levels(FILE *file, const struct levels *levels) {
    for (double level = levels->low; level <= levels->high; level += levels->step) {
        const double y = place_y(levels, level);
        fprintf(file, "<path d='M%d %.1fH%d' stroke='#e4e4e4'/>\n", LEFT, y, WIDTH - RIGHT);
        fprintf(file, "<text x='%d' y='%.1f' text-anchor='end'>%g</text>\n", LEFT - 8, y + 4, level);
    }
}

void events_picture_write(FILE *file, const struct events_chart *chart) {
    const struct levels levels = levels_of(chart);
    fprintf(file,
            "<svg xmlns='http://www.w3.org/2000/svg' width='%d' height='%d' viewBox='0 0 %d %d' "
            "font-family='Helvetica, Arial, sans-serif' font-size='12' fill='#333' stroke-width='1'>\n"
            "<rect width='%d' height='%d' fill='#fff'/>\n<text x='%d' y='30' font-size='17' font-weight='bold'>",
            WIDTH, HEIGHT, WIDTH, HEIGHT, WIDTH, HEIGHT, LEFT);
    text_print_xml(file, chart->title[0]);
    fprintf(file, ", turning, and ");
    text_print_xml(file, chart->title[1]);
    fprintf(file, "</text>\n<text x='%d' y='51' fill='#555'>facets of the sum, %zu events</text>\n", LEFT,
            chart->count);
    draw_angles(file, chart);
    draw_levels(file, &levels);
    fprintf(file, "<path fill='none' stroke='#1f5fa8' stroke-width='1.5' d='M%d %.1f", LEFT,
            place_y(&levels, chart->facets));
    for (size_t i = 0; i < chart->count; i++)
        fprintf(file, "H%.2fV%.1f", place_x(chart, chart->event[i].degrees), place_y(&levels, chart->event[i].facets));
    fprintf(file, "H%d'/>\n<path stroke='#c0392b' stroke-width='.6' d='", WIDTH - RIGHT);
    for (size_t i = 0; i < chart->count; i++)
        fprintf(file, "M%.2f %dv12", place_x(chart, chart->event[i].degrees), HEIGHT - BOTTOM + 4);
    fprintf(file, "'/>\n</svg>\n");
}

/* SPDX-License-Identifier: MIT */
/*
 * The chart. Where there are more frames than columns, neighbouring frames share a column, drawn as a band from the
 * least to the greatest time and a line through the medians; the file's size does not grow with the number of frames.
 */
#include "plot.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "measure.h"
#include "message.h"
#include "text.h"

#define WIDTH   960
#define HEIGHT  540
#define LEFT    78
#define RIGHT   24
#define TOP     104
#define BOTTOM  58
#define COLUMNS 400

/* The numbers of all frames that share a column. */
struct column {
    double frame, least, median, most;
};

struct columns {
    struct column column[COLUMNS];
    size_t count;
};

/* The window: times between low and high nanoseconds. */
struct scale {
    double low, high;
    size_t frames;
};

/* --- numbers to places --- */

static double place_x(const struct scale *scale, double frame) {
    double last = scale->frames > 1 ? (double)(scale->frames - 1) : 1;
    return LEFT + frame / last * (WIDTH - LEFT - RIGHT);
}

static double place_y(const struct scale *scale, double time) {
    return TOP + log(scale->high / time) / log(scale->high / scale->low) * (HEIGHT - TOP - BOTTOM);
}

/* The greatest of 1, 2, 5 times a power of ten up to `number`, and the one after it. */
static double round_down(double number) {
    double decade = pow(10, floor(log10(number)));
    return number >= 5 * decade ? 5 * decade : number >= 2 * decade ? 2 * decade : decade;
}

static double round_up(double number) {
    double down = round_down(number), decade = pow(10, floor(log10(number)));
    return down >= number ? down : down == 2 * decade ? 5 * decade : down == 5 * decade ? 10 * decade : 2 * decade;
}

/* --- from times to columns --- */

static size_t frames_per_column(const struct plot *plot) {
    return (plot->frames + COLUMNS - 1) / COLUMNS;
}

/* A logarithmic scale has no zero: what the clock could not tell apart counts as a nanosecond. */
static double drawn(double time) {
    return time < 1 ? 1 : time;
}

static void gather(const struct plot *plot, const double *times, double *work, struct columns *columns) {
    columns->count = 0;
    size_t share = frames_per_column(plot);
    for (size_t first = 0; first < plot->frames; first += share) {
        size_t kept = 0;
        size_t end = first + share < plot->frames ? first + share : plot->frames;
        for (size_t i = first; i < end; i++)
            if (!isnan(times[i]))
                work[kept++] = drawn(times[i]);
        if (kept == 0)
            continue;
        sort_numbers(work, kept);
        columns->column[columns->count++] = (struct column){
            .frame = (double)(first + end - 1) / 2,
            .least = work[0],
            .median = median_of_sorted(work, kept),
            .most = work[kept - 1],
        };
    }
}

static struct scale scale_for(const struct plot *plot, const struct columns *columns) {
    struct scale scale = {.low = INFINITY, .high = 0, .frames = plot->frames};
    for (size_t s = 0; s < plot->count; s++) {
        scale.low = fmin(scale.low, drawn(plot->series[s].median));
        scale.high = fmax(scale.high, drawn(plot->series[s].median));
        for (size_t i = 0; i < columns[s].count; i++) {
            scale.low = fmin(scale.low, columns[s].column[i].least);
            scale.high = fmax(scale.high, columns[s].column[i].most);
        }
    }
    scale.low = round_down(scale.low);
    scale.high = round_up(scale.high);
    if (scale.high <= scale.low)
        scale.high = round_up(scale.low * 1.5);
    return scale;
}

/* --- drawing --- */

static void put_time(double nanoseconds, FILE *file) {
    static const char *const units[] = {"ns", "µs", "ms", "s"};
    int unit = 0;
    while (nanoseconds >= 999.5 && unit < 3) {
        nanoseconds /= 1000;
        unit++;
    }
    fprintf(file, "%.3g %s", nanoseconds, units[unit]);
}

static void draw_level_lines(const struct scale *scale, FILE *file) {
    bool wide = scale->high / scale->low > 200;
    double decade = pow(10, floor(log10(scale->low)));
    for (; decade <= scale->high; decade *= 10)
        for (int digit = 1; digit <= 9; digit++) {
            double time = digit * decade;
            if (time < scale->low * (1 - 1e-9) || time > scale->high * (1 + 1e-9))
                continue;
            double y = place_y(scale, time);
            fprintf(file, "<path d='M%d %.1fH%d' stroke='%s'/>\n", LEFT, y, WIDTH - RIGHT,
                    digit == 1 ? "#c8c8c8" : "#ececec");
            if (digit == 1 || (!wide && (digit == 2 || digit == 5)))
                fprintf(file, "<text x='%d' y='%.1f' text-anchor='end'>%g</text>\n", LEFT - 8, y + 4, time / 1000);
        }
}

static void draw_frame_lines(const struct scale *scale, uint64_t stride, FILE *file) {
    double last = scale->frames > 1 ? (double)(scale->frames - 1) * (double)stride : 1;
    double step = fmax(1, round_up(last / 10));
    for (double frame = 0; frame <= last; frame += step) {
        double x = place_x(scale, frame / (double)stride);
        fprintf(file, "<path d='M%.1f %dV%d' stroke='#ececec'/>\n", x, TOP, HEIGHT - BOTTOM);
        fprintf(file, "<text x='%.1f' y='%d' text-anchor='middle'>%.0f</text>\n", x, HEIGHT - BOTTOM + 18, frame);
    }
}

static void draw_frame(const struct plot *plot, const struct scale *scale, FILE *file) {
    fprintf(file,
            "<svg xmlns='http://www.w3.org/2000/svg' width='%d' height='%d' viewBox='0 0 %d %d' "
            "font-family='Helvetica, Arial, sans-serif' font-size='12' fill='#333' stroke-width='1'>\n"
            "<rect width='%d' height='%d' fill='#fff'/>\n",
            WIDTH, HEIGHT, WIDTH, HEIGHT, WIDTH, HEIGHT);
    fprintf(file, "<text x='%d' y='30' font-size='17' font-weight='bold' fill='#111'>", LEFT);
    text_print_xml(file, plot->title);
    fprintf(file, "</text>\n<text x='%d' y='51' font-size='13' fill='#555'>", LEFT);
    text_print_xml(file, plot->subtitle);
    fputs("</text>\n", file);
    draw_level_lines(scale, file);
    draw_frame_lines(scale, plot->stride, file);
    fprintf(file, "<path d='M%d %dV%dH%d' fill='none' stroke='#555'/>\n", LEFT, TOP, HEIGHT - BOTTOM, WIDTH - RIGHT);
    fprintf(file, "<text x='%d' y='%d' text-anchor='middle' font-size='13'>frame</text>\n", (LEFT + WIDTH - RIGHT) / 2,
            HEIGHT - 16);
    fprintf(file, "<text transform='translate(22 %d) rotate(-90)' text-anchor='middle' font-size='13'>",
            (TOP + HEIGHT - BOTTOM) / 2);
    fputs("time per frame [µs], logarithmic</text>\n", file);
}

static void draw_series(const struct plot_series *series, const struct columns *columns, const struct scale *scale,
                        FILE *file) {
    if (!series->times) {
        fprintf(file, "<path d='M%d %.1fH%d' stroke='%s' stroke-width='2' stroke-dasharray='7 4'/>\n", LEFT,
                place_y(scale, drawn(series->median)), WIDTH - RIGHT, series->colour);
        return;
    }
    // the band: along the greatest times and back along the least
    fprintf(file, "<path fill='%s' fill-opacity='0.2' d='", series->colour);
    for (size_t i = 0; i < columns->count; i++)
        fprintf(file, "%c%.1f %.1f", i ? 'L' : 'M', place_x(scale, columns->column[i].frame),
                place_y(scale, columns->column[i].most));
    for (size_t i = columns->count; i-- > 0;)
        fprintf(file, "L%.1f %.1f", place_x(scale, columns->column[i].frame), place_y(scale, columns->column[i].least));
    fprintf(file,
            "Z'/>\n<path fill='none' stroke='%s' stroke-width='1.4' stroke-linejoin='round' stroke-linecap='round' d='",
            series->colour);
    for (size_t i = 0; i < columns->count; i++)
        fprintf(file, "%c%.1f %.1f", i ? 'L' : 'M', place_x(scale, columns->column[i].frame),
                place_y(scale, columns->column[i].median));
    // nothing more to the right, so that a line of one point is drawn as a dot
    fputs("h0'/>\n", file);
}

static void draw_legend(const struct plot *plot, FILE *file) {
    int room = (WIDTH - LEFT - RIGHT) / 3;
    for (size_t s = 0; s < plot->count; s++) {
        const struct plot_series *series = &plot->series[s];
        int x = LEFT + (int)s * room;
        fprintf(file, "<path d='M%d 78h24' stroke='%s' stroke-width='3'%s/>\n", x, series->colour,
                series->times ? "" : " stroke-dasharray='7 4'");
        fprintf(file, "<text x='%d' y='82' font-size='13'>%s, median ", x + 32, series->label);
        put_time(series->median, file);
        fputs("</text>\n", file);
    }
    if (plot->frames > COLUMNS) {
        fprintf(file,
                "<text x='%d' y='%d' text-anchor='end' fill='#555'>band: least to greatest of %zu frames side by side",
                WIDTH - RIGHT, HEIGHT - 16, frames_per_column(plot));
        if (plot->stride > 1)
            fprintf(file, ", one in %" PRIu64, plot->stride);
        fputs("</text>\n", file);
    }
}

bool plot_write(const struct plot *plot, FILE *file) {
    struct columns *columns = calloc(plot->count, sizeof *columns);
    double *work = malloc(frames_per_column(plot) * sizeof *work);
    bool good = columns && work;
    if (good) {
        for (size_t s = 0; s < plot->count; s++)
            if (plot->series[s].times)
                gather(plot, plot->series[s].times, work, &columns[s]);
        struct scale scale = scale_for(plot, columns);
        draw_frame(plot, &scale, file);
        for (size_t s = plot->count; s-- > 0;)
            draw_series(&plot->series[s], &columns[s], &scale, file);
        draw_legend(plot, file);
        fputs("</svg>\n", file);
    } else {
        complain("plot: out of memory");
    }
    free(work);
    free(columns);
    return good;
}

/* SPDX-License-Identifier: MIT */
/* The command's chart of times: the numbers that its curves show, read back through the labels of its axes. */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"
#include "plot.h"
#include "support/random.h"

#define COLUMNS    400
#define FRAMES_MAX 4100

/* What the axes of a chart say: a time at a height, and frames across. */
struct axes {
    double y, time, per_pixel; /* a label's height and time, and the logarithm of times a pixel down */
    double x, frames;          /* frame 0, and frames a pixel */
};

static char *chart_of(const struct plot *plot) {
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_true(plot_write(plot, file));
    long size = ftell(file);
    char *text = calloc((size_t)size + 1, 1);
    assert_true(text && fseek(file, 0, SEEK_SET) == 0 && fread(text, 1, (size_t)size, file) == (size_t)size);
    fclose(file);
    assert_non_null(strstr(text, "</svg>\n"));
    return text;
}

/* The first label of an axis behind `from`: where it stands and what it says; returns what follows, or NULL. */
static const char *next_label(const char *from, const char *anchor, double *x, double *y, double *number) {
    while ((from = strstr(from, "<text x='"))) {
        char side[8];
        if (sscanf(from, "<text x='%lf' y='%lf' text-anchor='%7[a-z]'>%lf<", x, y, side, number) == 4 &&
            strcmp(side, anchor) == 0)
            return from + 1;
        from++;
    }
    return NULL;
}

static struct axes axes_of(const char *chart) {
    struct axes axes;
    double x, y, number, first_y = 0, first = 0;
    int labels = 0;
    for (const char *at = next_label(chart, "end", &x, &y, &number); at;
         at = next_label(at, "end", &x, &y, &number), labels++)
        if (labels == 0)
            first_y = y, first = number;
        else
            axes.per_pixel = log(number / first) / (y - first_y);
    assert_true(labels >= 2);
    axes.y = first_y - 4, axes.time = 1000 * first;
    axes.frames = 0, axes.x = 0;
    labels = 0;
    for (const char *at = next_label(chart, "middle", &x, &y, &number); at;
         at = next_label(at, "middle", &x, &y, &number), labels++)
        if (labels == 0)
            axes.x = x;
        else
            axes.frames = number / (x - axes.x);
    assert_true(labels >= 1);
    return axes;
}

/* Takes the next point off a path; NULL at its end. */
static const char *next_point(const char *at, double *x, double *y) {
    int used = 0;
    return sscanf(at, "%*1[ML]%lf %lf%n", x, y, &used) == 2 && used ? at + used : NULL;
}

/* Whether the next point of the path shows this time of that frame; moves past it. */
static void expect_point(const char **at, const struct axes *axes, double frame, double time, const char *what) {
    double x, y;
    const char *next = next_point(*at, &x, &y);
    expect(next, "%s: no point for frame %g", what, frame);
    *at = next;
    double shown = axes->time * exp((y - axes->y) * axes->per_pixel);
    // a tenth of a pixel of up to seven powers of ten in 378, and the axis's own rounding
    expect(fabs(log(shown / time)) < 0.02, "%s: frame %g shows %g, not %g", what, frame, shown, time);
    expect(axes->frames == 0 || fabs((x - axes->x) * axes->frames - frame) <= 0.2 * axes->frames + 1e-9 * frame,
           "%s: a point at %g for frame %g", what, x, frame);
    expect(x > 77.9 && x < 936.1 && y > 103.9 && y < 482.1, "%s: %g %g is out of the window", what, x, y);
}

/* The measured times of column c, sorted; a time below one counts as one. */
static size_t times_of_column(const struct plot *plot, size_t series, size_t c, double *ret_times, double *ret_frame) {
    size_t share = (plot->frames + COLUMNS - 1) / COLUMNS, count = 0, end = (c + 1) * share;
    end = end < plot->frames ? end : plot->frames;
    for (size_t i = c * share; i < end; i++)
        if (!isnan(plot->series[series].times[i]))
            ret_times[count++] = fmax(1, plot->series[series].times[i]);
    sort_numbers(ret_times, count);
    *ret_frame = (double)(c * share + end - 1) / 2 * (double)plot->stride;
    return count;
}

static void expect_series(const struct plot *plot, size_t s, const char *chart, const struct axes *axes) {
    const struct plot_series *series = &plot->series[s];
    char start[80];
    if (!series->times) {
        double y;
        const char *level = strstr(chart, "' stroke-width='2' stroke-dasharray");
        assert_non_null(level);
        while (strncmp(level, "<path", 5) != 0)
            level--;
        assert_int_equal(sscanf(level, "<path d='M78 %lfH936'", &y), 1);
        double shown = axes->time * exp((y - axes->y) * axes->per_pixel);
        expect(fabs(log(shown / fmax(1, series->median))) < 0.02 && y > 103.9 && y < 482.1, "level %g at %g", shown, y);
        return;
    }
    snprintf(start, sizeof start, "<path fill='%s' fill-opacity='0.2' d='", series->colour);
    const char *band = strstr(chart, start);
    assert_non_null(band);
    band += strlen(start);
    const char *line = strstr(band, "stroke-linecap='round' d='");
    assert_non_null(line);
    line += strlen("stroke-linecap='round' d='");
    static double times[FRAMES_MAX];
    double frame;
    size_t share = (plot->frames + COLUMNS - 1) / COLUMNS, columns = (plot->frames + share - 1) / share;
    for (size_t c = 0; c < columns; c++) {
        size_t count = times_of_column(plot, s, c, times, &frame);
        if (count == 0)
            continue;
        expect_point(&band, axes, frame, times[count - 1], "greatest");
        expect_point(&line, axes, frame, median_of_sorted(times, count), "median");
    }
    for (size_t c = columns; c-- > 0;) {
        size_t count = times_of_column(plot, s, c, times, &frame);
        if (count > 0)
            expect_point(&band, axes, frame, times[0], "least");
    }
    assert_int_equal(*band, 'Z');
    assert_int_equal(*line, 'h');
}

static void curves_show_the_times(void **state) {
    (void)state;
    static const size_t frames[] = {1, 2, 3, 399, 400, 401, 1000, 4001};
    static const char *const colours[] = {"#111", "#222", "#333"};
    static double times[3][FRAMES_MAX];
    for (uint64_t i = 0; i < 32; i++) {
        test_random random = test_random_case("chart", i);
        struct plot plot = {"title", "subtitle", frames[i % 8], 1 + i % 3, .count = 1 + i / 3 % 3};
        for (size_t s = 0; s < plot.count; s++) {
            // of different sizes, the first now least, now greatest
            double size = pow(10, test_random_between(&random, 0, 5));
            for (size_t k = 0; k < plot.frames; k++) {
                bool measured = k == 0 || test_random_below(&random, 3 + (uint32_t)s) > 0;
                times[s][k] = measured ? floor(size * exp(2 * test_random_unit(&random)) - 1) : NAN;
            }
            bool level = s == 2 || (s == 1 && i % 2);
            plot.series[s] = (struct plot_series){"label", colours[s], level ? NULL : times[s], times[s][0]};
        }
        // only one level can be told apart from the others
        plot.count = plot.count == 3 && !plot.series[1].times ? 2 : plot.count;
        char *chart = chart_of(&plot);
        struct axes axes = axes_of(chart);
        for (size_t s = 0; s < plot.count; s++)
            expect_series(&plot, s, chart, &axes);
        free(chart);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(curves_show_the_times)};
    return cmocka_run_group_tests_name("plot", tests, NULL, NULL);
}

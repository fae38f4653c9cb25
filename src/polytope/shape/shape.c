/* SPDX-License-Identifier: MIT */
/*
 * Polytopes by name: "name?key=value&key=value" read against the table of shapes, then the exact hull of the shape's
 * points.
 *
 * Reading allocates nothing and knows no locale. A value of up to 15 significant digits and 22 decimals is the nearest
 * double; a longer one is a few ulp off at most, the same on every machine.
 */
#include <math.h>
#include <string.h>

#include <pirouette/shape.h>

#include "base/memory.h"
#include "base/report.h"
#include "polytope/shape/shape_table.h"

/* A piece of the caller's text, and how much of it a report shows. */
struct piece {
    const char *text;
    size_t length;
};
#define SHOWN_MAX 40

/* Copies the piece's beginning for a report, what is not printable as '?'. */
static const char *show(struct piece piece, char shown[SHOWN_MAX + 1]) {
    const size_t length = piece.length < SHOWN_MAX ? piece.length : SHOWN_MAX;
    for (size_t i = 0; i < length; i++)
        shown[i] = '?';
    for (size_t i = 0; i < length; i++)
        if (piece.text[i] >= ' ' && piece.text[i] <= '~')
            shown[i] = piece.text[i];
    shown[length] = '\0';
    return shown;
}

static bool piece_is(struct piece piece, const char *word) {
    return strlen(word) == piece.length && memcmp(piece.text, word, piece.length) == 0;
}

/* The number of letters to insert, drop or change to get from the piece to `word` (Wagner and
   Fischer 1974), both cut. */
static size_t distance(struct piece piece, const char *word) {
    const size_t rows = piece.length < SHOWN_MAX ? piece.length : SHOWN_MAX;
    size_t columns = strlen(word);
    columns = columns < SHOWN_MAX ? columns : SHOWN_MAX;
    size_t row[SHOWN_MAX + 1];
    for (size_t j = 0; j <= columns; j++)
        row[j] = j;
    for (size_t i = 1; i <= rows; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= columns; j++) {
            const size_t changed = diagonal + (piece.text[i - 1] != word[j - 1]);
            const size_t dropped = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
            diagonal = row[j];
            row[j] = changed < dropped ? changed : dropped;
        }
    }
    return row[columns];
}

static const struct pir_shape_entry *find_shape(struct piece name, pir_report *report) {
    const struct pir_shape_entry *nearest = NULL;
    for (size_t i = 0; i < pir_shapes_count; i++) {
        if (piece_is(name, pir_shapes[i].name))
            return &pir_shapes[i];
        if (!nearest || distance(name, pir_shapes[i].name) < distance(name, nearest->name))
            nearest = &pir_shapes[i];
    }
    char shown[SHOWN_MAX + 1];
    pir_fail(report, PIR_ERR_ARGUMENT, "unknown shape '%s': the nearest name is '%s'", show(name, shown),
             nearest->name);
    return NULL;
}

/* value · 10^exponent, |exponent| ≤ 60, in factors that are exact doubles. */
static double scale_decimal(double value, int exponent) {
    static const double power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    while (exponent > 0) {
        const int step = exponent < 22 ? exponent : 22;
        value *= power[step];
        exponent -= step;
    }
    while (exponent < 0) {
        const int step = exponent > -22 ? -exponent : 22;
        value /= power[step];
        exponent += step;
    }
    return value;
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* Reads [+-]digits[.digits] from the front of the piece: mantissa · 10^exponent. Digits past the
   nineteenth only count. */
static bool read_mantissa(struct piece *piece, uint64_t *ret_mantissa, int *ret_exponent) {
    uint64_t mantissa = 0;
    int exponent = 0, significant = 0;
    bool any = false, after_point = false;
    for (; piece->length > 0; piece->text++, piece->length--) {
        const char c = *piece->text;
        if (c == '.' && !after_point) {
            after_point = true;
            continue;
        }
        if (!is_digit(c))
            break;
        any = true;
        const bool kept = significant < 19;
        if (kept)
            mantissa = 10 * mantissa + (uint64_t)(c - '0');
        significant += kept && mantissa != 0;
        exponent += (kept ? 0 : 1) - (after_point ? 1 : 0);
    }
    *ret_mantissa = mantissa;
    *ret_exponent = exponent;
    return any;
}

/* The piece as a decimal number; false when it is none, or lies far outside every parameter's range. */
static bool read_number(struct piece piece, double *ret_value) {
    if (piece.length == 0 || piece.length > 200)
        return false;
    const bool minus = *piece.text == '-';
    if (minus || *piece.text == '+') {
        piece.text++;
        piece.length--;
    }
    uint64_t mantissa;
    int exponent;
    if (!read_mantissa(&piece, &mantissa, &exponent))
        return false;
    if (piece.length > 0 && (*piece.text == 'e' || *piece.text == 'E')) {
        piece.text++;
        piece.length--;
        const bool down = piece.length > 0 && *piece.text == '-';
        if (piece.length > 0 && (down || *piece.text == '+')) {
            piece.text++;
            piece.length--;
        }
        if (piece.length == 0 || piece.length > 3)
            return false;
        int written = 0;
        for (; piece.length > 0 && is_digit(*piece.text); piece.text++, piece.length--)
            written = 10 * written + (*piece.text - '0');
        exponent += down ? -written : written;
    }
    if (piece.length > 0 || exponent > 40 || (mantissa != 0 && exponent < -60))
        return false;
    *ret_value = (minus ? -1.0 : 1.0) * scale_decimal((double)mantissa, mantissa ? exponent : 0);
    return true;
}

/* The names of a shape's parameters for a report. */
static const char *parameter_list(const struct pir_shape_entry *shape, char list[64]) {
    size_t used = 0;
    for (int k = 0; k < PIR_SHAPE_PARAMETERS; k++) {
        const char *name = shape->parameter[k].name;
        if (!name || used + strlen(name) + 3 > 64)
            continue;
        if (used > 0) {
            list[used++] = ',';
            list[used++] = ' ';
        }
        memcpy(list + used, name, strlen(name));
        used += strlen(name);
    }
    list[used] = '\0';
    return used > 0 ? list : "none";
}

/* Reads one "key=value" into `value`; `given` has a bit for each parameter that was. */
static pir_status read_parameter(const struct pir_shape_entry *shape, struct piece piece, double *value,
                                 unsigned *given, pir_report *report) {
    char shown[SHOWN_MAX + 1], list[64];
    const char *equals = memchr(piece.text, '=', piece.length);
    if (!equals)
        return pir_fail(report, PIR_ERR_ARGUMENT, "shape '%s': '%s' is not key=value", shape->name, show(piece, shown));
    const struct piece key = {piece.text, (size_t)(equals - piece.text)};
    const struct piece text = {equals + 1, piece.length - key.length - 1};
    int k = 0;
    while (k < PIR_SHAPE_PARAMETERS && !(shape->parameter[k].name && piece_is(key, shape->parameter[k].name)))
        k++;
    if (k == PIR_SHAPE_PARAMETERS)
        return pir_fail(report, PIR_ERR_ARGUMENT, "shape '%s': no parameter '%s'; its parameters: %s", shape->name,
                        show(key, shown), parameter_list(shape, list));
    const struct pir_shape_parameter *parameter = &shape->parameter[k];
    if (*given >> k & 1)
        return pir_fail(report, PIR_ERR_ARGUMENT, "shape '%s': %s is given twice", shape->name, parameter->name);
    double number;
    if (!read_number(text, &number) || !(number >= parameter->low && number <= parameter->high) ||
        (parameter->whole && number != floor(number)))
        return pir_fail(report, PIR_ERR_ARGUMENT, "shape '%s': %s=%s is not a %snumber from %g to %g", shape->name,
                        parameter->name, show(text, shown), parameter->whole ? "whole " : "", parameter->low,
                        parameter->high);
    *given |= 1u << k;
    value[k] = number;
    return PIR_OK;
}

/* Finds the shape and its parameters' values. */
static pir_status read_name(const char *name, pir_report *report, const struct pir_shape_entry **ret_shape,
                            double value[PIR_SHAPE_PARAMETERS]) {
    const char *mark = strchr(name, '?');
    const struct pir_shape_entry *shape =
        find_shape((struct piece){name, mark ? (size_t)(mark - name) : strlen(name)}, report);
    if (!shape)
        return PIR_ERR_ARGUMENT;
    for (int k = 0; k < PIR_SHAPE_PARAMETERS; k++)
        value[k] = shape->parameter[k].standard;
    unsigned given = 0;
    while (mark) {
        const char *start = mark + 1;
        const size_t length = strcspn(start, "&");
        const pir_status status = read_parameter(shape, (struct piece){start, length}, value, &given, report);
        if (status != PIR_OK)
            return status;
        mark = start[length] == '&' ? start + length : NULL;
    }
    *ret_shape = shape;
    return PIR_OK;
}

pir_status pir_shape_create(const char *name, const pir_allocator *allocator, pir_report *report,
                            pir_polytope **ret_polytope) {
    if (!name || !ret_polytope)
        return pir_fail(report, PIR_ERR_ARGUMENT, "shape: no name or no place for the result");
    const struct pir_shape_entry *shape = NULL;
    double value[PIR_SHAPE_PARAMETERS];
    pir_status status = read_name(name, report, &shape, value);
    if (status != PIR_OK)
        return status;
    const pir_allocator used = pir_allocator_or_default(allocator);
    const pir_polytope_options options = {sizeof options, &used, 0};
    struct pir_point_list points = {.allocator = &used};
    shape->fill(value, &points);
    status = points.failed ? PIR_ERR_MEMORY : pir_polytope_create(points.at, points.count, &options, ret_polytope);
    pir_point_list_finish(&points);
    if (status != PIR_OK)
        pir_fail(report, status, "shape '%s': %s", shape->name, pir_status_text(status));
    return status;
}

size_t pir_shape_count(void) {
    return pir_shapes_count;
}

const char *pir_shape_name(size_t index) {
    return index < pir_shapes_count ? pir_shapes[index].name : NULL;
}

const char *pir_shape_help(size_t index) {
    return index < pir_shapes_count ? pir_shapes[index].help : NULL;
}

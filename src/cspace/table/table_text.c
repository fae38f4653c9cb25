/* SPDX-License-Identifier: MIT */
/*
 * Tables in text: a row a line, fields between commas or, in a line without commas, between blanks. Empty lines and
 * what follows a # are passed over, and a first line of names.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/report.h"
#include "cspace/table/table_forms.h"
#include "polytope/file/c_locale.h"

/* Room for a number and its final zero. */
#define NUMBER_ROOM 1024

/* The line being read, without its end. */
struct text_line {
    const char *at, *end;
    uint32_t number;
    bool commas;
};

struct field {
    const char *text;
    size_t length;
};

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

/* The next field of the line, blanks around it left out. False at the end. */
static bool next_field(struct text_line *line, bool first, struct field *ret_field) {
    if (!line->commas)
        while (line->at < line->end && is_blank(*line->at))
            line->at++;
    if (line->commas ? !first && line->at > line->end : line->at == line->end)
        return false;
    const char *from = line->at, *to = from;
    while (to < line->end && (line->commas ? *to != ',' : !is_blank(*to)))
        to++;
    line->at = line->commas ? to + 1 : to;
    while (from < to && is_blank(*from))
        from++;
    while (from < to && is_blank(to[-1]))
        to--;
    *ret_field = (struct field){from, (size_t)(to - from)};
    return true;
}

/* The field as a number, which may be an infinity or a NaN. False where it is none. */
static bool field_number(const struct field *field, double *ret_value) {
    char text[NUMBER_ROOM], *end;
    if (field->length == 0 || field->length >= NUMBER_ROOM || memchr(field->text, '\0', field->length))
        return false;
    memcpy(text, field->text, field->length);
    text[field->length] = '\0';
    *ret_value = strtod(text, &end);
    return *end == '\0';
}

/* Whether no field of the line is a number. */
static bool is_heading(struct text_line line) {
    struct field field;
    double value;
    for (bool first = true; next_field(&line, first, &field); first = false)
        if (field.length == 0 || field_number(&field, &value))
            return false;
    return true;
}

static pir_status fail_line(const pir_table *table, const struct text_line *line, const char *what) {
    return pir_fail(table->report, PIR_ERR_FORMAT, "%s:%u: %s", table->name, line->number, what);
}

/* Room for one more row, or false when out of memory. */
static bool make_room(pir_table *table, const pir_allocator *allocator) {
    if (table->rows < table->capacity)
        return true;
    const uint32_t columns = table->form.columns, capacity = table->capacity ? 2 * table->capacity : 64;
    uint32_t *line = PIR_NEW(allocator, uint32_t, capacity);
    if (!line)
        return false;
    double *value = PIR_RESIZE(allocator, table->value, (size_t)table->capacity * columns, (size_t)capacity * columns);
    if (!value) {
        PIR_FREE(allocator, line, capacity);
        return false;
    }
    if (table->rows > 0)
        memcpy(line, table->line, table->rows * sizeof *line);
    PIR_FREE(allocator, table->line, table->capacity);
    table->line = line;
    table->value = value;
    table->capacity = capacity;
    return true;
}

/* Reads the numbers of a line into the next row. */
static pir_status read_row(pir_table *table, struct text_line *line) {
    const uint32_t columns = table->form.columns, row = table->rows;
    double *value = table->value + (size_t)row * columns;
    struct field field;
    uint32_t count = 0;
    table->line[row] = line->number;
    for (; next_field(line, count == 0, &field); count++) {
        double number;
        const int shown = field.length < 40 ? (int)field.length : 40;
        if (memchr(field.text, '\0', field.length))
            return fail_line(table, line, "a zero byte");
        if (!field_number(&field, &number))
            return pir_table_fail(table, row, PIR_ERR_FORMAT, "'%.*s' is not a number", shown, field.text);
        if (!isfinite(number))
            return pir_table_fail(table, row, PIR_ERR_NOT_FINITE, "'%.*s' is not a finite number", shown, field.text);
        if (count < columns)
            value[count] = number;
    }
    if (count != columns)
        return pir_table_fail(table, row, PIR_ERR_FORMAT, "%u number%s, not %u: %s", count, count == 1 ? "" : "s",
                              columns, table->form.names);
    table->rows++;
    return PIR_OK;
}

/* The line from `at` on, without a comment. */
static struct text_line line_at(const char *at, const char *end, uint32_t number) {
    const char *stop = memchr(at, '\n', (size_t)(end - at));
    stop = stop ? stop : end;
    const char *comment = memchr(at, '#', (size_t)(stop - at));
    struct text_line line = {at, comment ? comment : stop, number, false};
    line.commas = memchr(at, ',', (size_t)(line.end - at)) != NULL;
    return line;
}

static bool is_empty(const struct text_line *line) {
    for (const char *c = line->at; c < line->end; c++)
        if (!is_blank(*c))
            return false;
    return true;
}

static pir_status read_lines(const char *data, size_t size, const pir_allocator *allocator, pir_table *table) {
    const char *end = data + size, *at = data;
    bool first = true;
    for (uint32_t number = 1; at < end; number++) {
        struct text_line line = line_at(at, end, number);
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        at = stop ? stop + 1 : end;
        if (is_empty(&line))
            continue;
        bool heading = first && is_heading(line);
        first = false;
        if (heading)
            continue;
        if (!make_room(table, allocator))
            return pir_fail(table->report, PIR_ERR_MEMORY, "%s: out of memory", table->name);
        pir_status status = read_row(table, &line);
        if (status != PIR_OK)
            return status;
    }
    return PIR_OK;
}

pir_status pir_table_read_text(const char *data, size_t size, const pir_allocator *allocator, pir_table *table) {
    struct pir_c_locale locale;
    if (!pir_c_locale_enter(&locale))
        return pir_fail(table->report, PIR_ERR_MEMORY, "%s: out of memory", table->name);
    pir_status status = read_lines(data, size, allocator, table);
    pir_c_locale_leave(&locale);
    return status;
}

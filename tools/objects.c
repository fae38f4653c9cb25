/* SPDX-License-Identifier: MIT */
/* Objects of OBJ texts. */
#include "objects.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A line without its end. */
struct line {
    const char *at;
    size_t length;
};

/* The next line of the text, which moves on; false at its end. */
static bool next_line(const char **text, struct line *ret_line) {
    if (**text == '\0')
        return false;
    *ret_line = (struct line){*text, strcspn(*text, "\r\n")};
    *text += ret_line->length;
    *text += strspn(*text, "\r\n");
    return true;
}

/* Whether the line is a statement of that one letter. */
static bool is_statement(const struct line *line, char letter) {
    return line->length >= 2 && line->at[0] == letter && (line->at[1] == ' ' || line->at[1] == '\t');
}

/* The lines of an object that has facets, counted by facets seen in each stretch between two `o`. */
struct walk {
    const char *text;
    size_t index;  /* of the object that the last line belongs to */
    bool faceted;  /* it has had a facet */
    bool started;  /* some object has had one */
    size_t points; /* before the last line, in the whole file */
};

/* The next line, and whether it is a facet of object `index`. */
static bool walk_on(struct walk *walk, struct line *ret_line) {
    if (!next_line(&walk->text, ret_line))
        return false;
    if (is_statement(ret_line, 'o'))
        walk->faceted = false;
    if (is_statement(ret_line, 'f') && !walk->faceted) {
        walk->index += walk->started;
        walk->faceted = walk->started = true;
    }
    walk->points += is_statement(ret_line, 'v');
    return true;
}

size_t objects_count(const char *text) {
    struct walk walk = {.text = text};
    struct line line;
    while (walk_on(&walk, &line))
        continue;
    return walk.index + walk.started;
}

/* The number of the point that a corner names, counted from 1; 0 where there is none. */
static size_t point_of(const char *corner, const struct walk *walk, size_t all) {
    long number = strtol(corner, NULL, 10);
    if (number < 0)
        number += (long)walk->points + 1;
    return number > 0 && (size_t)number <= all ? (size_t)number : 0;
}

/* The text of one object, as it is put together. */
struct output {
    FILE *stream;
    uint32_t *as; /* per point: its number in the object, or 0 */
    size_t count; /* of points that have one */
};

/* Calls for each corner of the facet: numbers new points, or writes the corner. */
static void each_corner(const struct line *line, const struct walk *walk, struct output *out, size_t all, bool write) {
    const char *end = line->at + line->length;
    for (const char *at = line->at + 1; at < end;) {
        at += strspn(at, " \t");
        size_t length = strcspn(at, " \t\r\n");
        if (at >= end || length == 0)
            break;
        size_t point = point_of(at, walk, all);
        if (!write && point > 0 && out->as[point] == 0)
            out->as[point] = (uint32_t)++out->count;
        if (write && point > 0)
            fprintf(out->stream, " %u", (unsigned)out->as[point]);
        else if (write)
            fprintf(out->stream, " %.*s", (int)length, at);
        at += length;
    }
}

/* The points that have a number, in the order of their numbers. */
static bool write_points(const char *text, struct output *out) {
    struct line *point = calloc(out->count + 1, sizeof *point), line;
    if (!point)
        return false;
    for (size_t number = 0; next_line(&text, &line);)
        if (is_statement(&line, 'v') && out->as[++number] > 0)
            point[out->as[number]] = line;
    for (size_t i = 1; i <= out->count; i++)
        fprintf(out->stream, "%.*s\n", (int)point[i].length, point[i].at);
    free(point);
    return true;
}

static bool write_object(const char *text, size_t index, size_t all, struct output *out) {
    struct line line;
    for (struct walk walk = {.text = text}; walk_on(&walk, &line);)
        if (is_statement(&line, 'f') && walk.index == index)
            each_corner(&line, &walk, out, all, false);
    if (!write_points(text, out))
        return false;
    for (struct walk walk = {.text = text}; walk_on(&walk, &line);)
        if (is_statement(&line, 'f') && walk.index == index) {
            fputs("f", out->stream);
            each_corner(&line, &walk, out, all, true);
            fputs("\n", out->stream);
        }
    return true;
}

char *objects_text(const char *text, size_t index) {
    struct walk walk = {.text = text};
    struct line line;
    while (walk_on(&walk, &line))
        continue;
    char *object = NULL;
    size_t size = 0;
    struct output out = {.stream = open_memstream(&object, &size), .as = calloc(walk.points + 1, sizeof *out.as)};
    bool good = out.stream && out.as && write_object(text, index, walk.points, &out);
    if (out.stream && fclose(out.stream) != 0)
        good = false;
    free(out.as);
    if (good)
        return object;
    free(object);
    return NULL;
}

char *objects_name(const char *text, size_t index) {
    struct walk walk = {.text = text};
    struct line line, last = {"", 0};
    while (walk_on(&walk, &line)) {
        if (is_statement(&line, 'o'))
            last = line;
        if (is_statement(&line, 'f') && walk.index == index)
            break;
    }
    char *name = malloc(last.length + 32);
    if (!name)
        return NULL;
    const size_t skip = last.length > 0 ? 1 + strspn(last.at + 1, " \t") : 0;
    if (last.length > skip)
        sprintf(name, "%.*s", (int)(last.length - skip), last.at + skip);
    else
        sprintf(name, "object %zu", index + 1);
    return name;
}

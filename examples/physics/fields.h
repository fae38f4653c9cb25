/* SPDX-License-Identifier: MIT */
/*
 * Objects of JSON, read strictly: a key that is not known, comes twice or has a value of another kind is refused, and
 * so is a number that is not finite. The first thing that is wrong is kept, in one line that says where and why; every
 * function that returns false or NULL has left such a line.
 */
#ifndef PHYSICS_FIELDS_H
#define PHYSICS_FIELDS_H

#include <stdbool.h>
#include <stddef.h>

#include <cjson/cJSON.h>

/* Room for a place such as bodies[12].position. */
#define FIELDS_PLACE 96

struct fields {
    const cJSON *object;
    char place[FIELDS_PLACE]; /* of the object in the file; empty for all of it */
    char *why;                /* the line, with room for `size` */
    size_t size;
};

/* Leaves a line about what stands at `name` in the object, or about the object where `name` is NULL. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
bool fields_fail(const struct fields *fields, const char *name, const char *format, ...);

/* Whether it is an object with no other keys than `known`, which ends with NULL. */
bool fields_known(const struct fields *fields, const char *const *known);

/* What stands at `name`, or element `index` of the array there. */
struct fields fields_at(const struct fields *fields, const char *name);
struct fields fields_element(const struct fields *fields, const char *name, int index);

/* Each reads what stands at `name`; the value stays where nothing does. */
bool fields_number(const struct fields *fields, const char *name, double low, double high, double *value);
bool fields_numbers(const struct fields *fields, const char *name, int count, double *values);
bool fields_flag(const struct fields *fields, const char *name, bool *value);
bool fields_choice(const struct fields *fields, const char *name, const char *const *choices, int *choice);
/* NULL with a line where nothing stands there or no text. */
const char *fields_text(const struct fields *fields, const char *name);
/* The array there, which has at least one element; NULL with a line where there is none. */
const cJSON *fields_array(const struct fields *fields, const char *name);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * JSON objects through cJSON. Doubles read back as themselves; cJSON's own printing may lose the last bit. A failure
 * for want of memory is kept in `failed`, so that callers check once, at the end.
 */
#ifndef TOOLS_JSON_H
#define TOOLS_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cjson/cJSON.h>

struct json {
    cJSON *root; /* an object */
    bool failed; /* memory ran out once */
};

/* Starts an object. */
struct json json_new(void);

/*
 * Each adds a member `name` to `parent`, an object, or, when `name` is NULL, an element to it, an array. `parent` may
 * be NULL after a failure.
 */
void json_add_number(struct json *json, cJSON *parent, const char *name, double value);  /* null when not finite */
void json_add_count(struct json *json, cJSON *parent, const char *name, uint64_t value); /* with all its digits */
void json_add_flag(struct json *json, cJSON *parent, const char *name, bool value);
void json_add_text(struct json *json, cJSON *parent, const char *name, const char *text);
void json_add_numbers(struct json *json, cJSON *parent, const char *name, const double *values, size_t count);
cJSON *json_add_object(struct json *json, cJSON *parent, const char *name);
cJSON *json_add_array(struct json *json, cJSON *parent, const char *name);

/* Prints the object and a newline, and releases it. False, with a complaint, when memory ran out. */
bool json_print(struct json *json, FILE *file);

/* Releases the object unprinted; a printed or zeroed one is accepted. */
void json_discard(struct json *json);

#endif

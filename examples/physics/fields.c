/* SPDX-License-Identifier: MIT */
/* Strict reading; see fields.h. */
#include "fields.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool fields_fail(const struct fields *fields, const char *name, const char *format, ...) {
    const char *dot = *fields->place && name ? "." : "";
    int used = snprintf(fields->why, fields->size, "%s%s%s: ", fields->place, dot, name ? name : "");
    if (used < 0 || (size_t)used >= fields->size)
        return false;
    if (used == 2) // of all of the file
        used = 0;
    va_list rest;
    va_start(rest, format);
    vsnprintf(fields->why + used, fields->size - (size_t)used, format, rest);
    va_end(rest);
    return false;
}

bool fields_known(const struct fields *fields, const char *const *known) {
    if (!cJSON_IsObject(fields->object))
        return fields_fail(fields, NULL, "is no object");
    for (const cJSON *item = fields->object->child; item; item = item->next) {
        size_t k = 0;
        while (known[k] && strcmp(known[k], item->string) != 0)
            k++;
        if (!known[k])
            return fields_fail(fields, NULL, "unknown key '%.40s'", item->string);
        if (cJSON_GetObjectItemCaseSensitive(fields->object, item->string) != item)
            return fields_fail(fields, NULL, "key '%.40s' comes twice", item->string);
    }
    return true;
}

/* An object within another, by its place in that one. */
static struct fields within(const struct fields *fields, const cJSON *object, const char *place) {
    struct fields made = {.object = object, .why = fields->why, .size = fields->size};
    size_t used = strlen(fields->place);
    memcpy(made.place, fields->place, used);
    snprintf(made.place + used, sizeof made.place - used, "%s%s", used ? "." : "", place);
    return made;
}

static const cJSON *item_of(const struct fields *fields, const char *name) {
    return cJSON_GetObjectItemCaseSensitive(fields->object, name);
}

struct fields fields_at(const struct fields *fields, const char *name) {
    return within(fields, item_of(fields, name), name);
}

struct fields fields_element(const struct fields *fields, const char *name, int index) {
    char place[FIELDS_PLACE];
    snprintf(place, sizeof place, "%s[%d]", name, index);
    return within(fields, cJSON_GetArrayItem(item_of(fields, name), index), place);
}

bool fields_number(const struct fields *fields, const char *name, double low, double high, double *value) {
    const cJSON *item = item_of(fields, name);
    if (!item)
        return true;
    if (!cJSON_IsNumber(item))
        return fields_fail(fields, name, "is no number");
    if (!(item->valuedouble >= low && item->valuedouble <= high))
        return fields_fail(fields, name, "%g is not between %g and %g", item->valuedouble, low, high);
    *value = item->valuedouble;
    return true;
}

bool fields_numbers(const struct fields *fields, const char *name, int count, double *values) {
    const cJSON *item = item_of(fields, name);
    if (!item)
        return true;
    if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != count)
        return fields_fail(fields, name, "is no array of %d numbers", count);
    const cJSON *element = item->child;
    for (int i = 0; i < count; i++, element = element->next) {
        if (!cJSON_IsNumber(element))
            return fields_fail(fields, name, "element %d is no number", i);
        if (!isfinite(element->valuedouble))
            return fields_fail(fields, name, "element %d is not finite", i);
        values[i] = element->valuedouble;
    }
    return true;
}

bool fields_flag(const struct fields *fields, const char *name, bool *value) {
    const cJSON *item = item_of(fields, name);
    if (!item)
        return true;
    if (!cJSON_IsBool(item))
        return fields_fail(fields, name, "is neither true nor false");
    *value = cJSON_IsTrue(item);
    return true;
}

bool fields_choice(const struct fields *fields, const char *name, const char *const *choices, int *choice) {
    if (!item_of(fields, name))
        return true;
    const char *text = fields_text(fields, name);
    for (int i = 0; text && choices[i]; i++)
        if (strcmp(choices[i], text) == 0) {
            *choice = i;
            return true;
        }
    if (!text)
        return false;
    char words[200] = "";
    for (size_t i = 0, used = 0; choices[i] && used < sizeof words; i++)
        used += (size_t)snprintf(words + used, sizeof words - used, "%s%s", i ? ", " : "", choices[i]);
    return fields_fail(fields, name, "'%.40s' is none of %s", text, words);
}

const char *fields_text(const struct fields *fields, const char *name) {
    const cJSON *item = item_of(fields, name);
    if (cJSON_IsString(item))
        return item->valuestring;
    fields_fail(fields, name, item ? "is no text" : "is missing");
    return NULL;
}

const cJSON *fields_array(const struct fields *fields, const char *name) {
    const cJSON *item = item_of(fields, name);
    if (cJSON_IsArray(item) && item->child)
        return item;
    fields_fail(fields, name, !item ? "is missing" : cJSON_IsArray(item) ? "is empty" : "is no array");
    return NULL;
}

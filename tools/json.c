/* SPDX-License-Identifier: MIT */
/* JSON through cJSON; see json.h. */
#include "json.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "message.h"
#include "text.h"

struct json json_new(void) {
    struct json json = {.root = cJSON_CreateObject()};
    json.failed = !json.root;
    return json;
}

/* Hangs `item` into `parent`; NULL, with the item released, when that fails. */
static cJSON *add(struct json *json, cJSON *parent, const char *name, cJSON *item) {
    if (item && (name ? cJSON_AddItemToObject(parent, name, item) : cJSON_AddItemToArray(parent, item)))
        return item;
    cJSON_Delete(item);
    json->failed = true;
    return NULL;
}

void json_add_number(struct json *json, cJSON *parent, const char *name, double value) {
    if (!isfinite(value)) {
        add(json, parent, name, cJSON_CreateNull());
        return;
    }
    char text[TEXT_NUMBER];
    text_double(value, text);
    add(json, parent, name, cJSON_CreateRaw(text));
}

void json_add_count(struct json *json, cJSON *parent, const char *name, uint64_t value) {
    char text[TEXT_NUMBER];
    snprintf(text, sizeof text, "%" PRIu64, value);
    add(json, parent, name, cJSON_CreateRaw(text));
}

void json_add_flag(struct json *json, cJSON *parent, const char *name, bool value) {
    add(json, parent, name, cJSON_CreateBool(value));
}

/* The text in UTF-8, to be freed: U+FFFD stands for each byte that is none of a character. NULL when out of memory. */
static char *as_utf8(const char *text) {
    static const char unknown[] = "\xef\xbf\xbd";
    char *clean = malloc(strlen(text) * strlen(unknown) + 1), *to = clean;
    while (clean && *text) {
        size_t length = text_character(text);
        const char *from = length > 0 ? text : unknown;
        const size_t size = length > 0 ? length : strlen(unknown);
        memcpy(to, from, size);
        to += size;
        text += length > 0 ? length : 1;
    }
    if (clean)
        *to = '\0';
    return clean;
}

void json_add_text(struct json *json, cJSON *parent, const char *name, const char *text) {
    char *clean = as_utf8(text);
    add(json, parent, name, clean ? cJSON_CreateString(clean) : NULL);
    free(clean);
}

void json_add_numbers(struct json *json, cJSON *parent, const char *name, const double *values, size_t count) {
    cJSON *array = json_add_array(json, parent, name);
    for (size_t i = 0; i < count; i++)
        json_add_number(json, array, NULL, values[i]);
}

cJSON *json_add_object(struct json *json, cJSON *parent, const char *name) {
    return add(json, parent, name, cJSON_CreateObject());
}

cJSON *json_add_array(struct json *json, cJSON *parent, const char *name) {
    return add(json, parent, name, cJSON_CreateArray());
}

bool json_print(struct json *json, FILE *file) {
    char *text = json->failed ? NULL : cJSON_Print(json->root);
    json_discard(json);
    if (!text) {
        complain("out of memory, for the JSON text");
        return false;
    }
    if (file == stdout) {
        put_out(text);
        put_out("\n");
    } else {
        fprintf(file, "%s\n", text);
    }
    cJSON_free(text);
    return true;
}

void json_discard(struct json *json) {
    cJSON_Delete(json->root);
    json->root = NULL;
}

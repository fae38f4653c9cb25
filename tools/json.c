/* SPDX-License-Identifier: MIT */
/* JSON through cJSON; see json.h. */
#include "json.h"

#include <inttypes.h>
#include <math.h>

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

void json_add_text(struct json *json, cJSON *parent, const char *name, const char *text) {
    add(json, parent, name, cJSON_CreateString(text));
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
    fprintf(file, "%s\n", text);
    cJSON_free(text);
    return true;
}

void json_discard(struct json *json) {
    cJSON_Delete(json->root);
    json->root = NULL;
}

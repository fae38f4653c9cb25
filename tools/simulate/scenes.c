/* SPDX-License-Identifier: MIT */
/* Scenes by name; their texts are put in when the command is built. */
#include "scenes.h"

#include <stdio.h>
#include <string.h>

#include "../json.h"
#include "../message.h"
#include "scenes_data.h"

#define PREFIX "scene:"

static const size_t count = sizeof scenes_data / sizeof *scenes_data;

bool scenes_has_name(const char *path) {
    return strncmp(path, PREFIX, strlen(PREFIX)) == 0;
}

bool scenes_read(const char *path, struct stage *ret_stage, char why[STAGE_WHY]) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(path + strlen(PREFIX), scenes_data[i].name) == 0)
            return stage_read_text(path, scenes_data[i].text, ret_stage, why);
    snprintf(why, STAGE_WHY, "%.200s: there is no scene of that name; pirouette simulate --list shows all", path);
    return false;
}

bool scenes_list(bool as_json) {
    if (!as_json) {
        for (size_t i = 0; i < count; i++)
            say(PREFIX "%-10s %s\n", scenes_data[i].name, scenes_data[i].title);
        return true;
    }
    struct json json = json_new();
    cJSON *list = json_add_array(&json, json.root, "scenes");
    for (size_t i = 0; i < count; i++) {
        cJSON *scene = json_add_object(&json, list, NULL);
        json_add_text(&json, scene, "name", scenes_data[i].name);
        json_add_text(&json, scene, "title", scenes_data[i].title);
        json_add_text(&json, scene, "about", scenes_data[i].about);
    }
    return json_print(&json, stdout);
}

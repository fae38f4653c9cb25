/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a scene for the command's `simulate`: they are refused with one line, or make a world that takes steps
 * until a body leaves what numbers hold.
 *
 * Scenes that name files, escape letters, or give a shape parameters are passed over: what they would lead to is not of
 * their own size. See fuzz_sum.c for how to run an engine.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stage.h"

#include "fuzz/input.h"

#define SIZE_LIMIT 4096
#define BODIES     24
#define STEPS      4

static void take_steps(const struct stage *stage) {
    struct world *world = NULL;
    pir_status status = stage_world(stage, &world);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "a world is made, or is too large");
    if (status != PIR_OK)
        return;
    for (int i = 0; i < STEPS && status == PIR_OK; i++)
        status = world_step(world);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT || status == PIR_ERR_NOT_FINITE,
                 "a step is taken, or a body is too far away");
    world_destroy(world);
}

static void read_scene(const char *path) {
    struct stage stage = {.seconds = 0};
    char why[STAGE_WHY] = "";
    if (stage_read(path, &stage, why)) {
        if (stage.body_count <= BODIES && stage.options.iterations <= 16 && stage.options.relaxations <= 16)
            take_steps(&stage);
        stage_clear(&stage);
    } else {
        fuzz_require(strncmp(why, path, strlen(path)) == 0 && !strchr(why, '\n'), "one line names the file");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const char *folder = getenv("TMPDIR");
    char path[256];
    snprintf(path, sizeof path, "%s/pirouette-stage-XXXXXX", folder && strlen(folder) < 200 ? folder : "/tmp");
    if (size > SIZE_LIMIT || memchr(data, '/', size) || memchr(data, '\\', size) || memchr(data, '?', size))
        return 0;
    int file = mkstemp(path);
    fuzz_require(file >= 0 && write(file, data, size) == (ssize_t)size && close(file) == 0, "a file can be written");
    read_scene(path);
    unlink(path);
    return 0;
}

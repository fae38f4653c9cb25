/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a scene for the command's `simulate`: they are refused with one line, or make a world that takes steps
 * until a body leaves what numbers hold. Bodies that walk and rollbacks take part.
 *
 * Scenes that name files, escape letters, or give a shape parameters are passed over: what they would lead to is not of
 * their own size. See fuzz_sum.c for how to run an engine.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "play.h"

#include "fuzz/input.h"

#define SIZE_LIMIT 4096
#define BODIES     24
#define FRAMES     2

static void take_steps(const struct stage *stage) {
    struct play *play = NULL;
    pir_status status = play_begin(stage, NULL, NULL, &play);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "a world is made, or is too large");
    if (status != PIR_OK)
        return;
    for (int i = 0; i < FRAMES && status == PIR_OK; i++)
        status = play_frame(play);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT || status == PIR_ERR_NOT_FINITE,
                 "a step is taken, or a body is too far away");
    play_end(play);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct stage stage = {.seconds = 0};
    char text[SIZE_LIMIT + 1] = "", why[STAGE_WHY] = "";
    if (size > SIZE_LIMIT || memchr(data, '/', size) || memchr(data, '\\', size) || memchr(data, '?', size) ||
        memchr(data, '\0', size))
        return 0;
    memcpy(text, data, size);
    if (stage_read_text("a text", text, &stage, why)) {
        if (stage.body_count <= BODIES && stage.options.iterations <= 16 && stage.options.relaxations <= 16)
            take_steps(&stage);
        stage_clear(&stage);
    } else {
        fuzz_require(strncmp(why, "a text: ", 8) == 0 && !strchr(why, '\n'), "one line names the text");
    }
    return 0;
}

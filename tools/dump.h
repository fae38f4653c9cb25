/* SPDX-License-Identifier: MIT */
/*
 * A folder of frames: each as exact OFF, and frames.json, which says which rotation each has. Functions that return false have
 * complained.
 */
#ifndef TOOLS_DUMP_H
#define TOOLS_DUMP_H

#include <pirouette/pirouette.h>

#include "file.h"
#include "json.h"

struct dump {
    const char *folder;
    struct output_file index; /* frames.json */
    struct json json;
    cJSON *frames;
};

/* Makes the folder unless it is there; its frames.json appears when all is done. */
bool dump_open(struct dump *dump, const char *folder);

bool dump_frame(struct dump *dump, pir_sum *sum, uint64_t frame);

/* Writes frames.json. */
bool dump_commit(struct dump *dump);

/* Releases what is there; zeroed or committed is accepted. */
void dump_discard(struct dump *dump);

#endif

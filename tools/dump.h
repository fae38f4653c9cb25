/* SPDX-License-Identifier: MIT */
/*
 * A folder of frames, and frames.json, which says which rotation each has. A frame's sum is written in doubles, which
 * every reader of OFF takes, and, in the folder EXACT_FOLDER below, in rationals; or in rationals alone. Functions
 * that return false have complained.
 */
#ifndef TOOLS_DUMP_H
#define TOOLS_DUMP_H

#include <pirouette/pirouette.h>

#include "file.h"
#include "json.h"

/* In the folder of frames, the one of frames in rationals where there are both. */
#define EXACT_FOLDER "exact"

struct dump {
    const char *folder;
    bool exact;               /* rationals alone */
    struct output_file index; /* frames.json */
    struct json json;
    cJSON *frames;
    char *index_path;
    int lock; /* of the folder */
};

/* Makes the folder unless it is there; its frames.json appears when all is done. `exact`: rationals alone. */
bool dump_open(struct dump *dump, const char *folder, bool exact);

/* The mesh of a frame, exact, and the rotation that it has. */
bool dump_frame(struct dump *dump, const pir_mesh *mesh, pir_quat rotation, uint64_t frame);

/* Writes frames.json. */
bool dump_commit(struct dump *dump);

/* Releases what is there; zeroed or committed is accepted. */
void dump_discard(struct dump *dump);

#endif

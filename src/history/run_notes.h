/* SPDX-License-Identifier: MIT */
/* A history that is being run: the object that it is of, its bodies, and where reading stands. */
#ifndef PIR_HISTORY_RUN_NOTES_H
#define PIR_HISTORY_RUN_NOTES_H

#include <pirouette/history.h>

#include "base/memory.h"
#include "history/history_reader.h"

/* Contacts of an answer that are hashed. */
#define PIR_REPLAY_CONTACTS 64

typedef struct pir_replay {
    pir_allocator allocator;
    const char *name; /* in reports */
    pir_history_reader reader;
    pir_polytope **body;
    uint32_t bodies, room; /* held; what `body` has room for */
    uint64_t hash;         /* of what the last call gave */
    pir_sum *sum;          /* one of sum, pair and scene is there after the first call that succeeded */
    pir_query *query;      /* of `sum`, made for the first question */
    pir_query_cache cache;
    pir_pair *pair;
    pir_workspace *workspace; /* of `pair` */
    pir_scene *scene;
} pir_replay;

/* The body of the next number; NULL, and the reader is broken, where there is none. */
pir_polytope *pir_replay_take_body(pir_replay *replay);

/*
 * The calls on scenes, in run_scene_notes.c. Each takes its arguments from the reader, and calls unless that broke. The
 * status of the call.
 */
pir_status pir_replay_scene(pir_replay *replay);
pir_status pir_replay_add(pir_replay *replay);
pir_status pir_replay_remove(pir_replay *replay);
pir_status pir_replay_update(pir_replay *replay);
pir_status pir_replay_change(pir_replay *replay);

#endif

/* SPDX-License-Identifier: MIT */
/* Lanes: what each thread of a batch asks with, and how poses are dealt to them. */
#ifndef PIR_BATCH_LANES_H
#define PIR_BATCH_LANES_H

#include "base/pose_array.h"
#include "scene/tasks/tasks.h"

/* Padded to lines of the cache, which no two lanes share. */
typedef struct pir_batch_lane {
    void *object; /* of the batch's kind */
    pir_workspace *workspace;
    size_t bad, first_bad;
    pir_status first_status;
    char padding[128 - 4 * sizeof(void *) - sizeof(pir_status)];
} pir_batch_lane;

/* How an object of a batch is made of two bodies, and destroyed; NULL is accepted there. */
typedef struct pir_batch_kind {
    pir_status (*make)(const void *p, const void *q, const pir_allocator *allocator, void **ret_object);
    void (*destroy)(void *object);
} pir_batch_kind;

/* A batch of any kind begins with these. */
typedef struct pir_batch_lanes {
    const pir_batch_kind *kind;
    pir_allocator allocator;
    pir_tasks tasks;
    pir_task_pool *pool; /* NULL where the caller brings threads, or there is one */
    uint32_t threads, run;
    pir_batch_lane *lane; /* `threads` of them */
} pir_batch_lanes;

/* A batch of two bodies that is its lanes alone, as options say; NULL for the defaults. PIR_ERR_ARGUMENT for a NULL. */
pir_status pir_batch_lanes_create(const pir_batch_kind *kind, const void *p, const void *q,
                                  const pir_pair_batch_options *options, pir_batch_lanes **ret_lanes);
/* Ends the threads, destroys the objects, frees all. NULL is accepted. */
void pir_batch_lanes_destroy(pir_batch_lanes *lanes);

/* Answers poses `begin` up to `end`, with what is a lane's. */
typedef void pir_batch_answerer(const void *job, pir_batch_lane *lane, size_t begin, size_t end);

/* All poses, by all lanes. `ret_summary` may be NULL. */
void pir_batch_lanes_ask(pir_batch_lanes *lanes, pir_batch_answerer *answer, const void *job, size_t count,
                         pir_pair_batch_summary *ret_summary);

/* Counts a pose that is bad. */
static inline void pir_batch_count_bad(pir_batch_lane *lane, size_t index, pir_status status) {
    lane->bad++;
    if (index < lane->first_bad) {
        lane->first_bad = index;
        lane->first_status = status;
    }
}

/* The check of what a batch is given, but for its poses: PIR_OK, or why it is refused. */
pir_status pir_batch_check_input(const pir_pair_batch_input *input);

static inline void pir_batch_set(double (*to)[3], size_t i, pir_vec3 v) {
    if (!to)
        return;
    to[i][0] = v.x;
    to[i][1] = v.y;
    to[i][2] = v.z;
}

#endif

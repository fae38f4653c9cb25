/* SPDX-License-Identifier: MIT */
/*
 * Work on blocks: each is taken from the journal where that has it, and else made and added to it. Where several
 * processes do the same work, each makes some of the blocks, and all get all. The first has the journal.
 *
 * Whatever is kept, and whoever makes them, the blocks are the same.
 */
#ifndef PIR_PLAN_BLOCK_WORK_H
#define PIR_PLAN_BLOCK_WORK_H

#include <pirouette/plan.h>
#include <pirouette/tasks.h>

#include "plan/blocks/block_journal.h"

/* Who makes blocks, and where they are kept. */
typedef struct pir_block_makers {
    pir_tasks tasks;
    pir_block_journal *journal;  /* NULL where nothing is kept */
    const pir_plan_ranks *ranks; /* NULL where this process is alone */
} pir_block_makers;

/* Blocks to be made, by their indices; threads call the functions, each index in one thread. */
typedef struct pir_block_work {
    void *data;
    uint32_t count;
    uint64_t (*number)(void *data, uint32_t index); /* NULL where blocks are not kept */
    /* Makes one; its status is noted by `data` too. */
    pir_status (*make)(void *data, uint32_t index);
    /* Appends the bytes of one that is made; false when out of memory. */
    bool (*pack)(void *data, uint32_t index, pir_bytes *block);
    /* Takes one that was made with a status: of bytes, which may be anything. False where they are no block. */
    bool (*take)(void *data, uint32_t index, pir_status status, const pir_bytes *block);
    /*
     * NULL, or told by the thread that asks for the work, after each block that it makes itself and in the end, how
     * many are made: more each time. Of several processes false in one ends the work of all.
     */
    bool (*tell)(void *data, uint32_t done);
} pir_block_work;

/*
 * Makes all. Errors: PIR_ERR_LIMIT (where `tell` ended it), PIR_ERR_FILE, PIR_ERR_MEMORY, PIR_ERR_FORMAT (of an
 * exchange).
 */
pir_status pir_blocks_make(const pir_block_makers *makers, const pir_block_work *work);

#endif

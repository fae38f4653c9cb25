/* SPDX-License-Identifier: MIT */
/* See block_work.h. */
#include "plan/blocks/block_work.h"

#include <stdatomic.h>

/* Shared by the tasks. */
struct block_share {
    const pir_block_makers *makers;
    const pir_block_work *work;
    atomic_int failure; /* of keeping what is made: a status */
};

static void make_one(void *context, uint32_t index) {
    struct block_share *share = context;
    const pir_block_work *work = share->work;
    const pir_allocator a = pir_allocator_or_default(NULL);
    pir_block_journal *journal = work->number ? share->makers->journal : NULL;
    const uint64_t number = journal ? work->number(work->data, index) : 0;
    pir_bytes block = {0};
    const bool is_there = journal && pir_block_journal_find(journal, number, &block);
    if (!(is_there && work->take(work->data, index, &block)) && work->make(work->data, index) && journal) {
        block.used = 0;
        const pir_status status =
            work->pack(work->data, index, &block) ? pir_block_journal_add(journal, number, &block) : PIR_ERR_MEMORY;
        if (status != PIR_OK)
            atomic_store(&share->failure, (int)status);
    }
    pir_bytes_finish(&block, &a);
}

pir_status pir_blocks_make(const pir_block_makers *makers, const pir_block_work *work) {
    struct block_share share = {.makers = makers, .work = work};
    atomic_init(&share.failure, PIR_OK);
    makers->tasks.start(makers->tasks.context, make_one, &share, work->count);
    makers->tasks.finish(makers->tasks.context);
    return (pir_status)atomic_load(&share.failure);
}

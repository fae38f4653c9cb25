/* SPDX-License-Identifier: MIT */
/*
 * Alone, each task takes or makes one block. The thread that has the tasks tells how many are made after each of its
 * own, so that it is told often whatever a block takes, and none waits for another. With other processes there are
 * rounds of so many blocks, each of three exchanges: the first process gives what its journal has; each makes some of
 * the rest, and gives those; and they say whether what was made could be kept. So all know the same at every step.
 */
#include "plan/blocks/block_work.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* How many blocks are dealt in a round. */
#define MOST_DEALT 1024

struct packed_block {
    uint32_t index;
    int32_t status;
    uint64_t size;
};

/* Shared by the tasks. */
struct block_share {
    const pir_block_makers *makers;
    const pir_block_work *work;
    atomic_int failure; /* a status: of keeping what is made, or of telling, after which no block is made */
    atomic_uint done;   /* blocks that are made; with other processes their own ones of the round are left out */
    uint32_t told;
    pthread_t teller;
    /* with other processes: blocks of the round that this one looks for or makes, their bytes and statuses */
    uint32_t *index, count;
    pir_bytes *block;
    pir_status *status;
};

static void fail(struct block_share *share, pir_status status) {
    if (status != PIR_OK)
        atomic_store(&share->failure, (int)status);
}

static void tell(struct block_share *share, uint32_t done) {
    const pir_block_work *work = share->work;
    share->told = done;
    if (work->tell && !work->tell(work->data, done))
        fail(share, PIR_ERR_LIMIT);
}

/* Counts a block; the thread that has the tasks tells how many there are. */
static void count_one(struct block_share *share) {
    const uint32_t done = atomic_fetch_add(&share->done, 1) + 1;
    if (pthread_equal(pthread_self(), share->teller))
        tell(share, done);
}

/* Tells that blocks are made where nothing has failed, once; the failure. */
static pir_status end_telling(struct block_share *share, uint32_t done) {
    if (atomic_load(&share->failure) == PIR_OK && share->told < done)
        tell(share, done);
    return (pir_status)atomic_load(&share->failure);
}

static void make_one(void *context, uint32_t index) {
    struct block_share *share = context;
    const pir_block_work *work = share->work;
    if (atomic_load(&share->failure) != PIR_OK)
        return;
    const pir_allocator a = pir_allocator_or_default(NULL);
    pir_block_journal *journal = work->number ? share->makers->journal : NULL;
    const uint64_t number = journal ? work->number(work->data, index) : 0;
    pir_bytes block = {0};
    const bool is_there = journal && pir_block_journal_find(journal, number, &block);
    if (!(is_there && work->take(work->data, index, PIR_OK, &block)) && work->make(work->data, index) == PIR_OK &&
        journal) {
        block.used = 0;
        fail(share,
             work->pack(work->data, index, &block) ? pir_block_journal_add(journal, number, &block) : PIR_ERR_MEMORY);
    }
    pir_bytes_finish(&block, &a);
    count_one(share);
}

/* --- with other processes --- */

/* Looks for a block in the journal of this process. */
static void find_one(void *context, uint32_t i) {
    struct block_share *share = context;
    const pir_block_work *work = share->work;
    pir_block_journal *journal = work->number ? share->makers->journal : NULL;
    const bool found =
        journal && pir_block_journal_find(journal, work->number(work->data, share->index[i]), &share->block[i]);
    share->status[i] = found ? PIR_OK : PIR_ERR_EMPTY;
}

static void make_dealt(void *context, uint32_t i) {
    struct block_share *share = context;
    const pir_block_work *work = share->work;
    share->status[i] = PIR_ERR_EMPTY;
    if (atomic_load(&share->failure) != PIR_OK)
        return;
    share->status[i] = work->make(work->data, share->index[i]);
    if (share->status[i] == PIR_OK && !work->pack(work->data, share->index[i], &share->block[i]))
        fail(share, PIR_ERR_MEMORY);
    count_one(share);
}

static bool append(pir_bytes *to, const void *data, size_t size) {
    const pir_allocator a = pir_allocator_or_default(NULL);
    if (!pir_bytes_reserve(to, &a, size))
        return false;
    if (size > 0)
        memcpy(to->data + to->used, data, size);
    to->used += size;
    return true;
}

/* Gives the blocks of this process, but those that are not there, to all. */
static pir_status give(struct block_share *share, pir_bytes *all) {
    const pir_plan_ranks *ranks = share->makers->ranks;
    const pir_allocator a = pir_allocator_or_default(NULL);
    pir_bytes own = {0};
    bool good = true;
    for (uint32_t i = 0; i < share->count && good; i++) {
        const struct packed_block head = {share->index[i], (int32_t)share->status[i], share->block[i].used};
        if (share->status[i] != PIR_ERR_EMPTY)
            good = append(&own, &head, sizeof head) && append(&own, share->block[i].data, share->block[i].used);
    }
    *all = (pir_bytes){0};
    if (good)
        good = ranks->exchange(ranks->context, own.data, own.used, (void **)&all->data, &all->used);
    pir_bytes_finish(&own, &a);
    return good ? PIR_OK : PIR_ERR_MEMORY;
}

/* Takes what all have given; the first process keeps what is new. `is_taken` is per block of the round. */
static pir_status take_all(struct block_share *share, const pir_bytes *all, uint32_t first, bool is_new,
                           bool *is_taken) {
    const pir_block_work *work = share->work;
    pir_block_journal *journal = work->number && is_new ? share->makers->journal : NULL;
    for (size_t at = 0; at < all->used;) {
        struct packed_block head;
        if (all->used - at < sizeof head)
            return PIR_ERR_FORMAT;
        memcpy(&head, all->data + at, sizeof head);
        at += sizeof head;
        if (head.size > all->used - at || head.index < first || head.index - first >= MOST_DEALT)
            return PIR_ERR_FORMAT;
        const pir_bytes block = {all->data + at, head.size, head.size};
        at += head.size;
        bool *own = &is_taken[head.index - first];
        // a block that this process made itself is there
        if (!*own)
            *own = work->take(work->data, head.index, (pir_status)head.status, &block);
        if (is_new && !*own)
            return PIR_ERR_FORMAT;
        if (journal && head.status == PIR_OK)
            fail(share, pir_block_journal_add(journal, work->number(work->data, head.index), &block));
    }
    return PIR_OK;
}

/* Has all processes fail where one does. */
static pir_status agree(const pir_block_makers *makers, pir_status status) {
    const int32_t own = (int32_t)status;
    void *all;
    size_t size;
    if (!makers->ranks->exchange(makers->ranks->context, &own, sizeof own, &all, &size))
        return PIR_ERR_MEMORY;
    for (size_t at = 0; at + sizeof own <= size && status == PIR_OK; at += sizeof own) {
        int32_t other;
        memcpy(&other, (const char *)all + at, sizeof other);
        status = (pir_status)other;
    }
    return status;
}

static void run(struct block_share *share, void (*task)(void *context, uint32_t index)) {
    const pir_tasks tasks = share->makers->tasks;
    for (uint32_t i = 0; i < share->count; i++)
        share->block[i].used = 0;
    tasks.start(tasks.context, task, share, share->count);
    tasks.finish(tasks.context);
}

/* Makes the blocks from one on: as many as are dealt in a round. */
static pir_status make_round(struct block_share *share, uint32_t first, uint32_t count) {
    const pir_plan_ranks *ranks = share->makers->ranks;
    bool is_taken[MOST_DEALT] = {false};
    pir_bytes all;
    share->count = 0;
    for (uint32_t i = 0; i < count; i++)
        share->index[share->count++] = first + i;
    run(share, find_one);
    pir_status status = give(share, &all);
    if (status == PIR_OK)
        status = take_all(share, &all, first, false, is_taken);
    if (status != PIR_OK)
        return status;
    // every so manyth of those that no journal had
    uint32_t left = 0;
    share->count = 0;
    for (uint32_t i = 0; i < count; i++)
        if (!is_taken[i] && left++ % ranks->count == ranks->number)
            share->index[share->count++] = first + i;
    run(share, make_dealt);
    status = give(share, &all);
    for (uint32_t i = 0; i < share->count; i++)
        is_taken[share->index[i] - first] = true;
    if (status == PIR_OK)
        status = take_all(share, &all, first, true, is_taken);
    if (status == PIR_OK)
        status = end_telling(share, first + count);
    return agree(share->makers, status);
}

static pir_status make_dealt_blocks(struct block_share *share) {
    const pir_allocator a = pir_allocator_or_default(NULL);
    const uint32_t all = share->work->count, most = all < MOST_DEALT ? all : MOST_DEALT;
    share->index = calloc(most + 1, sizeof *share->index);
    share->block = calloc(most + 1, sizeof *share->block);
    share->status = calloc(most + 1, sizeof *share->status);
    pir_status status = share->index && share->block && share->status ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < all && status == PIR_OK; i += MOST_DEALT) {
        atomic_store(&share->done, i);
        status = make_round(share, i, all - i < MOST_DEALT ? all - i : MOST_DEALT);
    }
    for (uint32_t i = 0; i < most && share->block; i++)
        pir_bytes_finish(&share->block[i], &a);
    free(share->index);
    free(share->block);
    free(share->status);
    return status;
}

static pir_status make_own_blocks(struct block_share *share) {
    const pir_tasks tasks = share->makers->tasks;
    tasks.start(tasks.context, make_one, share, share->work->count);
    tasks.finish(tasks.context);
    return end_telling(share, share->work->count);
}

pir_status pir_blocks_make(const pir_block_makers *makers, const pir_block_work *work) {
    struct block_share share = {.makers = makers, .work = work, .teller = pthread_self()};
    atomic_init(&share.failure, PIR_OK);
    atomic_init(&share.done, 0);
    return makers->ranks && makers->ranks->count > 1 ? make_dealt_blocks(&share) : make_own_blocks(&share);
}

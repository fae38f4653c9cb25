/* SPDX-License-Identifier: MIT */
/*
 * An allocator that keeps what is released for the next block of its size, so that small objects which come and go ask
 * its base for nothing. Large blocks go to the base. Threads may use it at once.
 */
#ifndef PIR_SCENE_WORLD_BLOCKS_H
#define PIR_SCENE_WORLD_BLOCKS_H

#include <pthread.h>

#include <pirouette/base.h>

/* Blocks are kept in classes of whole lines of a cache. */
#define PIR_BLOCK_CLASSES 48

typedef struct pir_free_block {
    struct pir_free_block *next;
} pir_free_block;

typedef struct pir_blocks {
    pir_allocator base;
    pthread_mutex_t mutex;
    pir_free_block *unused[PIR_BLOCK_CLASSES];
} pir_blocks;

/* Made where it stands: its address is the context of its allocator. */
void pir_blocks_init(pir_blocks *blocks, const pir_allocator *base);

/* Every block has been released by now. */
void pir_blocks_finish(pir_blocks *blocks);

pir_allocator pir_blocks_allocator(pir_blocks *blocks);

#endif

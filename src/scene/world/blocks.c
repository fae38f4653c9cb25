/* SPDX-License-Identifier: MIT */
/* An allocator that keeps what is released: see blocks.h. */
#include "scene/world/blocks.h"

#include <string.h>

/* Sizes in one class. */
#define LINE 64

/* The class of a size; PIR_BLOCK_CLASSES of one that is not kept. */
static size_t class_of(size_t size) {
    const size_t class = (size - 1) / LINE;
    return class < PIR_BLOCK_CLASSES ? class : PIR_BLOCK_CLASSES;
}

static void *take(pir_blocks *blocks, size_t size) {
    const size_t class = class_of(size);
    if (class == PIR_BLOCK_CLASSES)
        return blocks->base.resize(blocks->base.context, NULL, 0, size);
    pir_free_block *block = blocks->unused[class];
    if (!block)
        return blocks->base.resize(blocks->base.context, NULL, 0, (class + 1) * LINE);
    blocks->unused[class] = block->next;
    return block;
}

static void give_back(pir_blocks *blocks, void *block, size_t size) {
    const size_t class = class_of(size);
    if (class == PIR_BLOCK_CLASSES) {
        blocks->base.resize(blocks->base.context, block, size, 0);
        return;
    }
    pir_free_block *kept = block;
    kept->next = blocks->unused[class];
    blocks->unused[class] = kept;
}

/* A block of another class, with what fits of the old one. */
static void *change(pir_blocks *blocks, void *block, size_t old_size, size_t new_size) {
    void *given = take(blocks, new_size);
    if (given) {
        memcpy(given, block, old_size < new_size ? old_size : new_size);
        give_back(blocks, block, old_size);
    }
    return given;
}

static void *resize(void *context, void *block, size_t old_size, size_t new_size) {
    pir_blocks *blocks = context;
    void *given = NULL;
    pthread_mutex_lock(&blocks->mutex);
    if (!block)
        given = take(blocks, new_size);
    else if (new_size == 0)
        give_back(blocks, block, old_size);
    else if (class_of(old_size) == class_of(new_size) && class_of(new_size) < PIR_BLOCK_CLASSES)
        given = block;
    else
        given = change(blocks, block, old_size, new_size);
    pthread_mutex_unlock(&blocks->mutex);
    return given;
}

void pir_blocks_init(pir_blocks *blocks, const pir_allocator *base) {
    *blocks = (pir_blocks){.base = *base};
    pthread_mutex_init(&blocks->mutex, NULL);
}

void pir_blocks_finish(pir_blocks *blocks) {
    for (size_t class = 0; class < PIR_BLOCK_CLASSES; class ++)
        while (blocks->unused[class]) {
            pir_free_block *block = blocks->unused[class];
            blocks->unused[class] = block->next;
            blocks->base.resize(blocks->base.context, block, (class + 1) * LINE, 0);
        }
    pthread_mutex_destroy(&blocks->mutex);
}

pir_allocator pir_blocks_allocator(pir_blocks *blocks) {
    return (pir_allocator){resize, blocks};
}

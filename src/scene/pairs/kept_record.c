/* SPDX-License-Identifier: MIT */
/* The pool of what pairs keep: see kept_record.h. */
#include "scene/pairs/kept_record.h"

/* The class whose room holds so many contacts. */
static int class_of(uint32_t contacts) {
    int class = 0;
    for (uint32_t room = 0; room<contacts; room = room> 0 ? 2 * room : 4)
        class ++;
    return class;
}

static uint32_t room_of(int class) {
    return class > 0 ? (uint32_t)2 << class : 0;
}

static size_t bytes_of(uint32_t room) {
    return sizeof(pir_kept_record) + room * sizeof(pir_kept_contact);
}

void pir_kept_pool_finish(pir_kept_pool *pool, const pir_allocator *allocator) {
    for (int class = 0; class < PIR_KEPT_CLASSES; class ++)
        while (pool->unused[class]) {
            pir_kept_record *record = pool->unused[class];
            pool->unused[class] = record->next;
            pir_memory_free(allocator, record, bytes_of(record->room), 1);
        }
}

pir_kept_record *pir_kept_pool_take(pir_kept_pool *pool, const pir_allocator *allocator, uint32_t contacts) {
    const int class = class_of(contacts);
    if (class >= PIR_KEPT_CLASSES)
        return NULL;
    pir_kept_record *record = pool->unused[class];
    if (record)
        pool->unused[class] = record->next;
    else
        record = pir_memory_new(allocator, bytes_of(room_of(class)), 1);
    if (record)
        *record = (pir_kept_record){.room = room_of(class)};
    return record;
}

void pir_kept_pool_give(pir_kept_pool *pool, pir_kept_record *record) {
    if (!record)
        return;
    const int class = class_of(record->room);
    record->next = pool->unused[class];
    pool->unused[class] = record;
}

/* SPDX-License-Identifier: MIT */
/* Scratch and its rooms: see scratch.h. */
#include "base/scratch.h"

#include "base/memory.h"

pir_scratch *pir_scratch_new(const pir_allocator *allocator) {
    pir_scratch *scratch = PIR_ZEROED(allocator, pir_scratch, 1);
    if (!scratch)
        return NULL;
    scratch->allocator = *allocator;
    scratch->references = 1;
    return scratch;
}

pir_scratch *pir_scratch_retain(pir_scratch *scratch) {
    scratch->references++;
    return scratch;
}

void pir_scratch_release(pir_scratch *scratch) {
    if (!scratch || --scratch->references > 0)
        return;
    const pir_allocator allocator = scratch->allocator;
    for (int kind = 0; kind < PIR_ROOM_KINDS; kind++)
        if (scratch->room[kind])
            scratch->destroy[kind](scratch->room[kind], &allocator);
    PIR_FREE(&allocator, scratch, 1);
}

void *pir_scratch_room(pir_scratch *scratch, pir_room_kind kind, size_t size,
                       void (*destroy)(void *room, const pir_allocator *allocator)) {
    if (!scratch->room[kind]) {
        scratch->room[kind] = pir_memory_zeroed(&scratch->allocator, 1, size);
        scratch->destroy[kind] = destroy;
    }
    return scratch->room[kind];
}

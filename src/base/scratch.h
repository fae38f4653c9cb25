/* SPDX-License-Identifier: MIT */
/*
 * Scratch: what the objects of one thread work in, one after the other. It holds nothing that an object needs to keep
 * from call to call, or only what the object makes again when another has used the scratch in between.
 *
 * Each part of the library has a room of its own there, made when it is first asked for. Sums, and what stands on them,
 * hold references, so scratch is there as long as they are.
 *
 * Scratch belongs to one thread at a time, with all objects that use it.
 */
#ifndef PIR_BASE_SCRATCH_H
#define PIR_BASE_SCRATCH_H

#include <pirouette/base.h>

/* Whose room it is. */
typedef enum pir_room_kind {
    PIR_ROOM_SUM = 0,
    PIR_ROOM_QUERY,
    PIR_ROOM_SURFACE,
    PIR_ROOM_KINDS,
} pir_room_kind;

typedef struct pir_scratch {
    pir_allocator allocator;
    uint32_t references;
    void *room[PIR_ROOM_KINDS];
    void (*destroy[PIR_ROOM_KINDS])(void *room, const pir_allocator *allocator);
} pir_scratch;

/* The head of a pir_workspace. */
typedef struct pir_workspace_head {
    pir_scratch *scratch;
} pir_workspace_head;

/* Empty scratch with one reference; NULL when out of memory. */
pir_scratch *pir_scratch_new(const pir_allocator *allocator);

pir_scratch *pir_scratch_retain(pir_scratch *scratch);

/* Gives a reference back; with the last one the rooms are destroyed. NULL is accepted. */
void pir_scratch_release(pir_scratch *scratch);

/* The room of a kind: of `size` bytes, zeroed when it is made. NULL when out of memory. */
void *pir_scratch_room(pir_scratch *scratch, pir_room_kind kind, size_t size,
                       void (*destroy)(void *room, const pir_allocator *allocator));

#endif

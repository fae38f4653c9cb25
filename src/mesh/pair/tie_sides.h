/* SPDX-License-Identifier: MIT */
/*
 * Very many pairs of triangles may be exactly as near because they share the two nearest vertices, a of P and b of Q:
 * as many as the triangles around one times those around the other. No two triangles are nearer whose corners lie
 * behind a, seen from b, and behind b, seen from a: planes across the way from b to a part them by as much. So of
 * items that lie behind only the numbers count.
 */
#ifndef PIR_MESH_PAIR_TIE_SIDES_H
#define PIR_MESH_PAIR_TIE_SIDES_H

#include "mesh/pair/mesh_frame.h"

/* Begins as zeros, and is cleared for each pose. */
typedef struct pir_tie_sides {
    bool made;
    uint32_t vertex[2];    /* a and b */
    uint8_t *is_behind[2]; /* per item of both trees: whether all triangles below lie behind, exactly */
} pir_tie_sides;

/* Finds out for all items. O(n). False when out of memory. */
bool pir_tie_sides_make(pir_tie_sides *sides, pir_mesh_frame *frame, const pir_allocator *allocator,
                        const uint32_t vertex[2]);
size_t pir_tie_sides_bytes(const pir_tie_sides *sides, const pir_mesh_frame *frame);
void pir_tie_sides_finish(pir_tie_sides *sides, const pir_mesh_frame *frame, const pir_allocator *allocator);

#endif

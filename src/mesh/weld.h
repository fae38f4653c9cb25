/* SPDX-License-Identifier: MIT */
/* Shared features of triangles: vertices at one place, edges, and the parts that vertices join. */
#ifndef PIR_MESH_WELD_H
#define PIR_MESH_WELD_H

#include "base/memory.h"
#include "base/vec.h"

/* Writes to same[v] the lowest number of a vertex at the place of v. Expected O(n). False when out of memory. */
bool pir_weld_vertices(const pir_allocator *allocator, const pir_vec3 *vertex, uint32_t count, uint32_t *same);

/* Whether every edge, whichever way round, is on an even number of triangles. False when out of memory. */
bool pir_weld_is_closed(const pir_allocator *allocator, const uint32_t (*corner)[3], uint32_t count, bool *ret_closed);

/* Makes part[v] the lowest vertex that v hangs together with by the triangles item[0 .. count). */
void pir_weld_parts(uint32_t *part, uint32_t vertex_count, const uint32_t (*corner)[3], const uint32_t *item,
                    uint32_t count);

#endif

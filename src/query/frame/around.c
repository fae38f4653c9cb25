/* SPDX-License-Identifier: MIT */
/* Edges around vertices and sides around facets: see around.h. */
#include "query/frame/around.h"

#include "base/vec.h"

/* Blocks begin where no vector load crosses a line of the cache. */
#define AROUND_ALIGNMENT 32

/* The blocks that so many take. */
static uint32_t blocks_of(uint32_t count) {
    return (count + 3) / 4;
}

/* The most that lie between two successive starts. */
static uint32_t most_between(const uint32_t *start, uint32_t count) {
    uint32_t most = 0;
    for (uint32_t i = 0; i < count; i++)
        most = start[i + 1] - start[i] > most ? start[i + 1] - start[i] : most;
    return most;
}

static void set_blocks(const pir_polytope *p, pir_around *around) {
    around->ring_blocks = blocks_of(most_between(p->ring_start, p->vertex_count));
    around->side_blocks = blocks_of(most_between(p->loop_start, p->facet_count));
}

/* The doubles of both, with room to begin at a multiple of the alignment. */
static size_t doubles_of(const pir_polytope *p, const pir_around *around) {
    size_t rings = (size_t)p->vertex_count * around->ring_blocks, sides = (size_t)p->facet_count * around->side_blocks;
    return (rings * sizeof(pir_fours) + sides * sizeof(pir_sides) + AROUND_ALIGNMENT) / sizeof(double);
}

bool pir_around_has(const pir_polytope *p) {
    pir_around around;
    if (p->dimension < 3 || p->vertex_count > PIR_AROUND_VERTICES)
        return false;
    set_blocks(p, &around);
    return around.ring_blocks <= PIR_AROUND_BLOCKS && around.side_blocks <= PIR_AROUND_BLOCKS;
}

static const pir_vec3 nothing = {NAN, NAN, NAN};

static void put(pir_fours *fours, uint32_t i, pir_vec3 v) {
    fours->x[i] = v.x;
    fours->y[i] = v.y;
    fours->z[i] = v.z;
}

static void fill_rings(const pir_polytope *p, uint32_t blocks, pir_fours *rings) {
    for (uint32_t v = 0; v < p->vertex_count; v++)
        for (uint32_t i = 0; i < 4 * blocks; i++) {
            uint32_t half = p->ring_start[v] + i;
            put(&rings[v * blocks + i / 4], i % 4, half < p->ring_start[v + 1] ? p->direction[half] : nothing);
        }
}

static void fill_sides(const pir_polytope *p, const pir_vec3 *vertex, uint32_t blocks, pir_sides *sides) {
    for (uint32_t f = 0; f < p->facet_count; f++)
        for (uint32_t i = 0; i < 4 * blocks; i++) {
            pir_sides *to = &sides[f * blocks + i / 4];
            uint32_t start = p->loop_start[f];
            bool is_one = start + i < p->loop_start[f + 1];
            uint32_t half = p->loop[is_one ? start + i : start];
            put(&to->in, i % 4, is_one ? pir_vec_cross(p->normal[f], p->direction[half]) : nothing);
            put(&to->from, i % 4, vertex[p->origin[half]]);
        }
}

bool pir_around_make(const pir_polytope *p, const pir_vec3 *vertex, pir_around *around) {
    set_blocks(p, around);
    around->memory = PIR_NEW(&p->allocator, double, doubles_of(p, around));
    if (!around->memory)
        return false;
    uintptr_t begin = ((uintptr_t)around->memory + AROUND_ALIGNMENT - 1) / AROUND_ALIGNMENT * AROUND_ALIGNMENT;
    pir_fours *rings = (pir_fours *)begin;
    pir_sides *sides = (pir_sides *)(rings + (size_t)p->vertex_count * around->ring_blocks);
    fill_rings(p, around->ring_blocks, rings);
    fill_sides(p, vertex, around->side_blocks, sides);
    around->rings = rings;
    around->sides = sides;
    return true;
}

void pir_around_free(const pir_polytope *p, pir_around *around) {
    if (around->memory)
        PIR_FREE(&p->allocator, around->memory, doubles_of(p, around));
}

/* SPDX-License-Identifier: MIT */
/*
 * Parallel directions by a table of places: directions without their signs, rounded, lead to the first of their kind,
 * and integers prove it.
 */
#include "motion/parallels.h"

#include "base/memory.h"
#include "base/vec.h"

/* Directions are rounded to multiples of this. */
#define CELL 0x1p-28

struct place_table {
    uint32_t *place; /* a direction plus 1, or 0 */
    uint32_t size;   /* a power of two, more than there are directions */
    pir_limbs scratch;
};

/* Whether the cross product of two vectors is zero. */
static bool are_parallel(const pir_int3 *a, const pir_int3 *b, pir_limbs *scratch) {
    const uint32_t mark = scratch->used;
    bool parallel = true;
    for (int k = 0; k < 3 && parallel; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        pir_int left = pir_limbs_take(scratch, pir_int_length(&a->c[i]) + pir_int_length(&b->c[j]));
        pir_int right = pir_limbs_take(scratch, pir_int_length(&a->c[j]) + pir_int_length(&b->c[i]));
        pir_int difference = pir_limbs_take(scratch, (left.room > right.room ? left.room : right.room) + 1);
        pir_int_mul(&left, &a->c[i], &b->c[j]);
        pir_int_mul(&right, &a->c[j], &b->c[i]);
        pir_int_sub(&difference, &left, &right);
        parallel = difference.size == 0;
        scratch->used = mark;
    }
    return parallel;
}

static uint32_t hash_of(pir_vec3 v) {
    const double first = fabs(v.x) > 0.1 ? v.x : fabs(v.y) > 0.1 ? v.y : v.z, sign = first < 0 ? -1 : 1;
    const int64_t x = (int64_t)floor(v.x * sign / CELL + 0.5), y = (int64_t)floor(v.y * sign / CELL + 0.5),
                  z = (int64_t)floor(v.z * sign / CELL + 0.5);
    const uint64_t mixed = (uint64_t)x * UINT64_C(0x9e3779b97f4a7c15) ^ (uint64_t)y * UINT64_C(0xc2b2ae3d27d4eb4f) ^
                           (uint64_t)z * UINT64_C(0x165667b19e3779f9);
    return (uint32_t)((mixed ^ mixed >> 29) * UINT64_C(0xbf58476d1ce4e5b9) >> 32);
}

/* The first direction parallel to number `i`, which is entered where there is none. */
static uint32_t find_parallel(struct place_table *table, const pir_vectors *exact, uint32_t i, pir_vec3 v) {
    const pir_int3 own = pir_vectors_at(exact, i);
    for (uint32_t at = hash_of(v) & (table->size - 1);; at = (at + 1) & (table->size - 1)) {
        if (table->place[at] == 0) {
            table->place[at] = i + 1;
            return i;
        }
        const pir_int3 other = pir_vectors_at(exact, table->place[at] - 1);
        if (are_parallel(&own, &other, &table->scratch))
            return table->place[at] - 1;
    }
}

static void clear(struct place_table *table) {
    for (uint32_t i = 0; i < table->size; i++)
        table->place[i] = 0;
}

static void find_all(pir_parallels *parallels, const pir_polytope *p, struct place_table *table) {
    clear(table);
    for (uint32_t f = 0; f < p->facet_count; f++) {
        const uint32_t first = find_parallel(table, &p->exact_normal, f, p->normal[f]);
        parallels->normal[f] = 2 * first + (pir_vec_dot(p->normal[first], p->normal[f]) < 0);
    }
    clear(table);
    for (uint32_t e = 0; e < p->edge_count; e++) {
        const pir_vec3 v = p->direction[p->edge_half[e]];
        const uint32_t first = find_parallel(table, &p->exact_edge, e, v);
        parallels->edge[e] = 2 * first + (pir_vec_dot(p->direction[p->edge_half[first]], v) < 0);
    }
}

bool pir_parallels_init(pir_parallels *parallels, const pir_polytope *p, const pir_allocator *allocator) {
    struct place_table table = {.size = 2};
    while (table.size <= p->edge_count + p->edge_count / 2)
        table.size *= 2;
    const uint32_t longest =
        p->exact_edge.stride > p->exact_normal.stride ? p->exact_edge.stride : p->exact_normal.stride;
    const uint32_t limbs = 6 * longest + 1;
    mp_limb_t *base = PIR_NEW(allocator, mp_limb_t, limbs);
    table.place = PIR_NEW(allocator, uint32_t, table.size);
    table.scratch = (pir_limbs){base, 0, limbs};
    *parallels =
        (pir_parallels){PIR_NEW(allocator, uint32_t, p->facet_count), PIR_NEW(allocator, uint32_t, p->edge_count)};
    const bool made = base && table.place && parallels->normal && parallels->edge;
    if (made)
        find_all(parallels, p, &table);
    else
        pir_parallels_finish(parallels, p, allocator);
    PIR_FREE(allocator, table.place, table.size);
    PIR_FREE(allocator, base, limbs);
    return made;
}

void pir_parallels_finish(pir_parallels *parallels, const pir_polytope *p, const pir_allocator *allocator) {
    PIR_FREE(allocator, parallels->normal, p->facet_count);
    PIR_FREE(allocator, parallels->edge, p->edge_count);
    *parallels = (pir_parallels){NULL, NULL};
}

/* SPDX-License-Identifier: MIT */
/* See intern.h. Open addressing; the table is at most half full.  */
#include "solid/space/intern.h"

#include <string.h>

#include "solid/space/exact.h"

void pir_intern_init(pir_intern *table, pir_space *space, uint32_t numbers) {
    *table = (pir_intern){.space = space, .numbers = numbers};
}

void pir_intern_finish(pir_intern *table) {
    if (!table->space)
        return;
    pir_space_shrink(table->space, table->slot, table->slot_room, sizeof *table->slot);
    pir_space_shrink(table->space, table->first, table->first_room, sizeof *table->first);
    pir_space_shrink(table->space, table->value, table->value_room, sizeof *table->value);
    *table = (pir_intern){0};
}

void pir_intern_clear(pir_intern *table) {
    if (table->count > 0)
        memset(table->slot, 0, table->slot_room * sizeof *table->slot);
    table->count = 0;
}

static uint64_t hash_of(const pir_intern *table, uint32_t first) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint32_t k = 0; k < table->numbers; k++) {
        mpz_srcptr z = table->space->number[first + k];
        hash = (hash ^ (uint64_t)mpz_sgn(z)) * 0x100000001b3u;
        for (size_t i = 0; i < mpz_size(z); i++)
            hash = (hash ^ mpz_getlimbn(z, (mp_size_t)i) ^ hash >> 29) * 0x9e3779b97f4a7c15u;
    }
    return hash ^ hash >> 32;
}

static bool same(const pir_intern *table, uint32_t a, uint32_t b) {
    for (uint32_t k = 0; k < table->numbers; k++)
        if (mpz_cmp(table->space->number[a + k], table->space->number[b + k]) != 0)
            return false;
    return true;
}

/* Where the entry with these numbers is, or an empty slot for it. */
static uint32_t find(const pir_intern *table, uint32_t first) {
    uint32_t at = (uint32_t)hash_of(table, first) & (table->slot_room - 1);
    while (table->slot[at] && !same(table, table->first[table->slot[at] - 1], first))
        at = (at + 1) & (table->slot_room - 1);
    return at;
}

/* Twice the slots, a power of two. */
static void widen(pir_intern *table) {
    pir_space *space = table->space;
    const uint32_t room = table->slot_room ? 2 * table->slot_room : 64;
    uint32_t *slot = PIR_ZEROED(&space->allocator, uint32_t, room);
    if (!slot) {
        space->status = PIR_ERR_MEMORY;
        return;
    }
    pir_space_shrink(space, table->slot, table->slot_room, sizeof *table->slot);
    table->slot = slot;
    table->slot_room = room;
    for (uint32_t e = 0; e < table->count; e++)
        table->slot[find(table, table->first[e])] = e + 1;
}

uint32_t pir_intern_add(pir_intern *table, uint32_t first, uint32_t value) {
    pir_space *space = table->space;
    if (2 * (table->count + 1) > table->slot_room)
        widen(table);
    if (!pir_space_grow(space, (void **)&table->first, &table->first_room, table->count, sizeof *table->first) ||
        !pir_space_grow(space, (void **)&table->value, &table->value_room, table->count, sizeof *table->value))
        return 0;
    const uint32_t at = find(table, first);
    if (!table->slot[at]) {
        table->first[table->count] = first;
        table->value[table->count] = value;
        table->slot[at] = ++table->count;
    }
    return table->value[table->slot[at] - 1];
}

uint32_t pir_intern_point(pir_intern *table, uint32_t point) {
    const uint32_t exact = pir_space_exact_point(table->space, point);
    return table->space->status == PIR_OK ? pir_intern_add(table, exact, point) : 0;
}

uint32_t pir_intern_half(pir_intern *table, uint32_t half) {
    pir_space *space = table->space;
    const uint32_t exact = pir_space_exact_plane(space, half >> 1), key = pir_space_numbers(space, 4);
    if (space->status != PIR_OK)
        return 0;
    int sign = 0;
    for (uint32_t k = 0; k < 3 && sign == 0; k++)
        sign = mpz_sgn(space->number[exact + k]);
    for (uint32_t k = 0; k < 4; k++) {
        mpz_set(space->number[key + k], space->number[exact + k]);
        if (sign < 0)
            mpz_neg(space->number[key + k], space->number[key + k]);
    }
    // the value is the half-space that faces the way of the key
    const uint32_t away = sign < 0;
    return pir_intern_add(table, key, half ^ (half & 1) ^ away) ^ (half & 1) ^ away;
}

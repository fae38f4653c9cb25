/* SPDX-License-Identifier: MIT */
/* Equal points and planes under one number: a hash table over their exact numbers in lowest terms. */
#ifndef PIR_SOLID_SPACE_INTERN_H
#define PIR_SOLID_SPACE_INTERN_H

#include <stdint.h>

typedef struct pir_space pir_space;

typedef struct pir_intern {
    pir_space *space;
    uint32_t count, slot_room;
    uint32_t *slot;          /* entry + 1, or 0 */
    uint32_t *first, *value; /* per entry: its numbers, what it stands for */
    uint32_t first_room, value_room;
    uint32_t numbers; /* how many make an entry */
} pir_intern;

/* A table of entries of `numbers` numbers each. */
void pir_intern_init(pir_intern *table, pir_space *space, uint32_t numbers);
void pir_intern_finish(pir_intern *table);

/* Takes all entries out. */
void pir_intern_clear(pir_intern *table);

/* The value of the entry with the numbers from `first` on, which are kept; `value` becomes that of a new entry. */
uint32_t pir_intern_add(pir_intern *table, uint32_t first, uint32_t value);

/* The first point added to the table that is equal to this one. */
uint32_t pir_intern_point(pir_intern *table, uint32_t point);

/* The first half-space added with the same plane, turned where that one faces the other way. */
uint32_t pir_intern_half(pir_intern *table, uint32_t half);

#endif

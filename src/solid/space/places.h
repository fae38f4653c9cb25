/* SPDX-License-Identifier: MIT */
/*
 * Equal points, planes and lines of a space under one number: a table by where they are, as doubles have it. Two whose
 * places may be one are told apart, or are proven equal, by what they are at rest (identity.h), else by exact numbers.
 * So nothing that is far from all others has exact numbers made.
 *
 * Invariant: an entry is in the table at its place, within its error; entries at one place are equal to none before.
 */
#ifndef PIR_SOLID_SPACE_PLACES_H
#define PIR_SOLID_SPACE_PLACES_H

#include "solid/space/space.h"

typedef struct pir_places_entry {
    double x[3], err;
    uint32_t of[2]; /* a point; a half-space; the two planes of a line */
    uint32_t next;  /* of the same slot, or none */
} pir_places_entry;

typedef struct pir_places {
    pir_space *space;
    pir_places_entry *entry;
    uint32_t count, room;
    uint32_t *slot, slot_room; /* the entry added last of those with one hash, or none */
    bool by_numbers;           /* whether two were one by exact numbers alone, which may end with this rotation */
} pir_places;

void pir_places_init(pir_places *table, pir_space *space);
void pir_places_finish(pir_places *table);

/* Takes all entries out. */
void pir_places_clear(pir_places *table);

/* The first point added that is equal to this one. */
uint32_t pir_places_point(pir_places *table, uint32_t point);

/* The first half-space added with the same plane, turned where that one faces the other way. */
uint32_t pir_places_half(pir_places *table, uint32_t half);

/* Whether two planes are one, either way; and whether two that are one face the same way. */
bool pir_planes_are_one(pir_space *space, uint32_t f, uint32_t g);
bool pir_planes_face_one_way(const pir_space *space, uint32_t f, uint32_t g);

/* The line where two planes that are not parallel meet: the same number for the same line, counted from 0. */
uint32_t pir_places_line(pir_places *table, uint32_t f, uint32_t g);

#endif

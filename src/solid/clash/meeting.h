/* SPDX-License-Identifier: MIT */
/*
 * Convex polytopes that meet in one space, as cells (cells.h).
 *
 * Invariants: coordinates are those of the polytopes times one integer, the scale, so that all are integers. Cells are
 * never changed: a cut makes new ones. Lists of cells have disjoint insides where they are made by taking away.
 */
#ifndef PIR_SOLID_CLASH_MEETING_H
#define PIR_SOLID_CLASH_MEETING_H

#include <pirouette/exact.h>
#include <pirouette/polytope.h>

#include "solid/pieces/decompose.h"

typedef struct pir_cell_meeting {
    pir_space space;
    pir_cells cells;
    mpz_t scale;      /* a coordinate in the space over the polytope's */
    uint32_t *corner; /* scratch: the corners of a facet; the points that two cells have in common */
    uint32_t corner_room, common_count;
} pir_cell_meeting;

/* The most that coordinates of polytopes are multiplied by to be integers, their least common denominator, made a
 * common multiple of *scale. */
void pir_meeting_scale(const pir_polytope *polytope, mpz_t scale);

/* The bits of the longest coordinate of a polytope times a scale. */
size_t pir_meeting_bits(const pir_polytope *polytope, const mpz_t scale);

/* A space for polytopes whose denominators divide the scale and whose coordinates then have so many bits. The meeting
 * stays where it is. */
void pir_meeting_init(pir_cell_meeting *meeting, const pir_allocator *allocator, size_t limit, const mpz_t scale,
                      size_t bits);
void pir_meeting_finish(pir_cell_meeting *meeting);

/* The cell of a polytope of dimension 3. */
uint32_t pir_meeting_add(pir_cell_meeting *meeting, const pir_polytope *polytope);

/* The dimension of what two cells have in common: −1 where that is nothing, 3 where their insides meet. */
int pir_meeting_common(pir_cell_meeting *meeting, uint32_t a, uint32_t b);

/* Adds to `left` what cell `by` leaves of a cell; the part that both have in common, or none where that has no inside.
 */
uint32_t pir_meeting_take(pir_cell_meeting *meeting, uint32_t cell, uint32_t by, pir_piece_list *left);

/* Takes away cell `by` from all cells of *list, with *other for scratch; adds the volume taken to `taken`, unless that
 * is NULL. */
void pir_meeting_take_all(pir_cell_meeting *meeting, pir_piece_list *list, pir_piece_list *other, uint32_t by,
                          mpq_ptr taken);

/* Adds the volume of a cell, in units of the polytopes. */
void pir_meeting_add_volume(pir_cell_meeting *meeting, uint32_t cell, mpq_t volume);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The two predicates of building and overlaying maps: on which side of a line a direction is, and which of two
 * directions on a line comes first. Both are signs of integers. A double filter on unit vectors, each with a bound on
 * its error, decides nearly all of them.
 */
#ifndef PIR_CGM_SIDES_H
#define PIR_CGM_SIDES_H

#include "cgm/cgm.h"

/* Room for exact answers, and counters. */
struct pir_cgm_sides {
    pir_limbs scratch;
    uint64_t by_filter, by_exact;
};

/* Room for questions between maps `a` and `b`, which may be the same; false when out of memory. */
bool pir_cgm_sides_init(struct pir_cgm_sides *sides, const pir_allocator *allocator, const pir_cgm *a,
                        const pir_cgm *b);
void pir_cgm_sides_finish(struct pir_cgm_sides *sides, const pir_allocator *allocator);

/* 1 when `point` of map b is left of signed line `line` of map a, −1 when right of it, 0 when on it. */
int pir_cgm_side(struct pir_cgm_sides *sides, const pir_cgm *a, uint32_t line, const pir_cgm *b,
                 const struct pir_cgm_point *point);

/* For x of map b and y of map c, less than 180° apart on signed line `line` of a: 1 when y is ahead of x, −1
   when behind, 0 when equal. */
int pir_cgm_ahead(struct pir_cgm_sides *sides, const pir_cgm *a, uint32_t line, const pir_cgm *b,
                  const struct pir_cgm_point *x, const pir_cgm *c, const struct pir_cgm_point *y);

/* Whether two signed lines that lie in one plane point the same way. */
bool pir_cgm_same_way(const pir_cgm *a, uint32_t line, const pir_cgm *b, uint32_t other);

/* The direction (signed line a) × (signed line b) of map `cgm`, which are not collinear. */
struct pir_cgm_point pir_cgm_meet(const pir_cgm *cgm, uint32_t a, uint32_t b);

/* The signed line exactly, borrowed or in scratch. */
pir_int3 pir_cgm_line_exact(const pir_cgm *cgm, uint32_t line, pir_limbs *scratch);

/* The direction exactly, of any length, borrowed or in scratch. */
pir_int3 pir_cgm_point_exact(const pir_cgm *cgm, const struct pir_cgm_point *point, pir_limbs *scratch);

/* Limbs of a direction's longest component. */
uint32_t pir_cgm_point_limbs(const pir_cgm *cgm);

#endif

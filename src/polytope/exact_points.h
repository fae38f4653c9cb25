/* SPDX-License-Identifier: MIT */
/* Points as integers on one scale: what a hull is built from. */
#ifndef PIR_POLYTOPE_EXACT_POINTS_H
#define PIR_POLYTOPE_EXACT_POINTS_H

#include <gmp.h>

#include "exact/vectors.h"

/*
 * The most bits of a coordinate as an integer, and of either number of the scale; what is longer is refused with
 * PIR_ERR_LIMIT. Doubles take 2098 bits at most. So no sum of lengths that a reservation is derived from comes near
 * 2^32 limbs.
 */
#define PIR_COORDINATE_BITS_MAX 131072u
#define PIR_SCALE_BITS_MAX      65536u

struct pir_exact_points {
    pir_vectors vectors;
    pir_scale scale;
};

/* The points are finite, `count` > 0 and below 2^30. PIR_ERR_MEMORY, PIR_ERR_LIMIT (numbers too
   long), with *exact empty. */
pir_status pir_exact_points_of_doubles(struct pir_exact_points *exact, const pir_vec3 *points, size_t count,
                                       const pir_allocator *allocator);
pir_status pir_exact_points_of_rationals(struct pir_exact_points *exact, const mpq_t *coordinates, size_t count,
                                         const pir_allocator *allocator);
void pir_exact_points_finish(struct pir_exact_points *exact, const pir_allocator *allocator);

#endif

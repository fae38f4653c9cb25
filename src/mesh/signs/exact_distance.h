/* SPDX-License-Identifier: MIT */
/*
 * The square of the distance of two triangles as a rational number, from integer coordinates on one scale. It is
 * the least over pairs of features whose nearest points are within both: vertices, a vertex and an edge, two
 * edges, a vertex and a face; and 0 where an edge goes through a face. A triangle may be a point three times.
 */
#ifndef PIR_MESH_SIGNS_EXACT_DISTANCE_H
#define PIR_MESH_SIGNS_EXACT_DISTANCE_H

#include "mesh/signs/mesh_numbers.h"

/* num / den, den > 0. Its owner has given each PIR_EXACT_SQUARE_LIMBS of room. */
typedef struct pir_exact_square {
    pir_int num, den;
} pir_exact_square;

/* Limbs of the num and of the den of a square, from coordinates of `limbs` limbs; and limbs that the computation needs
 * on its stack, where pairs of features are tried one after the other, none of which takes 250 coordinates. */
#define PIR_EXACT_SQUARE_LIMBS(limbs) (6 * (limbs) + 24)
#define PIR_EXACT_WORK_LIMBS(limbs)   (280 * (limbs) + 1000)

void pir_exact_distance(pir_limbs *limbs, const pir_int3 a[3], const pir_int3 b[3], pir_exact_square *ret_square);

/* The sign of a − b. */
int pir_exact_square_order(pir_limbs *limbs, const pir_exact_square *a, const pir_exact_square *b);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The incremental grid of all rotations: circles of rotations over the pixels of a HEALPix map.
 *
 * A unit quaternion is a pair of complex numbers a = w + x·i, b = y + z·i. The Hopf map takes it to the point of the
 * sphere with cosine of colatitude |a|² − |b|² and longitude arg b − arg a; the quaternions over one point are
 * e^{iψ/2}·(a, b), so they make a circle, and go along it by turns about the axis x of the frame that does not turn.
 * The grid has, over each pixel's centre (θ, φ), the rotations
 *
 *     a = cos(θ/2)·e^{iψ/2},   b = sin(θ/2)·e^{i(φ + ψ/2)},   ψ = (k + ½)/m of a full turn, k = 0 … m − 1,
 *
 * with m = 6·2^level. The Hopf map lengthens no way: two rotations differ by at least the angle between their points.
 *
 * Order. A pixel's rotations are visited round the circle, all m of them, either way. The first is the one nearest to
 * the last of the pixel before; of the two ways round, the one that ends nearer to the next circle is taken. `run`
 * keeps both of each pixel. So m − 1 of m steps are equal turns about x.
 */
#ifndef PIR_CSPACE_GRID_HOPF_H
#define PIR_CSPACE_GRID_HOPF_H

#include <pirouette/base.h>

#include "cspace/grid/near.h"

typedef struct pir_hopf {
    uint32_t level, around; /* m */
    uint32_t pixels;
    double first_cap[3]; /* of seven eighths of the spacing, 1/m of a full turn: cosine, sine, cosine of the half */
    uint32_t *run; /* by rank of the pixel on the path: twice the first number on the circle, plus 1 where they fall */
} pir_hopf;

/* Makes the table of runs; false when out of memory. */
bool pir_hopf_init(pir_hopf *hopf, uint32_t level, const pir_allocator *allocator);
void pir_hopf_finish(pir_hopf *hopf, const pir_allocator *allocator);

pir_quat pir_hopf_rotation(const pir_hopf *hopf, uint64_t number);

/* The nested number of the pixel times m, plus the number on the circle. */
uint64_t pir_hopf_cell(const pir_hopf *hopf, uint64_t number);

/* Fills `near`, which is empty, for a unit quaternion. */
void pir_hopf_nearest(const pir_hopf *hopf, pir_quat unit, pir_near *near);

#endif

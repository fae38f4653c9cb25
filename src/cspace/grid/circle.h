/* SPDX-License-Identifier: MIT */
/* The circle of rotations over one pixel, and the number of one on it: between hopf.c and hopf_nearest.c. */
#ifndef PIR_CSPACE_GRID_CIRCLE_H
#define PIR_CSPACE_GRID_CIRCLE_H

#include "cspace/grid/angle.h"
#include "cspace/grid/hopf.h"
#include "cspace/grid/pixel.h"

typedef struct pir_circle {
    double upper, lower; /* cos θ/2, sin θ/2 */
    uint64_t num, den;   /* φ in parts of a full turn */
    pir_circle_point phi;
} pir_circle;

pir_circle pir_circle_of(uint32_t level, pir_pixel pixel);

/* Rotation k of `around` on a circle. */
pir_quat pir_circle_rotation(const pir_circle *circle, uint32_t around, uint32_t k);

/*
 * The complex number h such that the product of the unit quaternion with the one at ψ is the real part of
 * e^{−iψ/2}·h. Its magnitude is the greatest closeness on the circle.
 */
pir_circle_point pir_circle_product(const pir_circle *circle, pir_quat unit);

/* The rotation on the circle nearest to the quaternion of this product. */
uint32_t pir_circle_nearest(pir_circle_point product, uint32_t around);

/* The number, in the order of visiting, of rotation k over the pixel of a rank on the path. */
uint64_t pir_hopf_number(const pir_hopf *hopf, uint32_t rank, uint32_t k);

#endif

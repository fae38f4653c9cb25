/* SPDX-License-Identifier: MIT */
/*
 * Angles as parts of a full turn, and their sines and cosines, the same bits on every machine.
 *
 * The C library's sin, cos and atan2 differ in their last bits from one to the next. These use +, −, ·, / and √ of
 * doubles alone, which IEEE 754 fixes.
 */
#ifndef PIR_CSPACE_GRID_ANGLE_H
#define PIR_CSPACE_GRID_ANGLE_H

#include <stdbool.h>
#include <stdint.h>

#include <pirouette/base.h>

#define PIR_FULL_TURN 6.28318530717958647692

typedef struct pir_circle_point {
    double cos, sin;
} pir_circle_point;

/*
 * Cosine and sine of num/den of a full turn, each within 2^-52; den is 1 to 2^60. Exact at quarter turns, equal at odd
 * eighths, and of equal magnitude wherever the symmetries of the circle make them so.
 */
pir_circle_point pir_circle_at(uint64_t num, uint64_t den);

/* The part of a full turn, in [0, 1), at which the direction (x, y) lies, within 2^-50; 0 for (0, 0). */
double pir_turn_part(double x, double y);

/* Whether q is finite and not zero. */
bool pir_quat_is_rotation(pir_quat q);

/* A quaternion of any length but 0, finite, as one of length 1 within 2^-50. */
pir_quat pir_quat_unit(pir_quat q);

static inline double pir_quat_dot(pir_quat a, pir_quat b) {
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

#endif

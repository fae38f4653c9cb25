/* SPDX-License-Identifier: MIT */
/*
 * A κ of a turn exactly, with doubles around it: the start, where κ is +∞ and −∞, or the exit root of a
 * quadratic in k = κ·2^-exponent (motion/quadratic.h). And signs of quadratics there.
 *
 * A direction is (s, t) with t ≥ 0 and s/t = κ in units of the power of two just above the longest component of the
 * axis; the longer of s and t is 1 in size. Each is within 2^-46 of the exact one relatively.
 */
#ifndef PIR_CRITICAL_TURN_ANGLE_H
#define PIR_CRITICAL_TURN_ANGLE_H

#include "critical/turned_features.h"

typedef struct pir_turn_direction {
    double s, t;
    bool known; /* else doubles cannot hold it */
} pir_turn_direction;

typedef struct pir_turn_angle {
    bool first;        /* the start */
    mpz_t c[3];        /* else a quadratic whose exit root it is */
    double between[2]; /* κ: the first is not above it, the other one not below */
    pir_turn_direction direction;
} pir_turn_angle;

/* When a sign is meant: at the angle, or a hair after it, where κ is less. */
typedef enum pir_turn_when { PIR_TURN_AT, PIR_TURN_AFTER } pir_turn_when;

void pir_turn_angle_init(pir_turn_angle *angle);
void pir_turn_angle_clear(pir_turn_angle *angle);

/* κ as a double: finite, or INFINITY for the start. */
void pir_turn_angle_at(pir_turn_angle *angle, const pir_turned *turned, double kappa);

/* The κ of a quaternion, which is (u, κ)·q₀ or a multiple. False where it is none: no turn about u from q₀. */
bool pir_turn_angle_of(pir_turn_angle *angle, const pir_turned *turned, pir_quat q, pir_quat start);

/* The exit root of `root`, which has one; `sign` −1 for that of its negative. False where there is none. */
bool pir_turn_angle_root(pir_turn_angle *angle, const pir_turned *turned, mpz_t root[3], int sign);

/* Brings the doubles as near as they can be: one, where κ is a double, else two neighbours. */
void pir_turn_angle_tighten(pir_turn_angle *angle, const pir_turned *turned);

/* The direction of a κ other than 0, from a double within 2^-47 of it; unknown where doubles cannot hold it. */
pir_turn_direction pir_turn_direction_of(const pir_turned *turned, double kappa);

/* The sign of a quadratic. */
int pir_turn_angle_sign(const pir_turn_angle *angle, mpz_t c[3], pir_turn_when when);

/* The quadratic in κ, without a common divisor; not of the start. */
void pir_turn_angle_polynomial(const pir_turn_angle *angle, const pir_turned *turned, mpz_t *ret_coefficients);

/* The sign of κ of a less κ of b, neither the start, by doubles where they tell. */
int pir_turn_angle_order(const pir_turn_angle *a, const pir_turn_angle *b);

#endif

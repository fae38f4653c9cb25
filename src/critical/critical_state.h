/* SPDX-License-Identifier: MIT */
/*
 * States of a translation at an exact angle: signs of slacks by doubles within a bound, then by integers.
 *
 * The bound: a slack is a sum of 12 products of a rounded number (2^-51 off relatively), a component of t or 1, and
 * two components of a direction (2^-46 each). With the rounding of three products and twelve sums it is off by less
 * than 2^-44 of the sum of the sizes of all terms; what is lost below 2^-1000 is, for components of t up to 2^300,
 * below 2^-600.
 */
#ifndef PIR_CRITICAL_CRITICAL_STATE_H
#define PIR_CRITICAL_CRITICAL_STATE_H

#include "critical/critical_map.h"

#define PIR_SLACK_BOUND 0x1p-44
#define PIR_SLACK_LEAST 0x1p-600

/* A translation, in integers too: t = at·2^exponent. */
typedef struct pir_shift {
    pir_vec3 t;
    bool is_small; /* components are at most 2^300 */
    mpz_t at[3];
    int exponent;
} pir_shift;

/* A slack at a facet as a quadratic in a direction: c[0]·s² + c[1]·st + c[2]·t², each within `bound`. */
typedef struct pir_slack_form {
    double c[3], bound[3];
} pir_slack_form;

void pir_shift_init(pir_shift *shift, pir_vec3 t);
void pir_shift_clear(pir_shift *shift);

pir_slack_form pir_slack_form_of(const pir_rounded_plane *plane, pir_vec3 t);

/* The slack as a quadratic in k; `plane` is a life's, made here. */
void pir_slack_exact(const pir_critical_map *map, uint32_t life, const pir_shift *shift, pir_exact_plane *plane,
                     mpz_t dst[3]);

/* The place of an angle. */
pir_critical_place pir_critical_place_of(const pir_critical_map *map, const pir_turn_angle *angle);

/* The state at an angle, or just after it, whose place is `interval`: that after an event. */
pir_state pir_critical_state_at(const pir_critical_map *map, const pir_turn_angle *angle, uint32_t interval,
                                const pir_shift *shift, pir_turn_when when);

#endif

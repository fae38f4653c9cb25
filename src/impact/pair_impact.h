/* SPDX-License-Identifier: MIT */
/* The call of impact.h with that of exact.h, which need one more output. */
#ifndef PIR_IMPACT_PAIR_IMPACT_H
#define PIR_IMPACT_PAIR_IMPACT_H

#include <gmp.h>

#include <pirouette/impact.h>

/* The errors that a motion has of its own. */
pir_status pir_exact_motion_check(const pir_exact_motion *motion);

/* Whether a motion turns and goes: its contacts are roots of cubics. */
bool pir_exact_motion_screws(const pir_exact_motion *motion);

/* As pir_pair_impact_exact, but the κ told is the exit root; `ret_coefficients` may be NULL. */
pir_status pir_pair_impact_run(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                               const pir_exact_motion *motion, pir_exact_impact *ret_impact, mpz_t *ret_coefficients);

#endif

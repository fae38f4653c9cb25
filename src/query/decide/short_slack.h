/* SPDX-License-Identifier: MIT */
/*
 * The exact slack of a facet in integers of fixed length, for bodies and poses as scenes have them: both turned and
 * moved by doubles of like size, coordinates that are doubles.
 *
 * The integers are those of placed.h but for powers of two, and numbers come from them by the same steps, so they have
 * the same bits.
 */
#ifndef PIR_QUERY_DECIDE_SHORT_SLACK_H
#define PIR_QUERY_DECIDE_SHORT_SLACK_H

#include "query/decide/facet.h"

/* The slack and its sign. False where the integers would be too long; then nothing is said. */
bool pir_short_slack(const pir_exact *exact, pir_vec3 translation, const pir_facet *facet, int *ret_sign,
                     double *ret_slack);

#endif

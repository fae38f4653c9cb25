/* SPDX-License-Identifier: MIT */
/* Whether a facet's slack exceeds another's by at most a length, exactly. */
#ifndef PIR_QUERY_DECIDE_WITHIN_H
#define PIR_QUERY_DECIDE_WITHIN_H

#include "query/decide/facet.h"

/*
 * Whether the slack of `facet` is at most that of `least` plus `more`, a length in the unit of the bodies' coordinates,
 * taken exactly. x is outside of neither plane. Where doubles cannot tell and `more` is not 0, the integers are GMP's
 * own, in its memory.
 */
bool pir_facet_within(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, const pir_facet *least,
                      double more);

#endif

/* SPDX-License-Identifier: MIT */
/* Differences without an inside: see flat.c. */
#ifndef PIR_QUERY_DECIDE_FLAT_H
#define PIR_QUERY_DECIDE_FLAT_H

#include "query/decide/line.h"

/* Whether D has no inside. */
bool pir_flat_is(pir_exact *exact);

/* Whether t is in D, given that D has no inside or that t is outside of no piece's plane. */
bool pir_flat_holds(pir_exact *exact, pir_vec3 translation);

/* Where a line from outside enters a flat D. False where it never does. */
bool pir_flat_enter(pir_exact *exact, const pir_line *line, pir_arrival *ret_arrival);

/* A unit vector across the line that D lies on, or any unit vector where D is a point. */
pir_vec3 pir_flat_across(const pir_frame *frame);

#endif

/* SPDX-License-Identifier: MIT */
/* The numbers, points and facets of an answer. */
#ifndef PIR_SOLID_DEPTH_DEPTH_ANSWER_H
#define PIR_SOLID_DEPTH_DEPTH_ANSWER_H

#include <pirouette/solid_query.h>

#include "solid/depth/depth_search.h"

/* The answer whose free place was found: nearest, or along the way of the search. */
pir_status pir_depth_answer(pir_depth_search *search, pir_depth_found found, pir_solid_depth *ret_depth);

#endif

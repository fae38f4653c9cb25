/* SPDX-License-Identifier: MIT */
/* Polytopes of another size. */
#ifndef PIR_POLYTOPE_SCALE_H
#define PIR_POLYTOPE_SCALE_H

#include "polytope/polytope.h"

/*
 * A copy of the polytope with its integers on another scale. PIR_ERR_LIMIT when a coordinate is beyond the doubles,
 * PIR_ERR_MEMORY.
 */
pir_status pir_polytope_rescale(const pir_polytope *polytope, const pir_scale *scale, pir_polytope **ret_polytope);

#endif

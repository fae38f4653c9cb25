/* SPDX-License-Identifier: MIT */
/* The hull of some of a polytope's vertices. */
#ifndef PIR_POLYTOPE_SOME_VERTICES_H
#define PIR_POLYTOPE_SOME_VERTICES_H

#include "polytope/polytope.h"

/*
 * The exact hull of `count` vertices of a polytope, which rise, with its scale and allocator. Sources are those of the
 * polytope; merge bounds are the caller's to set.
 */
pir_status pir_polytope_of_some(const pir_polytope *polytope, const uint32_t *vertices, uint32_t count,
                                pir_polytope **ret_polytope);

#endif

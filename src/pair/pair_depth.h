/* SPDX-License-Identifier: MIT */
/*
 * The depth of a pair that overlaps: the facet of D of least slack at x, proven.
 *
 * Of small bodies all facets that D can have are compared (axes/axes.h). Of others a closed surface of vertex pairs
 * in D is kept from answer to answer (surface/inner_surface.h). Where the surface about x is certain, x is inside of D.
 * The true facets of D that triangles of the surface lie in are proven by exact slopes (facet.h), and compared exactly.
 * The search ends when each triangle either lies in a proven facet or is farther from x, for certain, than the least of
 * these: then that is the least of all facets of D, and every facet that ties with it is among those compared.
 */
#ifndef PIR_PAIR_PAIR_DEPTH_H
#define PIR_PAIR_PAIR_DEPTH_H

#include "pair/pair_task.h"

/* The answer from facets: see pir_facet_source. */
bool pir_pair_depth(pir_task *task, bool anew);

#endif

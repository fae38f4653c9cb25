/* SPDX-License-Identifier: MIT */
/*
 * Overlap from a surface in D (inner_surface.h), proven at one placement.
 *
 * Where the surface about x is certain, x is inside of D. The true facets of D that triangles of the surface lie in are
 * proven by exact slopes (facet.h), and compared exactly. The search ends when each triangle either lies in a
 * proven facet or is farther from x, for certain, than the least of these: then that is the least of all facets of
 * D, and every facet that ties with it is among those that were compared.
 */
#ifndef PIR_PAIR_OVERLAP_H
#define PIR_PAIR_OVERLAP_H

#include "pair/pair.h"

typedef struct pir_overlap {
    pir_exact *exact;
    const pir_placement *placement;
    pir_surface *surface;
    pir_surface_room *room;
    pir_same_prover *prove_same;
    pir_pair_statistics *statistics;
    bool *has_same; /* whether `same` is proven here, with x on its inner side */
    pir_same_facet *same;
} pir_overlap;

/* Places the surface about x. True where it is certain: x then is inside. */
bool pir_overlap_place(const pir_overlap *overlap);

/* The outcome of a surface: nothing, a facet of D that x is within rounding of or beyond, or a certain one about x. */
typedef enum pir_about { PIR_ABOUT_NOTHING, PIR_ABOUT_FACET, PIR_ABOUT_X } pir_about;

/* Expands a placed surface that x has left. */
pir_about pir_overlap_repair(const pir_overlap *overlap, pir_facet *ret_facet);

/* Makes a surface from the four vertices that a descent ended with, if there are so many. */
pir_about pir_overlap_begin(const pir_overlap *overlap, const pir_simplex *simplex, pir_facet *ret_facet);

/* Makes a surface about x from one about `inner`, a point inside of D. */
pir_about pir_overlap_widen(const pir_overlap *overlap, pir_vec3 inner, pir_facet *ret_facet);

/*
 * The true facet of least slack, and the first in order of those that tie, from a surface about x; false where it
 * is left open. `same` may become that facet.
 */
bool pir_overlap_least(const pir_overlap *overlap, pir_facet *ret_facet);

#endif

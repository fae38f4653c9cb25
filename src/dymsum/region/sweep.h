/* SPDX-License-Identifier: MIT */
/* Which features a cover asks for: see sweep.c. */
#ifndef PIR_DYMSUM_REGION_SWEEP_H
#define PIR_DYMSUM_REGION_SWEEP_H

#include "dymsum/region/clusters.h"
#include "dymsum/region/starts.h"
#include "polytope/polytope.h"

/* Features of one kind. */
typedef struct pir_members {
    uint32_t *at, count; /* the active ones; of edges and of facets of Q, with room for whole clusters */
    uint32_t *next;      /* room for those of the next sweep; of facets of P, these and `at` have room for one more */
    uint32_t *seen;      /* per feature: the last sweep that found and marked it */
    uint32_t capacity;   /* how many features there are */
} pir_members;

/* The facets of one operand. */
typedef struct pir_region_facets {
    pir_starts starts; /* over the cells of the other operand */
    pir_members members;
} pir_region_facets;

typedef struct pir_sweep {
    const pir_kernels *kernels;
    double skin; /* the last one that an arc was made of, or 0; and that arc */
    pir_arc skin_arc;
    uint32_t number;        /* of the last sweep */
    pir_region_facets p, q; /* of either operand */
    pir_members edges;      /* of P */

    /* edges of P and facets of Q as the sweep reads them, cluster by cluster: see sweep.c */
    pir_clusters arcs, points;
    float *arc, *point;
} pir_sweep;

/* The inputs of a sweep; it keeps the kernels alone. */
typedef struct pir_sweep_parts {
    const pir_kernels *kernels;
    const pir_polytope *p, *q;
    const pir_facets *p_facets, *q_facets; /* as kernels know them */
} pir_sweep_parts;

/*
 * Memory for sweeps, filled with what they read of the operands. No feature is a member. False when out of memory: then
 * there is none.
 */
bool pir_sweep_init(pir_sweep *sweep, const pir_sweep_parts *parts, const pir_allocator *allocator);
void pir_sweep_finish(pir_sweep *sweep, const pir_allocator *allocator);

/*
 * Finds the features that the cover asks for: members->next holds them, as many as members->count says. members->at
 * still holds the members of before.
 */
void pir_sweep_run(pir_sweep *sweep, const pir_cover *cover, const pir_polytope *p);

/* Marks what the last sweep has found: the `seen` of each is its number. */
void pir_sweep_mark(const pir_sweep *sweep);

/* Takes what the last sweep found for the members. */
void pir_sweep_take(pir_sweep *sweep);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The pairing of two operands at one rotation, as those who read a sum see it.
 *
 * The Gaussian map of P, rotated, lies over that of Q. A facet of P is a point in the cell of a vertex of Q (fv). A
 * facet of Q is a point in the cell of a vertex of P (vf). The arc of an edge of P leads from the facet left of its
 * halfedge to the facet right of it and leaves cell after cell of Q through the arcs of Q's edges (ee).
 *
 * Invariants, at the rotation perturbed as in exact/sign.h, after every call that succeeds. They hold for all features,
 * or for those that a region keeps. The others have PIR_NO_PAIR for a cell and no crossings.
 *   - fv[f] is the vertex of Q farthest along the normal of f; vf[g] is the vertex of P farthest along the normal of g.
 *   - The crossings of an edge name halfedges of Q in the order in which the arc meets them. The first leaves fv[left],
 *     each later one leaves the vertex that the one before leads to, the last leads to fv[right].
 */
#ifndef PIR_DYMSUM_PAIRING_PAIRING_H
#define PIR_DYMSUM_PAIRING_PAIRING_H

#include <stdbool.h>
#include <stdint.h>

#include <pirouette/sum.h>

#include "base/scratch.h"
#include "exact/sign.h"
#include "polytope/polytope.h"

/* The parts that a sum is made from. References are taken; without scratch it makes its own. */
typedef struct pir_sum_parts {
    pir_polytope *p, *q;
    pir_quat rotation;
    const pir_allocator *allocator;
    pir_scratch *scratch;
} pir_sum_parts;

/* In place of a crossing's slot: there is none. */
#define PIR_NO_CROSSING UINT32_MAX

/* A slot of a crossing. */
typedef struct pir_crossing {
    uint32_t half; /* the halfedge of Q that is crossed, from the cell before to the cell after */
    uint32_t edge; /* the edge of P, or PIR_NO_CROSSING in a free slot */
    uint32_t next; /* the next crossing along the arc, or PIR_NO_CROSSING; of free slots, the next one free */
} pir_crossing;

typedef struct pir_crossings {
    uint32_t *first;               /* per edge of P: the slot of its first crossing, or PIR_NO_CROSSING */
    pir_crossing *at;              /* per slot */
    uint32_t capacity, used, free; /* slots [0, used) have been used; `free` is the first free one of them */
    uint32_t count;                /* crossings over all edges */
} pir_crossings;

typedef struct pir_pairing {
    pir_allocator allocator;
    pir_scratch *scratch; /* referenced */
    pir_polytope *p, *q;  /* at the scale that was last set */
    bool difference;      /* made as a difference: p is the caller's P reflected */
    uint64_t generation;  /* see pir_sum_generation */
    pir_signs signs;      /* holds the rotation that the pairing is exact at */
    uint32_t *fv, *vf;    /* per facet of P the vertex of Q, per facet of Q the vertex of P, or PIR_NO_PAIR */
    pir_crossings crossings;
} pir_pairing;

/*
 * How many crossings most rotations of two operands stay below: memory made for so many seldom grows. Two bodies of
 * about one size have fewer than their edges together, platonic solids at most a few more; the rest is room for small
 * bodies, whose counts vary most.
 */
static inline uint32_t pir_crossings_expected(const pir_polytope *p, const pir_polytope *q) {
    uint32_t edges = p->edge_count + q->edge_count;
    return edges + edges / 4 + 32;
}

/*
 * The crossings of edge e of P in order:
 *
 *     for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at))
 *         ... pir_crossing_half(pairing, at) ...
 */
static inline uint32_t pir_crossing_first(const pir_pairing *pairing, uint32_t e) {
    return pairing->crossings.first[e];
}

static inline uint32_t pir_crossing_next(const pir_pairing *pairing, uint32_t at) {
    return pairing->crossings.at[at].next;
}

/* The halfedge of Q that is crossed. */
static inline uint32_t pir_crossing_half(const pir_pairing *pairing, uint32_t at) {
    return pairing->crossings.at[at].half;
}

/* The edge of P in a slot below pairing->crossings.used, or PIR_NO_CROSSING where the slot is free. */
static inline uint32_t pir_crossing_edge(const pir_pairing *pairing, uint32_t at) {
    return pairing->crossings.at[at].edge;
}

/* The crossing of edge e of P with halfedge h of Q, or PIR_NO_CROSSING. O(crossings of e). */
static inline uint32_t pir_crossing_find(const pir_pairing *pairing, uint32_t e, uint32_t h) {
    uint32_t at = pir_crossing_first(pairing, e);
    while (at != PIR_NO_CROSSING && pir_crossing_half(pairing, at) != h)
        at = pir_crossing_next(pairing, at);
    return at;
}

#endif

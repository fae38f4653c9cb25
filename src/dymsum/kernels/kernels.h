/* SPDX-License-Identifier: MIT */
/*
 * The inner loops of updates and walks, behind one dispatch struct: a scalar reference, and AVX2, AVX-512 and NEON
 * versions, of which a sum takes one from the processor's table (base/processor.h) when it is made. Every version
 * performs the same roundings, lane by lane, and minima and maxima do not round. So all versions give the same bits.
 */
#ifndef PIR_DYMSUM_KERNELS_KERNELS_H
#define PIR_DYMSUM_KERNELS_KERNELS_H

#include "base/fetching.h"
#include "dymsum/kernels/facet_checks.h"
#include "dymsum/kernels/lists.h"
#include "dymsum/kernels/walked_arcs.h"

/* How many facets descend at a time, at most. */
#define PIR_DESCENT_MOST 64

/* Where descents start: a grid over the sphere, see region/starts.c. */
typedef struct pir_starts {
    uint32_t side;  /* squares along a side of the grid */
    uint32_t *cell; /* per square: a vertex in whose cell its middle is, but for rounding */
} pir_starts;

typedef struct pir_kernels {
    const char *name;

    /*
     * Checks the facets of a part of the expired certificates. Facets that are in their cells, and certainly have been
     * all through the last step, are certified anew. So are those that have crossed one side and touched no other.
     * Their previous certificates are kept (certificates.h), and they are listed, as are all others. Returns how many
     * are listed; adds to *sides how many directions were compared.
     */
    uint32_t (*review)(const pir_facets *facets, const pir_step *step, pir_certificates *certificates,
                       const pir_due *due, pir_suspect *ret_suspects, uint64_t *sides);

    /* Probes a facet in the cell of vertex `cell`; turned: its normal rotated, 0, the motion of that, 0. */
    void (*probe)(const pir_facets *facets, const pir_step *step, uint32_t cell, const float turned[8],
                  pir_cell_probe *ret_probe);

    /*
     * Finds the cell of each of `count` facets, 1 to PIR_DESCENT_MOST, from vertex `from` uphill, always along the
     * steepest direction.
     * Where floats are not certain of the next step the facet is listed: its cell is as far as they led. Returns how
     * many are listed; adds to *sides how many directions were compared.
     */
    uint32_t (*descend)(const pir_facets *facets, const uint32_t *facet, const uint32_t *from, uint32_t count,
                        uint32_t *ret_open, uint64_t *sides);

    /* Finds where each of `count` facets, at most PIR_DESCENT_MOST, starts a descent. */
    void (*find_starts)(const pir_facets *facets, const pir_starts *starts, const uint32_t *facet, uint32_t count,
                        uint32_t *ret_from);

    /* Finds side, right and left of arcs. */
    void (*find_sides)(const pir_polytope *q, pir_arcs *arcs);

    /* Finds the values of arcs. */
    void (*measure_sides)(const pir_facets *facets_of_p, const pir_polytope *p, const pir_polytope *q, pir_arcs *arcs);

    /*
     * Lists in certificates->expired those of the first `blocks` blocks that do not hold. Makes the bounds of their
     * blocks from the others, since each that has expired is filed again. Returns how many are listed.
     */
    uint32_t (*collect)(pir_certificates *certificates, uint32_t blocks, pir_turned_angle turned);

    /* Lists, rising, the caps that come within reach. Returns how many. All lists have room for whole blocks. */
    uint32_t (*list_caps)(const pir_caps *caps, const pir_sight *sight, uint32_t *ret_which);

    /* Lists the points within reach. Returns how many. */
    uint32_t (*list_points)(const pir_clustered *points, const pir_sight *sight, uint32_t *ret_item);

    /*
     * Lists the arcs that come within reach, from the place *at in the list of clusters on. Stops where a cluster has
     * one of which floats, off by less than the slack, are not certain: *at is its place then, else past the last.
     */
    uint32_t (*list_arcs)(const pir_clustered *arcs, const pir_sight *sight, uint32_t *at, uint32_t *ret_item);
} pir_kernels;

/*
 * Lists in certificates->expired those of the first `used` certificates that do not hold for certain. Returns their
 * number.
 */
static inline uint32_t pir_kernels_collect(const pir_kernels *kernels, pir_certificates *certificates, uint32_t used,
                                           pir_turned_angle turned) {
    return kernels->collect(certificates, (used + PIR_CERTIFICATE_BLOCK - 1) / PIR_CERTIFICATE_BLOCK, turned);
}

/* The scalar reference of some kernels, where a version has none of its own. */
void pir_arcs_find_sides(const pir_polytope *q, pir_arcs *arcs);
void pir_arcs_measure_sides(const pir_facets *facets_of_p, const pir_polytope *p, const pir_polytope *q,
                            pir_arcs *arcs);
void pir_find_starts(const pir_facets *facets, const pir_starts *starts, const uint32_t *facet, uint32_t count,
                     uint32_t *ret_from);

extern const pir_kernels pir_kernels_plain, pir_kernels_avx2, pir_kernels_avx512, pir_kernels_neon;

#endif

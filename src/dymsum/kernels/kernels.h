/* SPDX-License-Identifier: MIT */
/*
 * The inner loops of updates and walks, behind one dispatch struct: a scalar reference, and AVX2, AVX-512 and NEON
 * versions chosen when a sum is made. Every version performs the same roundings, lane by lane, and minima and maxima do
 * not round. So all versions give the same bits.
 *
 * They check facets, points of one Gaussian map, in cells of the other, by floats: a facet of unit normal n in the cell
 * of vertex v is compared with every direction d of v's ring. Where floats are not certain, callers use doubles, and
 * exact signs where those are not.
 *
 * The bound on floats, with u = 2^-24: the matrix entries are off by u each, √3·u in norm; n and d by u; the
 * rotation rounds by 5.3u, the last dot product by 3.01u. Together that is below 12.1u, for the value s as for its rate
 * of change, and PIR_FLOAT_BOUND is 16u. A prediction over an angle t ≤ 1 then errs by 12.1u + 12.1u·t in the value.
 * Its own arithmetic rounds by less than 4u·(s′² + 2|s|) ≤ 12u in the value. Drift takes 16u. PIR_FLOAT_SLACK,
 * 64u, covers all four.
 */
#ifndef PIR_DYMSUM_KERNELS_KERNELS_H
#define PIR_DYMSUM_KERNELS_KERNELS_H

#include <stdint.h>

#include <pirouette/base.h>

#include "base/fetching.h"
#include "base/vec.h"
#include "dymsum/certificate/certificates.h"
#include "dymsum/certificate/expiry.h"
#include "polytope/polytope.h"

#define PIR_FLOAT_BOUND 0x1p-20f
#define PIR_FLOAT_SLACK 0x1p-18f

/* Predictions reach no farther than this many radians. */
#define PIR_FARTHEST_PREDICTION 1.0f

/* In place of a side of a cell: there is none, or none is known. */
#define PIR_NO_SIDE UINT32_MAX

/* A ring longer than this has all bits of a mask of sides set when any of its sides is in it. */
#define PIR_SIDE_BITS 64

/* The result of a check of a facet in a cell. */
typedef struct pir_check {
    float margin;        /* how far R may turn until some s changes its sign; negative when one is not certain */
    float ahead, behind; /* how far the phase may go either way, both ≥ 0 */
    float unused;        /* so that the four are a vector */
    /* the sides that the facet may have touched in the last step, with those whose sign is not certain */
    uint64_t touched;
    uint64_t above; /* the sides that it is certainly past: s > PIR_FLOAT_BOUND */
} pir_check;

/* The result of a probe of a facet in a cell: the check, and the side that it may be farthest beyond. */
typedef struct pir_cell_probe {
    float highest;  /* the greatest value s; below −PIR_FLOAT_BOUND the facet is certainly in the cell */
    uint32_t which; /* the first side that has it */
    pir_check check;
} pir_cell_probe;

/* A part of a list of expired certificates, by numbers. Parts are reviewed one after another. */
typedef struct pir_due {
    const uint32_t *expired;
    uint32_t count, behind; /* as many follow in the list behind this part */
    bool begun;             /* the part before has been reviewed */
} pir_due;

/* A facet that may have left its cell, perhaps only within the last step. */
typedef struct pir_suspect {
    uint32_t facet;
    /* the one side that it has crossed, having touched no other: its cell is the next one now; or PIR_NO_SIDE */
    uint32_t crossed;
} pir_suspect;

/* How many facets descend at a time, at most. */
#define PIR_DESCENT_MOST 64

/* How many arcs of P are walked at a time. */
#define PIR_ARCS 32

/* Arcs of P whose ends are in different cells of Q. */
typedef struct pir_arcs {
    uint32_t count;
    uint32_t edge[PIR_ARCS];                  /* of P */
    uint32_t from[PIR_ARCS], to[PIR_ARCS];    /* the cells of its ends */
    uint32_t side[PIR_ARCS];                  /* the side of the first cell that leads to the last, or PIR_NO_SIDE */
    uint32_t right[PIR_ARCS], left[PIR_ARCS]; /* the facets of Q at that side's ends; or at those of some other */
    float value[PIR_ARCS][2];                 /* s of the edge and those two */
} pir_arcs;

/* The facets of one operand over the cells of the other, which is laid out in rings (polytope.h). */
typedef struct pir_facets {
    uint32_t count, first_certificate;
    const float *normal;                     /* four floats a facet, the last 0 */
    const uint32_t *ring_start, *ring_block; /* of the other operand, as are the four that follow */
    const uint32_t *target, *twin;
    const pir_ring *ring;
    bool single;    /* each ring fills one block: ring_block[v] = v, and need not be read */
    uint32_t *cell; /* per facet */
    /* column k of the matrix that rotates normals to the other operand, 0, column k of that of their motion, 0 */
    float turn[3][8];
} pir_facets;

/* The last step, and how far R has turned with it. */
typedef struct pir_step {
    /* the phases of the step, counted from now: one of them is 0, or both are the same */
    float reach_ahead, reach_behind;
    float ahead, behind; /* what keys count from: axial: the phase, twice; otherwise the path, and the net turn */
    bool axial;
} pir_step;

/* Where descents start: a grid over the sphere, see region/starts.c. */
typedef struct pir_starts {
    uint32_t side;  /* squares along a side of the grid */
    uint32_t *cell; /* per square: a vertex in whose cell its middle is, but for rounding */
} pir_starts;

/* A direction, and how far from it a region's sweep looks, by floats. */
typedef struct pir_sight {
    float x, y, z;      /* unit */
    float cosine, sine; /* of the reach */
    float slack;        /* what is beyond the reach by no more, in the cosine, counts as within */
} pir_sight;

/* Caps on the sphere, so many; there is room for whole blocks of PIR_LANES. */
typedef struct pir_caps {
    float *x, *y, *z, *cosine, *sine;
    uint32_t count;
} pir_caps;

/* Points or arcs in clusters of PIR_LANES, the last perhaps with fewer, and which clusters are looked at. */
typedef struct pir_clustered {
    const float *row;     /* cluster by cluster, as many rows as an item has numbers */
    const uint32_t *item; /* numbers, with room for whole clusters */
    uint32_t count;       /* of items */
    const uint32_t *cluster;
    uint32_t clusters;
} pir_clustered;

/* Rows of an arc: the normals at its ends, the direction of its edge, the cosine of its length. */
enum {
    PIR_ARC_FROM = 0,
    PIR_ARC_TO = 3,
    PIR_ARC_ALONG = 6,
    PIR_ARC_COSINE = 9,
    PIR_ARC_ROWS = 10,
};

/* Rows of a point: its unit vector. */
enum { PIR_POINT_ROWS = 3 };

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

/* The first block of the ring of a cell. */
static inline const pir_ring *pir_ring_of(const pir_facets *facets, uint32_t cell) {
    return facets->ring + (facets->single ? cell : facets->ring_block[cell]);
}

/* A cell's ring, and its number of blocks. */
static inline const pir_ring *pir_rings_of(const pir_facets *facets, uint32_t cell, uint32_t *ret_blocks) {
    if (facets->single) {
        *ret_blocks = 1;
        return facets->ring + cell;
    }
    uint32_t block = facets->ring_block[cell];
    *ret_blocks = facets->ring_block[cell + 1] - block;
    return facets->ring + block;
}

/* The mask of the sides of a ring of so many sides, without the bits that only fill its last block. */
static inline uint64_t pir_side_mask(uint32_t sides) {
    return sides < PIR_SIDE_BITS ? ((uint64_t)1 << sides) - 1 : UINT64_MAX;
}

/* Adds the mask of eight sides, those of block b, to that of a ring. */
static inline uint64_t pir_side_mask_add(uint64_t mask, uint32_t b, uint32_t eight) {
    return mask | (b < PIR_SIDE_BITS / 8 ? (uint64_t)eight << 8 * b : eight ? UINT64_MAX : 0);
}

/*
 * Files certificate i, made now: in an axial epoch by the phases, otherwise by the margin. Keys are rounded towards
 * expiring early.
 */
static inline void pir_certificate_file(const pir_step *step, pir_certificates *certificates, uint32_t i, float margin,
                                        float ahead, float behind) {
    float until = step->ahead + (step->axial ? ahead : margin), since = step->behind - (step->axial ? behind : margin);
    pir_certificate_set(certificates, i, margin, until - fabsf(until) * 0x1p-22f, since + fabsf(since) * 0x1p-22f);
}

/* Files the certificate of facet f, which has just been checked. */
static inline void pir_certificate_file_check(const pir_facets *facets, const pir_step *step,
                                              pir_certificates *certificates, uint32_t f, const pir_check *check) {
    pir_certificate_file(step, certificates, facets->first_certificate + f, check->margin, check->ahead, check->behind);
}

/* Packs a vector and its motion as the kernels take them. */
static inline void pir_pack_turned(pir_vec3 u, pir_vec3 w, float ret_turned[8]) {
    const double from[8] = {u.x, u.y, u.z, 0, w.x, w.y, w.z, 0};
    for (int k = 0; k < 8; k++)
        ret_turned[k] = (float)from[k];
}

/* The side of arc k's first cell, of the halfedges from `start` up to `end`, has been found. */
static inline void pir_arcs_take_side(const pir_polytope *q, pir_arcs *arcs, uint32_t k, uint32_t start, uint32_t end,
                                      uint32_t found) {
    uint32_t side = found != PIR_NO_SIDE ? found : start;
    arcs->side[k] = found;
    arcs->right[k] = q->left[(side > start ? side : end) - 1];
    arcs->left[k] = q->left[side];
}

/* The scalar reference of some kernels, where a version has none of its own. */
void pir_arcs_find_sides(const pir_polytope *q, pir_arcs *arcs);
void pir_arcs_measure_sides(const pir_facets *facets_of_p, const pir_polytope *p, const pir_polytope *q,
                            pir_arcs *arcs);
void pir_find_starts(const pir_facets *facets, const pir_starts *starts, const uint32_t *facet, uint32_t count,
                     uint32_t *ret_from);
uint32_t pir_list_caps(const pir_caps *caps, const pir_sight *sight, uint32_t *ret_which);
uint32_t pir_list_points(const pir_clustered *points, const pir_sight *sight, uint32_t *ret_item);
uint32_t pir_list_arcs(const pir_clustered *arcs, const pir_sight *sight, uint32_t *at, uint32_t *ret_item);

/* The lanes of block b that are in use where there are `count` in all. */
static inline uint32_t pir_lanes_used(uint32_t count, uint32_t b) {
    return (uint32_t)pir_side_mask(count - b * PIR_LANES) & ((1u << PIR_LANES) - 1);
}

/* The versions that this build has and this processor runs, the scalar reference first; NULL past the last. */
const pir_kernels *pir_kernels_version(unsigned index);

/* The fastest of them. */
const pir_kernels *pir_kernels_choose(void);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Facets in cells, by floats.
 *
 * Facets, points of one Gaussian map, are checked in cells of the other: a facet of unit normal n in the cell of vertex
 * v is compared with every direction d of v's ring. Where floats are not certain, callers use doubles, and exact signs
 * where those are not.
 *
 * The bound on floats, with u = 2^-24: the matrix entries are off by u each, √3·u in norm; n and d by u; the
 * rotation rounds by 5.3u, the last dot product by 3.01u. Together that is below 12.1u, for the value s as for its rate
 * of change, and PIR_FLOAT_BOUND is 16u. A prediction over an angle t ≤ 1 then errs by 12.1u + 12.1u·t in the value.
 * Its own arithmetic rounds by less than 4u·(s′² + 2|s|) ≤ 12u in the value. Drift takes 16u. PIR_FLOAT_SLACK,
 * 64u, covers all four.
 */
#ifndef PIR_DYMSUM_KERNELS_FACET_CHECKS_H
#define PIR_DYMSUM_KERNELS_FACET_CHECKS_H

#include <stdint.h>

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

/* The lanes of block b that are in use where there are `count` in all. */
static inline uint32_t pir_lanes_used(uint32_t count, uint32_t b) {
    return (uint32_t)pir_side_mask(count - b * PIR_LANES) & ((1u << PIR_LANES) - 1);
}

#endif

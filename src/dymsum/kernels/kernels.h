/* SPDX-License-Identifier: MIT */
/*
 * The inner loops of an update, behind one dispatch struct: a scalar reference, and AVX2, AVX-512 and NEON versions
 * chosen when a sum is made. Every version performs the same roundings, lane by lane, and minima and maxima do not
 * round: all give the same bits.
 *
 * They look at facets, points of one Gaussian map, in cells of the other, by floats: a facet of unit normal n in the
 * cell of vertex v is compared with every direction d of v's ring. Doubles stand behind where floats are not certain,
 * and exact signs behind those.
 *
 * The bound on floats, u = 2^-24: the matrix entries are off by u each, √3·u in norm; n and d by u; the turn rounds by
 * 5.3u, the last dot product by 3.01u: below 12.1u in all, for the value s as for its rate of change, and
 * PIR_FLOAT_BOUND is 16u. A span t ≤ 1 then is foretold with an error of 12.1u + 12.1u·t in the value; what its own
 * arithmetic rounds is, in the value, below 4u·(s′² + 2|s|) ≤ 12u; drift takes 16u. PIR_FLOAT_SLACK, 64u, holds all
 * four.
 */
#ifndef PIR_DYMSUM_KERNELS_KERNELS_H
#define PIR_DYMSUM_KERNELS_KERNELS_H

#include <stdint.h>

#include <pirouette/base.h>

#include "base/vec.h"
#include "dymsum/certificate/certificates.h"
#include "dymsum/certificate/expiry.h"

#define PIR_FLOAT_BOUND 0x1p-20f
#define PIR_FLOAT_SLACK 0x1p-18f

/* Spans are foretold no farther than this many radians. */
#define PIR_FARTHEST_PREDICTION 1.0f

/* In place of a side of a cell: there is none, or none is known. */
#define PIR_NO_SIDE UINT32_MAX

/* A ring longer than this has all bits of a mask of sides set when any of its sides is in it. */
#define PIR_SIDE_BITS 64

/* What a look at a facet in a cell finds. */
typedef struct pir_check {
    float margin;        /* by the path, until some s changes its sign; negative when one is too close to call */
    float ahead, behind; /* by the phase, both ≥ 0 */
    float unused;        /* so that the four are a vector */
    uint64_t
        touched;    /* the sides that the facet may have touched in the last step, those too close to call among them */
    uint64_t above; /* those that it is past for certain: s > PIR_FLOAT_BOUND */
} pir_check;

/* What is seen at a glance of a facet in a cell. */
typedef struct pir_probe {
    float highest;  /* the greatest value s: the facet is in the cell for certain when below −PIR_FLOAT_BOUND */
    uint32_t which; /* the first side that has it */
    pir_check check;
} pir_probe;

/* A facet that may have left its cell, even if only for a moment within the last step. */
typedef struct pir_suspect {
    uint32_t facet;
    uint32_t crossed; /* the one side crossed, none else touched: its cell is the next one now; or PIR_NO_SIDE */
} pir_suspect;

/* The facets of one operand over the cells of the other, which is laid out in rings (polytope.h). */
typedef struct pir_facets {
    uint32_t count, first_certificate;
    const float *normal;                     /* four floats a facet, the last 0 */
    const uint32_t *ring_start, *ring_block; /* of the other operand, as all that follows */
    const uint32_t *target, *twin;
    const float *ring;
    uint32_t *cell; /* per facet */
    float
        turn[3]
            [8]; /* column k of the matrix that turns normals to the other operand, 0, and of that of their motion, 0 */
} pir_facets;

/* The last step, and the moment it has led to. */
typedef struct pir_step {
    float reach_ahead,
        reach_behind;    /* where the step lies by the phase, from now: one of them is 0, or both are the same */
    float ahead, behind; /* what keys are counted from: axial: the phase; otherwise the path, and the net turn */
    bool axial;
} pir_step;

typedef struct pir_kernels {
    const char *name;

    /*
     * Looks at `count` facets, numbered as alarms in `woken`. Those that are in their cells, and certainly have been
     * all through the last step, are filed to sleep; so are those that have crossed one side and touched no other,
     * their last certificates kept (alarms.h), and these and the rest are listed. Returns their number; adds to *sides
     * how many directions were looked at.
     */
    uint32_t (*review)(const pir_facets *facets, const pir_step *step, pir_certificates *certificates,
                       const uint32_t *expired, uint32_t count, pir_suspect *ret_suspects, uint64_t *sides);

    /* Looks at a facet in the cell of vertex `cell`; turned: its normal turned, 0, the motion of that, 0. */
    void (*probe)(const pir_facets *facets, const pir_step *step, uint32_t cell, const float turned[8],
                  pir_probe *ret_probe);

    /*
     * Lists in alarms->woken which of the certificates in the first `blocks` blocks do not hold, and makes the bounds
     * of their blocks those of the others, since who wakes is filed again. Returns how many it listed.
     */
    uint32_t (*collect)(pir_certificates *certificates, uint32_t blocks, pir_turned_angle turned);
} pir_kernels;

/* Lists those of the first `used` certificates that have expired, for certain or not. Returns their number. */
static inline uint32_t pir_kernels_collect(const pir_kernels *kernels, pir_certificates *certificates, uint32_t used,
                                           pir_turned_angle turned) {
    return kernels->collect(certificates, (used + PIR_CERTIFICATE_BLOCK - 1) / PIR_CERTIFICATE_BLOCK, turned);
}

/* The mask of the sides of a ring of so many, without the bits that only fill its last block up. */
static inline uint64_t pir_side_mask(uint32_t sides) {
    return sides < PIR_SIDE_BITS ? ((uint64_t)1 << sides) - 1 : UINT64_MAX;
}

/* Adds the mask of eight sides, those of block b, to that of a ring. */
static inline uint64_t pir_side_mask_add(uint64_t mask, uint32_t b, uint32_t eight) {
    return mask | (b < PIR_SIDE_BITS / 8 ? (uint64_t)eight << 8 * b : eight ? UINT64_MAX : 0);
}

/*
 * Files alarm i anew, from now: in an axial epoch by its spans, otherwise by its margin. Keys are rounded towards
 * waking early.
 */
static inline void pir_certificate_file(const pir_step *step, pir_certificates *certificates, uint32_t i, float margin,
                                        float ahead, float behind) {
    float until = step->ahead + (step->axial ? ahead : margin), since = step->behind - (step->axial ? behind : margin);
    pir_certificate_set(certificates, i, margin, until - fabsf(until) * 0x1p-22f, since + fabsf(since) * 0x1p-22f);
}

/* Files facet f, looked at just now, to sleep as long as the look allows. */
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

/* The versions that this build has and this processor runs, the scalar reference first; NULL past the last. */
const pir_kernels *pir_kernels_version(unsigned index);

/* The fastest of them. */
const pir_kernels *pir_kernels_choose(void);

#endif

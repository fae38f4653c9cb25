/* SPDX-License-Identifier: MIT */
/*
 * The certificates of facets: until when each facet is certain to stay in its cell.
 *
 * Each certificate has two keys, `ahead` and `behind`. In an axial epoch it holds at the phases between them: ahead >
 * phase > behind. In any other epoch it holds while ahead > path, and also while behind < −net. epoch.h defines
 * phase, path and net turn. A certificate also has the rotation at which it was made and a `margin`: it holds at every
 * rotation that is less than this angle away from that one. When an epoch ends, the keys of the next are made from the
 * margin. So a motion to and fro, or about changing axes, uses up only its net turn.
 *
 * The certificates are stored in blocks of 16 with the least `ahead` and the greatest `behind` of each block. To find
 * what has expired, a sum reads the bounds of all blocks, a few cache lines, and then the blocks that have expired
 * certificates. To file a certificate takes two comparisons. A timing wheel or a heap would read less and move more.
 * Here certificates stay in place, a new epoch is one pass, and a key may decrease as well as increase.
 *
 * Keys are floats, rounded so that certificates expire early. They count from the start of the epoch, so they stay
 * small.
 *
 * When a motion reverses, facets return to the cells that they came from. In an axial epoch a certificate is a
 * statement about an interval of phases, and it stays true after its facet has left the cell. So a facet that has
 * crossed a single side keeps the certificate of its previous cell. When its new certificate expires at a phase at
 * which the kept one holds, the facet is in the previous cell again, and that side is all that it has crossed. Proof:
 * from the phase at which it crossed to the phase of the last rotation it was certified in its new cell; the step in
 * which it crossed touched no other side; the phases beyond are those of the kept certificate, an interval. No check is
 * needed. See pir_certificate_reuse.
 *
 * Invariant: the bounds of a block hold for each of its certificates, unless `expired_all`.
 */
#ifndef PIR_DYMSUM_CERTIFICATE_CERTIFICATES_H
#define PIR_DYMSUM_CERTIFICATE_CERTIFICATES_H

#include <math.h>

#include "base/memory.h"
#include "dymsum/certificate/epoch.h"

#define PIR_CERTIFICATE_BLOCK 16

/* The certificate of the cell that a facet was in before, and the side that leads there. */
typedef struct pir_previous_cell {
    float ahead, behind;
    uint32_t half;    /* the halfedge of the other operand that leads there from the facet's cell */
    uint32_t stretch; /* in which the keys are phases, or PIR_NO_STRETCH */
} pir_previous_cell;

#define PIR_NO_STRETCH UINT32_MAX

typedef struct pir_float4 {
    float c[4];
} pir_float4;

typedef struct pir_certificates {
    float *ahead, *behind; /* per certificate */
    float *margin;
    pir_float4 *at; /* the unit quaternion at which it was made */
    pir_float4 now; /* the unit quaternion of R */
    float *block_ahead, *block_behind;
    pir_previous_cell *previous; /* per certificate */
    uint32_t stretch;            /* counts how often keys have been made anew or shifted */
    uint32_t *expired;           /* what the last collection found, rising */
    uint32_t capacity;           /* whole blocks; their bounds are in a multiple of eight */
    bool expired_all;            /* every certificate has expired: no key, bound or margin is in force */
} pir_certificates;

/* Room for at least `count` certificates, which never expire; false when out of memory. */
bool pir_certificates_init(pir_certificates *certificates, const pir_allocator *allocator, uint32_t count);
void pir_certificates_finish(pir_certificates *certificates, const pir_allocator *allocator);

/* A key beyond any turn. It is finite, so that subtracting from it gives a number. */
#define PIR_NEVER 1e30f

/* A float at most x, and close to it; a float at least x. */
static inline float pir_float_below(double x) {
    return x < (double)PIR_NEVER ? (float)(x - fabs(x) * 0x1p-23) : PIR_NEVER;
}

static inline float pir_float_above(double x) {
    return -pir_float_below(-x);
}

/* Sets the keys of certificate i. */
static inline void pir_certificate_set_keys(pir_certificates *certificates, uint32_t i, float ahead, float behind) {
    uint32_t block = i / PIR_CERTIFICATE_BLOCK;
    float least = certificates->block_ahead[block], greatest = certificates->block_behind[block];
    certificates->ahead[i] = ahead;
    certificates->behind[i] = behind;
    certificates->block_ahead[block] = ahead < least ? ahead : least;
    certificates->block_behind[block] = behind > greatest ? behind : greatest;
}

/* Files certificate i, made at certificates->now. */
static inline void pir_certificate_set(pir_certificates *certificates, uint32_t i, float margin, float ahead,
                                       float behind) {
    pir_certificate_set_keys(certificates, i, ahead, behind);
    certificates->margin[i] = margin;
    certificates->at[i] = certificates->now;
}

/*
 * Forgets the previous cell of the facet of certificate i: the facet may have left its cell since, or entered it by
 * more than one side.
 */
static inline void pir_certificate_forget_previous(pir_certificates *certificates, uint32_t i) {
    certificates->previous[i].stretch = PIR_NO_STRETCH;
}

/*
 * Keeps certificate i, of a cell that its facet has just left, before one for the next cell is filed. `half` leads
 * back. The step touched no other side.
 */
static inline void pir_certificate_keep_previous(pir_certificates *certificates, uint32_t i, uint32_t half) {
    certificates->previous[i] =
        (pir_previous_cell){certificates->ahead[i], certificates->behind[i], half, certificates->stretch};
}

/*
 * Whether the facet of certificate i, which has expired at `phase` of an axial epoch, is certainly in its previous
 * cell. Then the certificate of that cell is filed and the other one kept. twin: of the other operand's halfedges.
 * *ret_half: the side crossed. What is filed ends with the epoch: its margin is set to none, because the margin and
 * rotation in store are those of the other cell.
 */
static inline bool pir_certificate_reuse(pir_certificates *certificates, uint32_t i, double phase, const uint32_t *twin,
                                         uint32_t *ret_half) {
    const pir_previous_cell previous = certificates->previous[i];
    if (previous.stretch != certificates->stretch ||
        !((double)previous.ahead > phase && (double)previous.behind < phase))
        return false;
    pir_certificate_keep_previous(certificates, i, twin[previous.half]);
    pir_certificate_set_keys(certificates, i, previous.ahead, previous.behind);
    certificates->margin[i] = -1;
    *ret_half = previous.half;
    return true;
}

/* Sets certificate i never to expire: its facet has no cell. */
static inline void pir_certificate_clear(pir_certificates *certificates, uint32_t i) {
    certificates->ahead[i] = PIR_NEVER;
    certificates->behind[i] = -PIR_NEVER;
    certificates->margin[i] = PIR_NEVER;
    certificates->at[i] = (pir_float4){{0}};
    pir_certificate_forget_previous(certificates, i);
}

/* How far R has turned, as keys are compared with it. */
typedef struct pir_turned_angle {
    double ahead, behind; /* a certificate holds where its `ahead` is above this and its `behind` below */
    bool either;          /* one of the two comparisons is enough */
} pir_turned_angle;

static inline pir_turned_angle pir_turned_angle_of(const pir_epoch *epoch) {
    return epoch->axial ? (pir_turned_angle){epoch->phase, epoch->phase, false}
                        : (pir_turned_angle){epoch->path, -epoch->net, true};
}

/*
 * Subtracts `shift` from the phases of the first `used` certificates. This call and the next forget all previous cells.
 */
void pir_certificates_shift(pir_certificates *certificates, uint32_t used, double shift);

/*
 * Makes the keys of the first `used` certificates for an epoch that begins at certificates->now, from what is left of
 * their margins. In an axial epoch those with less left than `expected` expire at once.
 */
void pir_certificates_new_epoch(pir_certificates *certificates, uint32_t used, bool axial, double expected);

/* Sets certificates->now. */
void pir_certificates_set_now(pir_certificates *certificates, pir_quat unit);

/*
 * Expires all certificates, in O(1): a rebuild is often followed by another one. Before the next of them is looked at
 * or filed, they are laid out.
 */
void pir_certificates_expire(pir_certificates *certificates);

/* Expires the first `used` certificates one by one. */
void pir_certificates_lay_out(pir_certificates *certificates, uint32_t used);

#endif

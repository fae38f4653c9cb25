/* SPDX-License-Identifier: MIT */
/*
 * When certificates wake: a store of two levels, read in order.
 *
 * Each certificate has two keys, `ahead` and `behind`. In an axial epoch it holds at the phases between them, ahead >
 * phase > behind. In any other it holds while ahead > path, and also while behind < −net: the clock tells what these
 * are. For when an epoch ends it also has the rotation at which it was made and a `margin`, the angle between that and
 * R up to which it holds whatever the way: what a body has turned there and back, or about changing axes, costs it only
 * the net turn. Blocks of 16 carry the least `ahead` and the greatest `behind` of theirs. Finding what wakes reads the
 * blocks' bounds, a few cache lines in all, and then the blocks in question; filing one is two comparisons. Against a
 * timing wheel or a heap this reads more and moves nothing: certificates stay where their pair is, a new epoch is one
 * sweep, and an alarm may be set backwards as well as forwards.
 *
 * Keys are kept as floats, rounded so that certificates wake early; a clock counts them from nearby (clock.h).
 *
 * A body that swings brings facets back to where they came from. In an axial epoch a certificate speaks of phases, and
 * goes on to hold at those after its facet has left them; so one that has crossed a single side keeps the certificate
 * of the cell it left, with the way back. When it wakes at a phase which that certificate is good for, it is in that
 * cell again, and all that it has passed through is that side: at every phase from where it crossed to the last
 * rotation's it was seen or certified in its new cell, the step in which it crossed touched no other side, and what
 * lies beyond is the kept certificate's, whose phases are an interval. No look is needed. See pir_certificate_reuse.
 *
 * Invariant: a block's bounds are at most, and at least, those of its certificates.
 */
#ifndef PIR_DYMSUM_CERTIFICATE_CERTIFICATES_H
#define PIR_DYMSUM_CERTIFICATE_CERTIFICATES_H

#include <math.h>

#include "base/memory.h"
#include "dymsum/certificate/epoch.h"

#define PIR_CERTIFICATE_BLOCK 16

/* The certificate of the cell that a facet was in before, and the way there. */
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
    pir_float4 *at; /* the unit quaternion it was made at */
    pir_float4 now; /* that of R */
    float *block_ahead, *block_behind;
    pir_previous_cell *previous; /* per certificate */
    uint32_t stretch;            /* counts how often keys have been made anew or shifted */
    uint32_t *expired;           /* what the last collecting found, rising */
    uint32_t capacity;           /* a multiple of eight blocks */
} pir_certificates;

/* Room for `count` certificates at least, which never wake; false when out of memory. */
bool pir_certificates_init(pir_certificates *certificates, const pir_allocator *allocator, uint32_t count);
void pir_certificates_finish(pir_certificates *certificates, const pir_allocator *allocator);

/* Far beyond any turn, and finite, so that subtracting from it stays a number. */
#define PIR_NEVER 1e30f

/* A float at most x, by little; or at least x. */
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

/* Files certificate i, made at alarms->now. */
static inline void pir_certificate_set(pir_certificates *certificates, uint32_t i, float margin, float ahead,
                                       float behind) {
    pir_certificate_set_keys(certificates, i, ahead, behind);
    certificates->margin[i] = margin;
    certificates->at[i] = certificates->now;
}

/*
 * Forgets where the facet of certificate i came from: it is not known that it has stayed in its cell since, or came by
 * one side.
 */
static inline void pir_certificate_forget_previous(pir_certificates *certificates, uint32_t i) {
    certificates->previous[i].stretch = PIR_NO_STRETCH;
}

/*
 * Keeps certificate i, of a cell just left, before it is filed for the next cell; `half` leads back. The step touched
 * no other side.
 */
static inline void pir_certificate_keep_previous(pir_certificates *certificates, uint32_t i, uint32_t half) {
    certificates->previous[i] =
        (pir_previous_cell){certificates->ahead[i], certificates->behind[i], half, certificates->stretch};
}

/*
 * Whether the facet of certificate i, awake at phase `phase` of an axial epoch, is for certain where it came from; then
 * that certificate is filed and the other kept. twin: of the other operand's halfedges. *ret_half: the side crossed.
 * What is filed ends with the epoch, its margin being none: the margin and rotation that are there are the other
 * cell's.
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

/* Lets certificate i sleep for good: its pair is gone. */
static inline void pir_certificate_clear(pir_certificates *certificates, uint32_t i) {
    certificates->ahead[i] = PIR_NEVER;
    certificates->behind[i] = -PIR_NEVER;
    certificates->margin[i] = PIR_NEVER;
    certificates->at[i] = (pir_float4){{0}};
    pir_certificate_forget_previous(certificates, i);
}

/* What certificates' keys are compared with. */
typedef struct pir_turned_angle {
    double ahead, behind; /* holds: its `ahead` above, its `behind` below */
    bool either;          /* one of the two is enough */
} pir_turned_angle;

static inline pir_turned_angle pir_turned_angle_of(const pir_epoch *epoch) {
    return epoch->axial ? (pir_turned_angle){epoch->phase, epoch->phase, false}
                        : (pir_turned_angle){epoch->path, -epoch->net, true};
}

/* Subtracts `shift` from the phases of the first `used` certificates. This and the next two forget all ways back. */
void pir_certificates_shift(pir_certificates *certificates, uint32_t used, double shift);

/*
 * Files the first `used` certificates anew for an epoch that begins at alarms->now, from what is left of their margins.
 * Those of an axial epoch with less left than `expected` wake at once.
 */
void pir_certificates_new_epoch(pir_certificates *certificates, uint32_t used, bool axial, double expected);

/* Sets alarms->now. */
void pir_certificates_set_now(pir_certificates *certificates, pir_quat unit);

/* Lets the `count` certificates from `first` on wake at once. */
void pir_certificates_expire(pir_certificates *certificates, uint32_t first, uint32_t count);

#endif

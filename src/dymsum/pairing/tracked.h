/* SPDX-License-Identifier: MIT */
/*
 * A pairing that is carried from one rotation to the next: the pairing, its certificates, and the work space of those
 * who change it.
 *
 * Each facet of P and of Q has a certificate: as long as that has not expired, the facet is in the cell that fv or vf
 * names, and has been there ever since the certificate was made. Certificates are numbered facets of P first, then
 * facets of Q. A facet that a region leaves out has one that never expires.
 *
 * A crossing of edge e of P (facets f⁻ left, f⁺ right) with halfedge h of Q (vector d, facets R right, L left) is
 * proven by four signs: s(f⁻, d) < 0 < s(f⁺, d) and s(e, R) < 0 < s(e, L). They place the ends of each arc on
 * opposite sides of the other's circle, and the orientation excludes the antipodal point. A crossing has no certificate
 * of its own: it has those of the four facets. Between two rotations R is taken to turn continuously, and two arcs that
 * cross cannot part before an end of one passes through the other, which is a facet that leaves its cell.
 */
#ifndef PIR_DYMSUM_PAIRING_TRACKED_H
#define PIR_DYMSUM_PAIRING_TRACKED_H

#include "base/layout.h"
#include "dymsum/certificate/certificates.h"
#include "dymsum/certificate/epoch.h"
#include "dymsum/certificate/expiry.h"
#include "dymsum/kernels/kernels.h"
#include "dymsum/pairing/journal.h"
#include "dymsum/pairing/pairing.h"

/*
 * In place of a stamp: the edge is inactive, left out by a region, and events do not change it. Greater than every
 * stamp.
 */
#define PIR_INACTIVE UINT32_MAX

/* The cells of P that the ends of an arc of Q are in, as far as a rebuild knows them from its crossings. */
typedef struct pir_arc_cells {
    uint32_t of[2]; /* of the facet with the smaller number, and of the other; or one of these in both: */
} pir_arc_cells;

#define PIR_MANY_CELLS UINT32_MAX       /* the arc has several crossings: it tells nothing */
#define PIR_ONE_CELL   (UINT32_MAX - 1) /* it has none: the two are in one cell */

/* The longest trace of a facet, and what stands in place of its length where its way is not certain. */
#define PIR_TRACE_LONGEST 8
#define PIR_TRACE_UNKNOWN UINT32_MAX

/* The sides that a facet has crossed in the last step, in order. */
typedef struct pir_trace {
    uint32_t from, cell; /* where it was before, and where it is */
    uint32_t count;      /* of sides, or PIR_TRACE_UNKNOWN */
    uint32_t signs;      /* compared for this */
    uint32_t crossed[PIR_TRACE_LONGEST];
} pir_trace;

/*
 * When more than one facet in so many has to be followed or located by descent, an update derives all edges: that is
 * less work than finding out which.
 */
#define PIR_MANY_OPEN 8

/* How many traces are made, at most, where there are so many certificates. */
static inline uint32_t pir_traces_most(uint32_t certificates) {
    return certificates / PIR_MANY_OPEN + 1;
}

/* Scratch of rebuilds and updates: nothing of it lasts from call to call. */
typedef struct pir_pairing_work {
    uint32_t *queue;       /* facets to visit, or edges */
    pir_arc_cells *met;    /* per edge of Q, see pir_arc_cells */
    pir_vec3 *rotated;     /* normals of P, rotated */
    pir_suspect *suspects; /* facets of Q that are back in an earlier cell, behind them what a review has listed */
    pir_suspect *passes;   /* facets of Q that have crossed arcs of P: as many as Q has facets, at most */
    pir_trace *traces;     /* of suspects */
    uint32_t facets_p, facets_q, edges; /* what there is room for */
} pir_pairing_work;

/* The sums' room in a thread's scratch (base/scratch.h). It grows to what the largest sum needs. */
typedef struct pir_sum_room {
    pir_signs_room signs;
    pir_rotation_integers shown; /* of a rotation that the pairing stays behind */
    pir_pairing_work work;
} pir_sum_room;

typedef struct pir_tracked {
    pir_pairing pairing; /* first, see dymsum/view.h */
    const pir_kernels *kernels;
    pir_epoch epoch;
    pir_step step; /* the last step, as kernels take it */
    pir_certificates certificates;
    uint64_t expired_in_epoch;     /* certificates that have expired in this epoch */
    pir_facets p_facets, q_facets; /* of each operand, over the cells of the other */
    pir_journal journal;
    uint32_t *touched;      /* per edge of P: the stamp of the last update that changed it, or PIR_INACTIVE */
    uint32_t stamp;         /* the last one given */
    pir_pairing_work *work; /* the thread's */
    pir_sum_statistics statistics;
} pir_tracked;

/* The sums' room in a scratch, for two more operands; NULL when out of memory. */
pir_sum_room *pir_sum_room_of(pir_scratch *scratch, const pir_polytope *p, const pir_polytope *q);

/*
 * Takes references to the operands and to the scratch, and makes all memory. There is no pairing yet.
 * pir_tracked_finish releases whatever is there, also after a failure. Errors: PIR_ERR_MEMORY and those of
 * pir_rotation_set.
 */
pir_status pir_tracked_init(pir_tracked *tracked, const pir_sum_parts *parts);
void pir_tracked_finish(pir_tracked *tracked);

/* Tells the kernels where the operands' arrays are: after an operand has been replaced. */
void pir_tracked_link_facets(pir_tracked *tracked);

/* Tells the kernels of the rotation and of the last step: before any facet is checked or certified. */
void pir_tracked_begin_step(pir_tracked *tracked);

/* Tells the kernels of the rotation alone. */
void pir_tracked_turn_facets(pir_tracked *tracked);

/* Files certificate i, made now. The previous cell of its facet is forgotten. */
void pir_tracked_certify(pir_tracked *tracked, uint32_t i, const pir_expiry *expiry);

/* Expires every certificate: the pairing is new. */
void pir_tracked_expire_all(pir_tracked *tracked);

/* Lays out certificates that have expired all at once: before any is looked at or filed. */
void pir_tracked_lay_out_certificates(pir_tracked *tracked);

static inline uint32_t pir_certificate_count(const pir_tracked *tracked) {
    return tracked->pairing.p->facet_count + tracked->pairing.q->facet_count;
}

/* The velocity of a rotated vector of P about the axis of the last step, and of a vector of Q seen from P. */
static inline pir_vec3 pir_motion_of(const pir_tracked *tracked, pir_vec3 rotated) {
    return pir_vec_cross(tracked->epoch.axis, rotated);
}

static inline pir_vec3 pir_motion_back(const pir_tracked *tracked, pir_vec3 turned_back) {
    const pir_mat3 *r = &tracked->pairing.signs.rotation.r;
    return pir_vec_cross(turned_back, pir_mat_apply_transposed(r, tracked->epoch.axis));
}

#endif

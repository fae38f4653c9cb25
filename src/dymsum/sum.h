/* SPDX-License-Identifier: MIT */
/*
 * The inside of a sum: the pairing, its certificates, and the predicates that both stand on.
 *
 * The Gaussian map of P, rotated, lies over that of Q. A facet of P is a point in the cell of a vertex of Q (fv); a facet of Q is a
 * point in the cell of a vertex of P (vf); the arc of an edge of P, from the facet left of its halfedge to the one right of it, leaves
 * cell after cell of Q through the arcs of Q's edges (ee).
 *
 * Invariants, at the rotation perturbed as in exact/sign.h, after every call that succeeds, of all features or those that a region
 * leaves active (region.c); others have PIR_NO_PAIR for a cell, no crossings, and alarms that never ring:
 *   - fv[f] is the vertex of Q farthest along the normal of f; vf[g] that of P farthest along the normal of g.
 *   - the crossings of edge e, from first[e] along next, name halfedges of Q: the first leaves fv[left], each later one leaves the vertex
 *     that the one before leads to, the last leads to fv[right]. Their number over all edges is ee_count.
 *   - a facet whose alarm (alarms.h) does not ring at the clock's time is in its cell, and has been ever since the alarm was set. Alarms
 *     are numbered facets of P first, then facets of Q.
 *
 * A crossing of edge e (vector e, facets f⁻ left, f⁺ right) and halfedge h (vector d, facets R right, L left) is proven by four signs:
 * s(f⁻, d) < 0 < s(f⁺, d) and s(e, R) < 0 < s(e, L). They place the two arcs' ends on opposite sides of each other's circles, and the
 * orientation rules out the antipodal point. Its certificate is those of the four facets: between two rotations R is taken to turn the
 * short way, and two arcs that cross cannot part before an end of one passes through the other, which is a facet leaving its cell.
 */
#ifndef PIR_DYMSUM_SUM_H
#define PIR_DYMSUM_SUM_H

#include <math.h>
#include <stdatomic.h>

#include <pirouette/cgm.h>
#include <pirouette/sum.h>

#include "base/memory.h"
#include "base/vec.h"
#include "dymsum/certificate/certificates.h"
#include "dymsum/certificate/epoch.h"
#include "dymsum/certificate/expiry.h"
#include "dymsum/kernels/kernels.h"
#include "dymsum/pairing/journal.h"
#include "dymsum/pairing/pairing.h"
#include "dymsum/region/region.h"
#include "dymsum/view.h"
#include "exact/sign.h"
#include "polytope/polytope.h"

/* What the choice between update and walk is made from: see choose.c. */
typedef struct pir_cost_model {
    double walk;       /* work of the last walk */
    double per_radian; /* work of recent updates per radian turned, 0 while none is known */
    uint32_t walks_in_a_row, updates_in_a_row;
    uint32_t probe_after; /* how many walks in a row before an update is tried */
} pir_cost_model;

#define PIR_LAG_KNOTS 4

/*
 * How far the pairing may stay behind the rotation that was asked for: see lag.c. While `lagging`, the pairing and the clock are at
 * the rotation in sum->pairing.signs, and what is seen is placed by `now`.
 */
typedef struct pir_lag {
    double tolerance; /* a length; 0: never behind */
    /* where there is a tolerance: up to an angle the support function falls short by a length at most; rising, the last length it */
    double angle[PIR_LAG_KNOTS], length[PIR_LAG_KNOTS];
    bool lagging;
    double bound;     /* while lagging: what the support function falls short of at most */
    pir_rotation now; /* while lagging: the rotation asked for */
} pir_lag;

/* In place of a stamp: nothing that happens to the edge is of interest, see region.c. Greater than every stamp. */
#define PIR_INACTIVE UINT32_MAX

struct pir_sum {
    pir_pairing pairing;      /* first, see pir_sum_pairing */
    atomic_uint references;   /* the caller's, and those of the queries and live meshes that stand on it */
    pir_polytope *made_of[2]; /* at scale 1, by pir_operand: the same objects until the scale is set */
    const pir_kernels *kernels;
    pir_epoch epoch;
    pir_step step; /* what the kernels need of it */
    pir_certificates certificates;
    uint64_t expired;                /* certificates, in this epoch */
    pir_facets p_facets, q_facets; /* each over the cells of the other */
    pir_journal journal;
    pir_suspect *suspects; /* facets of Q taken back, then what a review has listed */
    pir_suspect *passes;   /* facets of Q that have crossed arcs of P: as many as Q has facets, at most */
    pir_cost_model cost;
    pir_lag lag;
    pir_region region;
    pir_cgm *cgm_q; /* Q's cubical Gaussian map, from the first rebuild by CGM on */
    /* work space of a rebuild and an update: facets to visit, flags of facets and edges, rotated normals of P */
    uint32_t *queue;
    uint8_t *mark;
    uint32_t *touched,
        stamp; /* per edge of P: the stamp of the last update that changed it, or PIR_INACTIVE; the last given */
    pir_vec3 *rotated;
    pir_sum_statistics statistics;
};

/* --- predicates --- */

/* The sign of a value by doubles where the filter is certain of it, and counts it; else 0. */
static inline int pir_filtered(pir_sum *sum, double value) {
    int sign = pir_filter_sign(value);
    sum->pairing.signs.by_filter += sign != 0;
    return sign;
}

/* s of facet f of P, its normal rotated to `rotated`, and halfedge h of Q: the value by doubles, the sign exact. */
static inline int pir_sign_facet_half(pir_sum *sum, uint32_t f, pir_vec3 rotated, uint32_t h, double *ret_value) {
    *ret_value = pir_vec_dot(rotated, sum->pairing.q->direction[h]);
    int sign = pir_filtered(sum, *ret_value);
    if (sign != 0)
        return sign;
    pir_int3 n = pir_normal_exact(sum->pairing.p, f), d = pir_half_exact(sum->pairing.q, h);
    return pir_sign_perturbed(&sum->pairing.signs, &n, &d);
}

/* s of halfedge h of P, its direction rotated to `rotated`, and facet g of Q. */
static inline int pir_sign_half_facet(pir_sum *sum, uint32_t h, pir_vec3 rotated, uint32_t g, double *ret_value) {
    *ret_value = pir_vec_dot(rotated, sum->pairing.q->normal[g]);
    int sign = pir_filtered(sum, *ret_value);
    if (sign != 0)
        return sign;
    pir_int3 e = pir_half_exact(sum->pairing.p, h), n = pir_normal_exact(sum->pairing.q, g);
    return pir_sign_perturbed(&sum->pairing.signs, &e, &n);
}

/* The same, the facet's normal turned back into P's frame instead. */
static inline int pir_sign_facet_half_back(pir_sum *sum, uint32_t g, pir_vec3 turned_back, uint32_t h,
                                           double *ret_value) {
    *ret_value = pir_vec_dot(turned_back, sum->pairing.p->direction[h]);
    int sign = pir_filtered(sum, *ret_value);
    if (sign != 0)
        return sign;
    pir_int3 e = pir_half_exact(sum->pairing.p, h), n = pir_normal_exact(sum->pairing.q, g);
    return pir_sign_perturbed(&sum->pairing.signs, &e, &n);
}

static inline uint64_t pir_signs_asked(const pir_signs *signs) {
    return signs->by_filter + signs->by_exact + signs->by_perturbation;
}

/* A facet or edge of P rotated, a facet normal of Q turned back. */
static inline pir_vec3 pir_rotated_normal(const pir_sum *sum, uint32_t f) {
    return pir_mat_apply(&sum->pairing.signs.rotation.r, sum->pairing.p->normal[f]);
}

static inline pir_vec3 pir_rotated_direction(const pir_sum *sum, uint32_t h) {
    return pir_mat_apply(&sum->pairing.signs.rotation.r, sum->pairing.p->direction[h]);
}

static inline pir_vec3 pir_turned_back_normal(const pir_sum *sum, uint32_t g) {
    return pir_mat_apply_transposed(&sum->pairing.signs.rotation.r, sum->pairing.q->normal[g]);
}

/* How fast a vector of P, rotated, moves along the axis of the last step, and one of Q seen from P. */
static inline pir_vec3 pir_motion_of(const pir_sum *sum, pir_vec3 rotated) {
    return pir_vec_cross(sum->epoch.axis, rotated);
}

static inline pir_vec3 pir_motion_back(const pir_sum *sum, pir_vec3 turned_back) {
    return pir_vec_cross(turned_back, pir_mat_apply_transposed(&sum->pairing.signs.rotation.r, sum->epoch.axis));
}

/* The number of alarms. */
static inline uint32_t pir_certificate_count(const pir_sum *sum) {
    return sum->pairing.p->facet_count + sum->pairing.q->facet_count;
}

/* --- sum.c --- */

/* Called before a change, whether or not that succeeds: a failed call may lay the same pairing out in another way. */
static inline void pir_sum_changes(pir_sum *sum) {
    sum->pairing.generation++;
}

/* A sum at `rotation` with all its memory and no pairing yet; it takes references of its own. */
pir_status pir_sum_new(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_allocator *allocator,
                       pir_sum **ret_sum);

/* Tells the kernels where the operands' arrays are: after an operand has been replaced. */
void pir_sum_link_facets(pir_sum *sum);

/* --- lag.c --- */

/* Whether the pairing may stay where it is for `rotation`; then that is the rotation seen from here on. Errors as pir_sum_rotate. */
pir_status pir_lag_behind(pir_sum *sum, pir_quat rotation, bool *ret_done);

/* Measures the operands, whose scale may have changed. */
void pir_lag_measure(pir_sum *sum);

/* --- descent.c --- */

/*
 * The vertex of Q farthest along rotated facet f, from vertex `from` uphill: at each vertex the steepest edge that rises.
 */
uint32_t pir_descend_fv(pir_sum *sum, uint32_t f, pir_vec3 rotated, uint32_t from, pir_expiry *ret_expiry);

/* The vertex of P farthest along facet g of Q. */
uint32_t pir_descend_vf(pir_sum *sum, uint32_t g, uint32_t from, pir_expiry *ret_expiry);

/* --- trace.c --- */

#define PIR_TRACE_LONGEST 8

/* Steps of a greater angle are not followed: what such a step may have touched is nearly all. */
#define PIR_TRACE_FARTHEST 0.25

/* The way of a facet through the last step: the sides that it has crossed, in order, the cell where it is, and how long it stays there. */
typedef struct pir_trace {
    uint32_t count, crossed[PIR_TRACE_LONGEST], cell;
    pir_expiry expiry;
} pir_trace;

/* Follows facet f of P, or of Q, from the cell that is noted, where it was before the last step; false where that is too close to call. */
bool pir_trace_fv(pir_sum *sum, uint32_t f, pir_trace *ret_trace);
bool pir_trace_vf(pir_sum *sum, uint32_t g, pir_trace *ret_trace);

/* --- crossings.c --- */

/* Room for at least `capacity` slots; false when out of memory. Counts as an allocation when it grows. */
bool pir_crossings_reserve(pir_sum *sum, uint32_t capacity);
void pir_crossings_finish(pir_sum *sum);
void pir_crossings_clear(pir_sum *sum);

/* A slot for the crossing of edge e with halfedge h, not linked; PIR_NO_CROSSING when out of memory. */
uint32_t pir_crossing_new(pir_sum *sum, uint32_t e, uint32_t h);
void pir_crossing_free(pir_sum *sum, uint32_t slot);

/*
 * Links one more crossing, of edge e with halfedge h, behind *last, the end of the edge's list or PIR_NO_CROSSING, and makes it the
 * last. False when out of memory.
 */
bool pir_crossing_append(pir_sum *sum, uint32_t e, uint32_t h, uint32_t *last);

/* --- walk.c --- */

/*
 * The halfedge of Q through which the arc along halfedge h of P, rotated to `direction`, leaves the cell of vertex v. `entered` is
 * the halfedge that led into v, or PIR_NO_CROSSING when the arc starts there.
 */
uint32_t pir_leave_cell(pir_sum *sum, uint32_t h, pir_vec3 direction, uint32_t v, uint32_t entered);

/* Makes the whole pairing from nothing; certificates are left expired. On PIR_ERR_MEMORY the pairing is not usable. */
pir_status pir_walk_rebuild(pir_sum *sum);

/* --- cgm_rebuild.c --- */

/* Makes the pairing from the overlay of two cubical Gaussian maps. As above on PIR_ERR_MEMORY. */
pir_status pir_cgm_rebuild(pir_sum *sum);

/* --- repair.c --- */

/* The crossings of edge e are brought along with one event; false when out of memory. The arc's first cell, or its last, goes from the near
 * side of halfedge h of Q to the far one. */
bool pir_move_start(pir_sum *sum, uint32_t e, uint32_t h);
bool pir_move_end(pir_sum *sum, uint32_t e, uint32_t h);

/* Facet g of Q has crossed the arc and is now left of it, or right. */
bool pir_pass_facet(pir_sum *sum, uint32_t e, uint32_t g, bool to_left);

/* Leads the arc from its left cell, which is known, to its right one anew. */
bool pir_derive_edge(pir_sum *sum, uint32_t e);

/* --- update.c --- */

/*
 * Takes up the certificates whose alarms ring at the clock's phase and repairs what has failed, at the rotation in sum->pairing.signs. As above
 * on PIR_ERR_MEMORY.
 */
pir_status pir_update_repair(pir_sum *sum);

/* Lets every certificate expire: the pairing is fresh. */
void pir_expire_all(pir_sum *sum);

/* Tells the kernels of the rotation and of the last step: before anything is looked at, or falls asleep. */
void pir_begin_step(pir_sum *sum);

/* Files alarm i, checked now, to sleep so long. */
void pir_certify(pir_sum *sum, uint32_t i, const pir_expiry *expiry);

/* --- brute.c --- */

/* Makes the pairing by checking all pairs. As above on PIR_ERR_MEMORY. */
pir_status pir_brute_rebuild(pir_sum *sum);

#endif

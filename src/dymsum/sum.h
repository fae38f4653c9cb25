/* SPDX-License-Identifier: MIT */
/*
 * The inside of a sum: the pairing, its certificates, and the predicates that both stand on.
 *
 * The Gaussian map of P, rotated, lies over that of Q. A facet of P is a point in the cell of a vertex of Q (fv); a facet of Q is a
 * point in the cell of a vertex of P (vf); the arc of an edge of P, from the facet left of its halfedge to the one right of it, leaves
 * cell after cell of Q through the arcs of Q's edges (ee).
 *
 * Invariants, at the rotation perturbed as in exact/sign.h, after every call that succeeds:
 *   - fv[f] is the vertex of Q farthest along the normal of f; vf[g] that of P farthest along the normal of g.
 *   - the crossings of edge e, from first[e] along next, name halfedges of Q: the first leaves fv[left], each later one leaves the vertex
 *     that the one before leads to, the last leads to fv[right]. Their number over all edges is ee_count.
 *   - a pair whose `until` is above `turn` has not failed: it was checked when the turn was lower, and its margin held more.
 *
 * A crossing of edge e (vector e, facets f⁻ left, f⁺ right) and halfedge h (vector d, facets R right, L left) is proven by four signs:
 * s(f⁻, d) < 0 < s(f⁺, d) and s(e, R) < 0 < s(e, L). They place the two arcs' ends on opposite sides of each other's circles, and the
 * orientation rules out the antipodal point.
 */
#ifndef PIR_DYMSUM_SUM_H
#define PIR_DYMSUM_SUM_H

#include <math.h>

#include <pirouette/sum.h>

#include "base/memory.h"
#include "base/vec.h"
#include "exact/sign.h"
#include "polytope/polytope.h"

#define PIR_NO_CROSSING UINT32_MAX

/* `until` of a pair that must be looked at in the next update, and of a crossing known to have failed in this one. */
#define PIR_EXPIRED (-1.0)
#define PIR_FAILED  (-2.0)

/* Crossings live in slots of parallel arrays; free slots are chained through next. */
typedef struct pir_crossings {
    uint32_t *half;                /* the halfedge of Q that is crossed, from the cell before to the cell after */
    uint32_t *edge;                /* the edge of P, or PIR_NO_CROSSING in a free slot */
    uint32_t *next;                /* the next along the arc, or PIR_NO_CROSSING */
    double *until;                 /* the turn up to which it is certain */
    uint32_t capacity, used, free; /* slots [0, used) have been used; free heads the chain of those given back */
} pir_crossings;

/* What the choice between update and walk is made from: work counted in signs. */
typedef struct pir_cost_model {
    double walk;       /* signs of the last walk */
    double per_radian; /* signs of recent updates per radian turned */
    uint32_t walks_in_a_row;
} pir_cost_model;

struct pir_sum {
    pir_allocator allocator;
    pir_polytope *p, *q;
    pir_signs signs; /* holds the rotation */
    uint32_t *fv, *vf, *first;
    uint32_t ee_count;
    pir_crossings crossings;
    double turn; /* an upper bound on all turning since the last rebasing */
    double *fv_until, *vf_until;
    pir_cost_model cost;
    /* work space of a rebuild and an update: facets to visit, flags of facets and edges, rotated normals of P */
    uint32_t *queue;
    uint8_t *mark;
    pir_vec3 *rotated;
    pir_sum_statistics statistics;
};

/* --- predicates --- */

/* s of facet f of P, its normal rotated to `rotated`, and halfedge h of Q: the value by doubles, the sign exact. */
static inline int pir_sign_facet_half(pir_sum *sum, uint32_t f, pir_vec3 rotated, uint32_t h, double *ret_value) {
    *ret_value = pir_vec_dot(rotated, sum->q->direction[h]);
    int sign = pir_filter_sign(*ret_value);
    if (sign != 0) {
        sum->signs.by_filter++;
        return sign;
    }
    pir_int3 n = pir_normal_exact(sum->p, f), d = pir_half_exact(sum->q, h);
    return pir_sign_perturbed(&sum->signs, &n, &d);
}

/* s of halfedge h of P, its direction rotated to `rotated`, and facet g of Q. */
static inline int pir_sign_half_facet(pir_sum *sum, uint32_t h, pir_vec3 rotated, uint32_t g, double *ret_value) {
    *ret_value = pir_vec_dot(rotated, sum->q->normal[g]);
    int sign = pir_filter_sign(*ret_value);
    if (sign != 0) {
        sum->signs.by_filter++;
        return sign;
    }
    pir_int3 e = pir_half_exact(sum->p, h), n = pir_normal_exact(sum->q, g);
    return pir_sign_perturbed(&sum->signs, &e, &n);
}

/* The same, the facet's normal turned back into P's frame instead. */
static inline int pir_sign_facet_half_back(pir_sum *sum, uint32_t g, pir_vec3 turned_back, uint32_t h,
                                           double *ret_value) {
    *ret_value = pir_vec_dot(turned_back, sum->p->direction[h]);
    int sign = pir_filter_sign(*ret_value);
    if (sign != 0) {
        sum->signs.by_filter++;
        return sign;
    }
    pir_int3 e = pir_half_exact(sum->p, h), n = pir_normal_exact(sum->q, g);
    return pir_sign_perturbed(&sum->signs, &e, &n);
}

static inline uint64_t pir_signs_asked(const pir_signs *signs) {
    return signs->by_filter + signs->by_exact + signs->by_perturbation;
}

/* When a pair checked now with this margin must be looked at again: turn + margin, rounded down. */
static inline double pir_until(const pir_sum *sum, double margin) {
    double until = sum->turn + margin;
    return until - fabs(until) * 0x1p-52;
}

/* A facet or edge of P rotated, a facet normal of Q turned back. */
static inline pir_vec3 pir_rotated_normal(const pir_sum *sum, uint32_t f) {
    return pir_mat_apply(&sum->signs.rotation.r, sum->p->normal[f]);
}

static inline pir_vec3 pir_rotated_direction(const pir_sum *sum, uint32_t h) {
    return pir_mat_apply(&sum->signs.rotation.r, sum->p->direction[h]);
}

static inline pir_vec3 pir_turned_back_normal(const pir_sum *sum, uint32_t g) {
    return pir_mat_apply_transposed(&sum->signs.rotation.r, sum->q->normal[g]);
}

/* --- descent.c --- */

/*
 * The vertex of Q farthest along rotated facet f, from vertex `from` uphill: at each vertex the steepest edge that rises. *ret_margin is
 * the least |s| there, an angle less than which no turn can make the pair fail.
 */
uint32_t pir_descend_fv(pir_sum *sum, uint32_t f, pir_vec3 rotated, uint32_t from, double *ret_margin);

/* The vertex of P farthest along facet g of Q. */
uint32_t pir_descend_vf(pir_sum *sum, uint32_t g, uint32_t from, double *ret_margin);

/* --- crossings.c --- */

/* Room for at least `capacity` slots; false when out of memory. Counts as an allocation when it grows. */
bool pir_crossings_reserve(pir_sum *sum, uint32_t capacity);
void pir_crossings_clear(pir_sum *sum);

/* A slot for the crossing of edge e with halfedge h, not linked; PIR_NO_CROSSING when out of memory. */
uint32_t pir_crossing_new(pir_sum *sum, uint32_t e, uint32_t h);
void pir_crossing_free(pir_sum *sum, uint32_t slot);

/*
 * Whether crossing `slot` holds; when it does its certificate is renewed. The four signs of the head of this file.
 */
bool pir_crossing_check(pir_sum *sum, uint32_t slot);

/* --- walk.c --- */

/*
 * The halfedge of Q through which the arc along halfedge h of P, rotated to `direction`, leaves the cell of vertex v. `entered` is
 * the halfedge that led into v, or PIR_NO_CROSSING when the arc starts there.
 */
uint32_t pir_leave_cell(pir_sum *sum, uint32_t h, pir_vec3 direction, uint32_t v, uint32_t entered);

/* Makes the whole pairing from nothing; certificates are left expired. On PIR_ERR_MEMORY the pairing is not usable. */
pir_status pir_walk_rebuild(pir_sum *sum);

/* --- update.c --- */

/* Checks what has expired at the rotation in sum->signs and repairs what has failed. As above on PIR_ERR_MEMORY. */
pir_status pir_update_repair(pir_sum *sum);

/* Lets every certificate expire. */
void pir_expire_all(pir_sum *sum);

/* --- brute.c --- */

/* Makes the pairing by checking all pairs. As above on PIR_ERR_MEMORY. */
pir_status pir_brute_rebuild(pir_sum *sum);

#endif

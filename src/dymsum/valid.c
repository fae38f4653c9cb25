/* SPDX-License-Identifier: MIT */
/* The whole-structure check of a sum: its invariants (sum.h), every sign by exact arithmetic, no filter and no certificate trusted. */
#include "dymsum/sum.h"

/* s of a vector of P and one of Q at the perturbed rotation. */
static int sign_of(pir_sum *sum, pir_int3 a, pir_int3 b) {
    return pir_sign_perturbed(&sum->signs, &a, &b);
}

static bool fv_is_valid(pir_sum *sum) {
    const pir_polytope *p = sum->p, *q = sum->q;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        uint32_t v = sum->fv[f];
        if (v >= q->vertex_count)
            return false;
        for (uint32_t h = q->ring_start[v]; h < q->ring_start[v + 1]; h++)
            if (sign_of(sum, pir_normal_exact(p, f), pir_half_exact(q, h)) > 0)
                return false;
    }
    return true;
}

static bool vf_is_valid(pir_sum *sum) {
    const pir_polytope *p = sum->p, *q = sum->q;
    for (uint32_t g = 0; g < q->facet_count; g++) {
        uint32_t v = sum->vf[g];
        if (v >= p->vertex_count)
            return false;
        for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++)
            if (sign_of(sum, pir_half_exact(p, h), pir_normal_exact(q, g)) > 0)
                return false;
    }
    return true;
}

/* Whether halfedge h of Q, from one cell to the next, is crossed by the arc of halfedge `half` of P. */
static bool crosses(pir_sum *sum, uint32_t half, uint32_t h) {
    const pir_polytope *p = sum->p, *q = sum->q;
    pir_int3 e = pir_half_exact(p, half), d = pir_half_exact(q, h);
    return sign_of(sum, e, pir_normal_exact(q, pir_right(q, h))) < 0 &&
           sign_of(sum, e, pir_normal_exact(q, q->left[h])) > 0 &&
           sign_of(sum, pir_normal_exact(p, p->left[half]), d) < 0 &&
           sign_of(sum, pir_normal_exact(p, pir_right(p, half)), d) > 0;
}

static bool crossings_are_valid(pir_sum *sum) {
    const pir_polytope *p = sum->p, *q = sum->q;
    const pir_crossings *c = &sum->crossings;
    uint32_t count = 0;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t half = p->edge_half[e], v = sum->fv[p->left[half]];
        for (uint32_t slot = sum->first[e]; slot != PIR_NO_CROSSING; slot = c->next[slot]) {
            if (slot >= c->used || c->edge[slot] != e || ++count > sum->ee_count)
                return false;
            uint32_t h = c->half[slot];
            if (q->origin[h] != v || !crosses(sum, half, h))
                return false;
            v = q->target[h];
        }
        if (v != sum->fv[pir_right(p, half)])
            return false;
    }
    // the rest of the slots is free
    for (uint32_t slot = c->free; slot != PIR_NO_CROSSING; slot = c->next[slot])
        if (slot >= c->used || c->edge[slot] != PIR_NO_CROSSING || ++count > c->used)
            return false;
    return count == c->used;
}

int pir_sum_is_valid(pir_sum *sum) {
    return fv_is_valid(sum) && vf_is_valid(sum) && crossings_are_valid(sum);
}

/* SPDX-License-Identifier: MIT */
/*
 * The update: find the pairs whose certificates expired, check them, repair those that failed.
 *
 * Why a jump is safe: no normal moves farther on the sphere than R turns, so a pair that was certain by a margin is certain until the
 * turning since adds up to that margin. What expired is checked at the new rotation. Then every fv pair is right, every crossing that
 * is kept is real, and an edge none of whose crossings failed and whose ends stayed has a list that still leads from cell to cell:
 * cells being convex, that is all of its crossings.
 *
 * An edge with a failed crossing or a moved end is led from its left cell to its right one again. Where the crossing out of a cell is
 * known to be real it is the only one out of that cell and is kept, certificate and all; elsewhere the cell is searched.
 */
#include "dymsum/sum.h"

/* What an update notes of an edge of P, in sum->mark. */
enum { DIRTY = 2 };

void pir_expire_all(pir_sum *sum) {
    for (uint32_t f = 0; f < sum->p->facet_count; f++)
        sum->fv_until[f] = PIR_EXPIRED;
    for (uint32_t g = 0; g < sum->q->facet_count; g++)
        sum->vf_until[g] = PIR_EXPIRED;
    for (uint32_t i = 0; i < sum->crossings.used; i++)
        sum->crossings.until[i] = PIR_EXPIRED;
}

/* Notes edge e for re-derivation, once. */
static void note_edge(pir_sum *sum, uint32_t e, uint32_t *count) {
    if (sum->mark[e] & DIRTY)
        return;
    sum->mark[e] |= DIRTY;
    sum->queue[(*count)++] = e;
}

static void check_facets_of_p(pir_sum *sum, uint32_t *dirty) {
    const pir_polytope *p = sum->p;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        if (sum->fv_until[f] > sum->turn)
            continue;
        double margin;
        uint32_t v = pir_descend_fv(sum, f, pir_rotated_normal(sum, f), sum->fv[f], &margin);
        sum->statistics.checked++;
        sum->fv_until[f] = pir_until(sum, margin);
        if (v == sum->fv[f])
            continue;
        sum->fv[f] = v;
        sum->statistics.repaired++;
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
            note_edge(sum, p->edge[p->loop[i]], dirty);
    }
}

static void check_facets_of_q(pir_sum *sum) {
    for (uint32_t g = 0; g < sum->q->facet_count; g++) {
        if (sum->vf_until[g] > sum->turn)
            continue;
        double margin;
        uint32_t v = pir_descend_vf(sum, g, sum->vf[g], &margin);
        sum->statistics.checked++;
        sum->statistics.repaired += v != sum->vf[g];
        sum->vf_until[g] = pir_until(sum, margin);
        sum->vf[g] = v;
    }
}

static void check_crossings(pir_sum *sum, uint32_t *dirty) {
    pir_crossings *c = &sum->crossings;
    for (uint32_t i = 0; i < c->used; i++) {
        if (c->until[i] > sum->turn || c->edge[i] == PIR_NO_CROSSING)
            continue;
        sum->statistics.checked++;
        if (pir_crossing_check(sum, i))
            continue;
        c->until[i] = PIR_FAILED;
        sum->statistics.repaired++;
        note_edge(sum, c->edge[i], dirty);
    }
}

/* Takes from the list at *list the crossing out of cell v that holds, or gives PIR_NO_CROSSING. */
static uint32_t take_crossing(pir_sum *sum, uint32_t *list, uint32_t v) {
    pir_crossings *c = &sum->crossings;
    for (uint32_t *at = list; *at != PIR_NO_CROSSING; at = &c->next[*at]) {
        uint32_t slot = *at;
        if (c->until[slot] != PIR_FAILED && sum->q->origin[c->half[slot]] == v) {
            *at = c->next[slot];
            return slot;
        }
    }
    return PIR_NO_CROSSING;
}

/* Derives the crossings of edge e anew, keeping those that hold. */
static bool derive_edge(pir_sum *sum, uint32_t e) {
    const pir_polytope *p = sum->p, *q = sum->q;
    pir_crossings *c = &sum->crossings;
    uint32_t half = p->edge_half[e], end = sum->fv[pir_right(p, half)], v = sum->fv[p->left[half]];
    pir_vec3 direction = pir_rotated_direction(sum, half);
    uint32_t old = sum->first[e], last = PIR_NO_CROSSING, entered = PIR_NO_CROSSING;
    sum->first[e] = PIR_NO_CROSSING;
    while (v != end) {
        uint32_t slot = take_crossing(sum, &old, v);
        if (slot == PIR_NO_CROSSING) {
            slot = pir_crossing_new(sum, e, pir_leave_cell(sum, half, direction, v, entered));
            if (slot == PIR_NO_CROSSING)
                return false;
            bool holds = pir_crossing_check(sum, slot);
            PIR_ASSERT(holds);
            (void)holds;
        }
        c->next[slot] = PIR_NO_CROSSING;
        if (last == PIR_NO_CROSSING)
            sum->first[e] = slot;
        else
            c->next[last] = slot;
        last = slot;
        entered = c->half[slot];
        v = q->target[entered];
    }
    // what is left of the old list crosses no more
    while (old != PIR_NO_CROSSING) {
        uint32_t next = c->next[old];
        pir_crossing_free(sum, old);
        old = next;
    }
    return true;
}

pir_status pir_update_repair(pir_sum *sum) {
    for (uint32_t e = 0; e < sum->p->edge_count; e++)
        sum->mark[e] = 0;
    uint32_t dirty = 0;
    check_facets_of_p(sum, &dirty);
    check_facets_of_q(sum);
    check_crossings(sum, &dirty);
    for (uint32_t i = 0; i < dirty; i++)
        if (!derive_edge(sum, sum->queue[i]))
            return PIR_ERR_MEMORY;
    return PIR_OK;
}

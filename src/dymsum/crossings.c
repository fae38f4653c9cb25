/* SPDX-License-Identifier: MIT */
/*
 * The store of crossings, and the proof of one.
 *
 * Invariant: a slot below `used` is either linked from exactly one edge's list or on the free chain.
 */
#include "dymsum/sum.h"

bool pir_crossings_reserve(pir_sum *sum, uint32_t capacity) {
    pir_crossings *c = &sum->crossings;
    const pir_allocator *a = &sum->allocator;
    if (capacity <= c->capacity)
        return true;
    // one block after the other; what has grown already is kept for the next try
    uint32_t *half = PIR_RESIZE(a, c->half, c->capacity, capacity);
    c->half = half ? half : c->half;
    uint32_t *edge = half ? PIR_RESIZE(a, c->edge, c->capacity, capacity) : NULL;
    c->edge = edge ? edge : c->edge;
    uint32_t *next = edge ? PIR_RESIZE(a, c->next, c->capacity, capacity) : NULL;
    c->next = next ? next : c->next;
    double *until = next ? PIR_RESIZE(a, c->until, c->capacity, capacity) : NULL;
    c->until = until ? until : c->until;
    if (!until)
        return false;
    c->capacity = capacity;
    sum->statistics.allocations++;
    return true;
}

void pir_crossings_clear(pir_sum *sum) {
    for (uint32_t e = 0; e < sum->p->edge_count; e++)
        sum->first[e] = PIR_NO_CROSSING;
    sum->crossings.used = 0;
    sum->crossings.free = PIR_NO_CROSSING;
    sum->ee_count = 0;
}

uint32_t pir_crossing_new(pir_sum *sum, uint32_t e, uint32_t h) {
    pir_crossings *c = &sum->crossings;
    uint32_t slot = c->free;
    if (slot != PIR_NO_CROSSING) {
        c->free = c->next[slot];
    } else {
        if (c->used == c->capacity && (c->capacity > UINT32_MAX / 4 || !pir_crossings_reserve(sum, 2 * c->capacity)))
            return PIR_NO_CROSSING;
        slot = c->used++;
    }
    c->half[slot] = h;
    c->edge[slot] = e;
    c->next[slot] = PIR_NO_CROSSING;
    c->until[slot] = PIR_EXPIRED;
    sum->ee_count++;
    return slot;
}

void pir_crossing_free(pir_sum *sum, uint32_t slot) {
    pir_crossings *c = &sum->crossings;
    c->edge[slot] = PIR_NO_CROSSING;
    c->next[slot] = c->free;
    c->free = slot;
    sum->ee_count--;
}

bool pir_crossing_check(pir_sum *sum, uint32_t slot) {
    const pir_polytope *p = sum->p, *q = sum->q;
    uint32_t half = p->edge_half[sum->crossings.edge[slot]], h = sum->crossings.half[slot];
    uint32_t from = p->left[half], to = pir_right(p, half);
    double a, b, c, d;
    // the ends of Q's arc on either side of P's
    pir_vec3 direction = pir_rotated_direction(sum, half);
    if (pir_sign_half_facet(sum, half, direction, pir_right(q, h), &a) > 0 ||
        pir_sign_half_facet(sum, half, direction, q->left[h], &b) < 0)
        return false;
    // the ends of P's arc on either side of Q's
    if (pir_sign_facet_half(sum, from, pir_rotated_normal(sum, from), h, &c) > 0 ||
        pir_sign_facet_half(sum, to, pir_rotated_normal(sum, to), h, &d) < 0)
        return false;
    double margin = fmin(fmin(fabs(a), fabs(b)), fmin(fabs(c), fabs(d))) - PIR_SIGN_BOUND;
    sum->crossings.until[slot] = pir_until(sum, margin);
    return true;
}

/* SPDX-License-Identifier: MIT */
/*
 * The shapes of a body's facets, each found when a manifold first needs it, and kept for all that share the body.
 *
 * A shape depends on the body alone, so threads that find it at once find the same bits. Each number is kept by itself:
 * one that is not 0 is right, whatever the others are, and one that is 0 is found again.
 */
#ifndef PIR_QUERY_FRAME_FACET_SHAPE_H
#define PIR_QUERY_FRAME_FACET_SHAPE_H

#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The shape of a facet, in the frame, which contact/single.c reads. */
typedef struct pir_facet_shape {
    float fall;  /* the least sine by which an edge that leaves it falls from its plane */
    float thick; /* a corner stands out from the line through its neighbours by more */
    float wide;  /* it is wider than this part of its length */
    float apart; /* two corners are farther apart */
} pir_facet_shape;

#define PIR_SHAPE_NUMBERS 4

/* The bits of these numbers; zeros at first. */
typedef struct pir_kept_shape {
    _Atomic uint32_t bits[PIR_SHAPE_NUMBERS];
} pir_kept_shape;

static inline void pir_kept_shape_clear(pir_kept_shape *kept) {
    for (int i = 0; i < PIR_SHAPE_NUMBERS; i++)
        atomic_init(&kept->bits[i], 0);
}

/* One number; 0 where it is not known. */
static inline float pir_kept_number(pir_kept_shape *kept, int i) {
    uint32_t bits = atomic_load_explicit(&kept->bits[i], memory_order_relaxed);
    float number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

/* False where a number is not known. Numbers go one by one: all at once would wait until the four are in memory. */
static inline bool pir_kept_shape_get(pir_kept_shape *kept, pir_facet_shape *ret_shape) {
    pir_facet_shape shape = {pir_kept_number(kept, 0), pir_kept_number(kept, 1), pir_kept_number(kept, 2),
                             pir_kept_number(kept, 3)};
    *ret_shape = shape;
    // none is so small that the product of all were 0; one that is infinite makes no number of another that is 0
    return islessgreater((double)shape.fall * shape.thick * ((double)shape.wide * shape.apart), 0);
}

static inline void pir_kept_shape_set(pir_kept_shape *kept, const pir_facet_shape *shape) {
    uint32_t bits[PIR_SHAPE_NUMBERS];
    memcpy(bits, shape, sizeof bits);
    for (int i = 0; i < PIR_SHAPE_NUMBERS; i++)
        atomic_store_explicit(&kept->bits[i], bits[i], memory_order_relaxed);
}

#endif

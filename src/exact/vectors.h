/* SPDX-License-Identifier: MIT */
/*
 * Arrays of exact vectors: three integers each, at a fixed stride of limbs, in one block of the caller's allocator.
 */
#ifndef PIR_EXACT_VECTORS_H
#define PIR_EXACT_VECTORS_H

#include "base/memory.h"
#include "exact/integer.h"

typedef struct pir_vectors {
    mp_limb_t *limb; /* count · 3 · stride limbs */
    int32_t *size;   /* count · 3 signed lengths */
    uint32_t count, stride;
} pir_vectors;

/* Room for `count` zero vectors of `stride` limbs a component; false when out of memory. */
bool pir_vectors_init(pir_vectors *vectors, const pir_allocator *allocator, uint32_t count, uint32_t stride);
void pir_vectors_finish(pir_vectors *vectors, const pir_allocator *allocator);

/* Vector `index`, to read or to compute into; store the sizes back with pir_vectors_put after computing. */
static inline pir_int3 pir_vectors_at(const pir_vectors *vectors, uint32_t index) {
    pir_int3 v;
    for (uint32_t k = 0; k < 3; k++)
        v.c[k] = (pir_int){vectors->limb + ((size_t)index * 3 + k) * vectors->stride,
                           vectors->size[(size_t)index * 3 + k], vectors->stride};
    return v;
}

static inline void pir_vectors_put(pir_vectors *vectors, uint32_t index, const pir_int3 *v) {
    for (uint32_t k = 0; k < 3; k++)
        vectors->size[(size_t)index * 3 + k] = v->c[k].size;
}

/* Copies `v` into place `index`; it must fit the stride. */
void pir_vectors_set(pir_vectors *vectors, uint32_t index, const pir_int3 *v);

/* The most bits of a component. */
uint32_t pir_vectors_bits(const pir_vectors *vectors);

/* Divides all three components by their common power of two. */
void pir_int3_strip(pir_int3 *v);

/*
 * Divides each vector by the greatest common divisor of its components, and gives the block the stride that the longest
 * then takes. With GMP's memory beside the allocator's; false when out of memory.
 */
bool pir_vectors_reduce(pir_vectors *vectors, const pir_allocator *allocator);

/* The unit vector along v, which is not zero: within 8·2^-53 of the exact direction in Euclidean length. */
pir_vec3 pir_int3_unit(const pir_int3 *v);

/* A positive rational num/den that turns integers into coordinates. */
typedef struct pir_scale {
    pir_int num, den;
} pir_scale;

/* Copies a scale into memory of its own; false when out of memory, with *dst empty. */
bool pir_scale_copy(pir_scale *dst, const pir_allocator *allocator, const pir_scale *scale);
/* 2^exponent as a scale. */
bool pir_scale_init_power(pir_scale *dst, const pir_allocator *allocator, int exponent);
void pir_scale_finish(pir_scale *scale, const pir_allocator *allocator);

/* to = a·num/den in lowest terms; `to` is initialised. */
void pir_scale_to_rational(mpq_t to, const pir_int *a, const pir_scale *scale);

/* The double nearest to a·num/den: what a reader of the exact number would round to. */
double pir_scaled_nearest_double(const pir_int *a, const pir_int *num, const pir_int *den);

#endif

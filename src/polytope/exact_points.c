/* SPDX-License-Identifier: MIT */
/*
 * Points become integers on one scale. Doubles are integers times the power of two of their lowest set bit;
 * rationals are integers over the least common multiple of their denominators.
 */
#include "polytope/exact_points.h"

#include <limits.h>

/* The exponents of the lowest and above the highest set bit among all coordinates; 0 and 0 when all are zero. */
static void exponent_range(const pir_vec3 *points, size_t count, int *ret_low, int *ret_top) {
    int low = INT_MAX, top = INT_MIN;
    for (size_t i = 0; i < count; i++) {
        const double c[3] = {points[i].x, points[i].y, points[i].z};
        for (int k = 0; k < 3; k++) {
            int exponent;
            uint64_t mantissa = pir_double_split(c[k], &exponent);
            if (mantissa == 0)
                continue;
            int lowest = exponent + __builtin_ctzll(mantissa), highest = exponent + 64 - __builtin_clzll(mantissa);
            low = lowest < low ? lowest : low;
            top = highest > top ? highest : top;
        }
    }
    *ret_low = low <= top ? low : 0;
    *ret_top = low <= top ? top : 0;
}

pir_status pir_exact_points_of_doubles(struct pir_exact_points *exact, const pir_vec3 *points, size_t count,
                                       const pir_allocator *allocator) {
    int low, top;
    exponent_range(points, count, &low, &top);
    *exact = (struct pir_exact_points){0};
    // the coordinates as integers in units of 2^low
    if (!pir_scale_init_power(&exact->scale, allocator, low) ||
        !pir_vectors_init(&exact->vectors, allocator, (uint32_t)count, pir_double_limbs(top, low))) {
        pir_exact_points_finish(exact, allocator);
        return PIR_ERR_MEMORY;
    }
    for (uint32_t i = 0; i < count; i++) {
        pir_int3 v = pir_vectors_at(&exact->vectors, i);
        pir_int_set_double(&v.c[0], points[i].x, low);
        pir_int_set_double(&v.c[1], points[i].y, low);
        pir_int_set_double(&v.c[2], points[i].z, low);
        pir_vectors_put(&exact->vectors, i, &v);
    }
    return PIR_OK;
}

void pir_exact_points_finish(struct pir_exact_points *exact, const pir_allocator *allocator) {
    pir_vectors_finish(&exact->vectors, allocator);
    pir_scale_finish(&exact->scale, allocator);
}

/* The integer of a GMP integer, borrowed. */
static pir_int view_of(mpz_srcptr z) {
    return (pir_int){(mp_limb_t *)mpz_limbs_read(z), mpz_sgn(z) * (int32_t)mpz_size(z), 0};
}

/* The least common denominator; PIR_ERR_LIMIT where it or a coordinate over it is too long. */
static pir_status find_common(mpz_t common, const mpq_t *coordinates, size_t count) {
    mpz_set_ui(common, 1);
    for (size_t i = 0; i < 3 * count; i++) {
        mpz_lcm(common, common, mpq_denref(coordinates[i]));
        if (mpz_sizeinbase(common, 2) > PIR_SCALE_BITS_MAX)
            return PIR_ERR_LIMIT;
    }
    // a product has as many bits as its factors together, at most
    for (size_t i = 0; i < 3 * count; i++)
        if (mpz_sizeinbase(mpq_numref(coordinates[i]), 2) + mpz_sizeinbase(common, 2) > PIR_COORDINATE_BITS_MAX)
            return PIR_ERR_LIMIT;
    return PIR_OK;
}

/* coordinates · common, as integers. */
static bool scale_rationals(pir_vectors *exact, const pir_allocator *allocator, const mpq_t *coordinates, size_t count,
                            const mpz_t common) {
    // a product has as many limbs as its factors together, at most
    size_t longest = 1;
    for (size_t i = 0; i < 3 * count; i++) {
        size_t limbs = mpz_size(mpq_numref(coordinates[i])) + mpz_size(common);
        longest = limbs > longest ? limbs : longest;
    }
    if (!pir_vectors_init(exact, allocator, (uint32_t)count, (uint32_t)longest))
        return false;
    mpz_t scaled;
    mpz_init(scaled);
    for (uint32_t i = 0; i < count; i++) {
        pir_int3 v = pir_vectors_at(exact, i);
        for (uint32_t k = 0; k < 3; k++) {
            mpq_srcptr c = coordinates[(size_t)i * 3 + k];
            mpz_divexact(scaled, common, mpq_denref(c));
            mpz_mul(scaled, scaled, mpq_numref(c));
            pir_int whole = view_of(scaled);
            pir_int_copy(&v.c[k], &whole);
        }
        pir_vectors_put(exact, i, &v);
    }
    mpz_clear(scaled);
    return true;
}

pir_status pir_exact_points_of_rationals(struct pir_exact_points *exact, const mpq_t *coordinates, size_t count,
                                         const pir_allocator *allocator) {
    mpz_t common;
    mpz_init(common);
    *exact = (struct pir_exact_points){0};
    pir_status status = find_common(common, coordinates, count);
    mp_limb_t one_limb = 1;
    const pir_scale scale = {{&one_limb, 1, 0}, view_of(common)};
    if (status == PIR_OK && !(pir_scale_copy(&exact->scale, allocator, &scale) &&
                              scale_rationals(&exact->vectors, allocator, coordinates, count, common))) {
        pir_exact_points_finish(exact, allocator);
        status = PIR_ERR_MEMORY;
    }
    mpz_clear(common);
    return status;
}

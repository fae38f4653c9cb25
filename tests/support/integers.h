/* SPDX-License-Identifier: MIT */
/* The library's integers in tests: memory for them, and the way from GMP's and back. */
#ifndef PIR_TEST_INTEGERS_H
#define PIR_TEST_INTEGERS_H

#include "exact/integer.h"

/* Limbs enough for every integer that a test makes. */
#define TEST_LIMBS 192

/* An integer with memory of its own; start with test_int_init. */
typedef struct test_int {
    pir_int value;
    mp_limb_t limb[TEST_LIMBS];
} test_int;

typedef struct test_int3 {
    pir_int3 value;
    mp_limb_t limb[3][TEST_LIMBS];
} test_int3;

void test_int_init(test_int *a);
void test_int3_init(test_int3 *a);

void test_int_set(pir_int *a, mpz_t z);
void test_int_get(mpz_t z, const pir_int *a);

/* Whether a keeps its invariant and equals z. */
bool test_int_is(const pir_int *a, mpz_t z);

/* v·2^-exponent for a power of two that makes all three integers; the exponent is that of the lowest bit. */
void test_int3_set_doubles(test_int3 *a, double x, double y, double z);

#endif

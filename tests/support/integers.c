/* SPDX-License-Identifier: MIT */
/* See integers.h. */
#include "support/integers.h"

#include <math.h>
#include <stdlib.h>

void test_int_init(test_int *a) {
    a->value = (pir_int){a->limb, 0, TEST_LIMBS};
}

void test_int3_init(test_int3 *a) {
    for (int k = 0; k < 3; k++)
        a->value.c[k] = (pir_int){a->limb[k], 0, TEST_LIMBS};
}

void test_int_set(pir_int *a, mpz_t z) {
    size_t n = mpz_size(z);
    if (n > TEST_LIMBS)
        abort();
    for (size_t i = 0; i < n; i++)
        a->limb[i] = mpz_getlimbn(z, (mp_size_t)i);
    a->size = mpz_sgn(z) < 0 ? -(int32_t)n : (int32_t)n;
}

void test_int_get(mpz_t z, const pir_int *a) {
    mpz_import(z, pir_int_length(a), -1, sizeof(mp_limb_t), 0, 0, a->limb);
    if (a->size < 0)
        mpz_neg(z, z);
}

bool test_int_is(const pir_int *a, mpz_t z) {
    if (a->size != 0 && a->limb[pir_int_length(a) - 1] == 0)
        return false;
    mpz_t value;
    mpz_init(value);
    test_int_get(value, a);
    bool same = mpz_cmp(value, z) == 0;
    mpz_clear(value);
    return same;
}

void test_int3_set_doubles(test_int3 *a, double x, double y, double z) {
    const double c[3] = {x, y, z};
    mpz_t den, value;
    mpq_t rational[3];
    mpz_init_set_ui(den, 1);
    mpz_init(value);
    for (int k = 0; k < 3; k++) {
        mpq_init(rational[k]);
        mpq_set_d(rational[k], c[k]);
        mpz_lcm(den, den, mpq_denref(rational[k]));
    }
    test_int3_init(a);
    for (int k = 0; k < 3; k++) {
        mpz_divexact(value, den, mpq_denref(rational[k]));
        mpz_mul(value, value, mpq_numref(rational[k]));
        test_int_set(&a->value.c[k], value);
        mpq_clear(rational[k]);
    }
    mpz_clears(den, value, NULL);
}

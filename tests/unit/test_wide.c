/* SPDX-License-Identifier: MIT */
/* Integers of fixed length against GMP's own, with many carries and cancellations, up to the lengths they allow. */
#include "support/test.h"

#include <gmp.h>

#include "exact/wide.h"
#include "support/random.h"

#if PIR_HAVE_WIDE

#define CASES 3000

/* Up to `bits` bits, in runs of ones and zeros or any, with a sign. */
static pir_two_limbs random_two(test_random *random, uint32_t bits) {
    uint32_t shift = test_random_below(random, bits + 1);
    pir_two_limbs_unsigned size = (pir_two_limbs_unsigned)test_random_bits(random) << 64 | test_random_bits(random);
    if (test_random_below(random, 3) == 0)
        size = ~(pir_two_limbs_unsigned)0 << test_random_below(random, 100);
    size &= ((pir_two_limbs_unsigned)1 << (bits - shift)) - 1;
    return test_random_below(random, 2) ? -(pir_two_limbs)size : (pir_two_limbs)size;
}

static void set_two(mpz_t z, pir_two_limbs a) {
    const uint64_t limb[2] = {(uint64_t)(a < 0 ? -a : a), (uint64_t)((a < 0 ? -a : a) >> 64)};
    mpz_import(z, 2, -1, 8, 0, 0, limb);
    if (a < 0)
        mpz_neg(z, z);
}

/* An integer in two's complement. */
static void set_wide(mpz_t z, const mp_limb_t *limb, size_t count) {
    mpz_t top;
    mpz_import(z, count, -1, sizeof *limb, 0, 0, limb);
    if (limb[count - 1] >> 63) {
        mpz_init_set_ui(top, 1);
        mpz_mul_2exp(top, top, 64 * count);
        mpz_sub(z, z, top);
        mpz_clear(top);
    }
}

/* Sums of products of 92 bits, times 62, or of 44 times 110: up to 250, whose products stay below 2^511. */
static void check_case(test_random *random, pir_int256 v[3], mpz_t z[3], mpz_t a, mpz_t b) {
    for (int k = 0; k < 3; k++) {
        const bool wide = test_random_below(random, 2);
        v[k] = (pir_int256){{0}};
        mpz_set_ui(z[k], 0);
        for (int term = 0; term < 4; term++) {
            pir_two_limbs x = random_two(random, 92), y = random_two(random, wide ? 44 : 92);
            pir_int256_add_product(&v[k], x, y);
            set_two(a, x);
            set_two(b, y);
            mpz_addmul(z[k], a, b);
        }
        pir_two_limbs by = random_two(random, wide ? 110 : 62);
        pir_int256 scaled = {{0}};
        pir_int256_add_scaled(&scaled, &v[k], by);
        set_two(a, by);
        mpz_mul(z[k], z[k], a);
        v[k] = scaled;
        set_wide(a, v[k].limb, 4);
        assert_int_equal(mpz_cmp(a, z[k]), 0);
    }
}

static void sums_of_products_are_exact(void **state) {
    (void)state;
    test_random random = test_random_case("wide integers", 0);
    mpz_t z[2][3], a, b;
    mpz_inits(a, b, NULL);
    for (int i = 0; i < 6; i++)
        mpz_init(z[i / 3][i % 3]);
    for (int i = 0; i < CASES; i++) {
        pir_int256 v[2][3];
        for (int k = 0; k < 2; k++)
            check_case(&random, v[k], z[k], a, b);
        pir_int512 dot = pir_int256_dot(v[0], v[1]);
        mpz_set_ui(a, 0);
        for (int k = 0; k < 3; k++)
            mpz_addmul(a, z[0][k], z[1][k]);
        set_wide(b, dot.limb, 8);
        assert_int_equal(mpz_cmp(a, b), 0);
        assert_int_equal(pir_int512_sign(&dot), mpz_sgn(a));
        mp_limb_t limbs[8] = {0};
        size_t count;
        mpz_export(limbs, &count, -1, sizeof *limbs, 0, 0, a);
        pir_int same = {limbs, mpz_sgn(a) * (int32_t)count, 0};
        int e, f;
        double m = pir_int512_to_double(&dot, &e), n = pir_int_to_double(&same, &f);
        assert_true(m == n && e == f);
    }
    for (int i = 0; i < 6; i++)
        mpz_clear(z[i / 3][i % 3]);
    mpz_clears(a, b, NULL);
}

/* A longer number in 512 bits, and sums of dot products that are multiplied by one limb. */
static void products_with_one_limb_are_exact(void **state) {
    (void)state;
    test_random random = test_random_case("wide integers", 2);
    mpz_t z[3], a, b, c;
    mpz_inits(a, b, c, NULL);
    for (int k = 0; k < 3; k++)
        mpz_init(z[k]);
    for (int i = 0; i < CASES; i++) {
        pir_int256 v[3];
        pir_two_limbs two[3];
        pir_int512 sum;
        check_case(&random, v, z, a, b);
        mpz_set_ui(b, 0);
        for (int k = 0; k < 3; k++) {
            two[k] = random_two(&random, 126);
            set_two(a, two[k]);
            mpz_addmul(b, z[k], a);
        }
        const int64_t by = (int64_t)random_two(&random, 63);
        const pir_int512 dot = pir_int256_dot_two(v, two);
        pir_int512_set(&sum, &v[0]);
        set_wide(a, sum.limb, 8);
        assert_int_equal(mpz_cmp(a, z[0]), 0);
        pir_int512_add_scaled(&sum, &dot, by);
        set_two(a, by);
        mpz_addmul(z[0], b, a);
        set_wide(c, sum.limb, 8);
        assert_int_equal(mpz_cmp(c, z[0]), 0);
    }
    for (int k = 0; k < 3; k++)
        mpz_clear(z[k]);
    mpz_clears(a, b, c, NULL);
}

/* Zeros, ones and powers of two next to what fills a limb, of either sign, each with each. */
static void products_of_special_numbers_are_exact(void **state) {
    (void)state;
    pir_two_limbs special[60];
    size_t count = 0;
    static const uint32_t powers[] = {0, 1, 31, 32, 62, 63, 64, 65, 91};
    for (size_t i = 0; i < sizeof powers / sizeof *powers; i++)
        for (int by = -1; by <= 1; by++) {
            const pir_two_limbs number = ((pir_two_limbs)1 << powers[i]) + by;
            special[count++] = number;
            special[count++] = -number;
        }
    mpz_t a, b, z;
    mpz_inits(a, b, z, NULL);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < count; k++) {
            pir_int256 sum = {{0}};
            pir_int256_add_product(&sum, special[i], special[k]);
            set_two(a, special[i]);
            set_two(b, special[k]);
            mpz_mul(z, a, b);
            set_wide(b, sum.limb, 4);
            expect(mpz_cmp(z, b) == 0, "numbers %zu and %zu", i, k);
            // and once more, so that the sum is carried on
            pir_int256_add_product(&sum, special[k], special[k]);
            set_two(a, special[k]);
            mpz_addmul(z, a, a);
            set_wide(b, sum.limb, 4);
            expect(mpz_cmp(z, b) == 0, "numbers %zu and %zu, added", i, k);
        }
    mpz_clears(a, b, z, NULL);
}

static void products_with_two_limbs_are_exact(void **state) {
    (void)state;
    test_random random = test_random_case("wide integers", 1);
    mpz_t z[3], a, b, c;
    mpz_inits(a, b, c, NULL);
    for (int k = 0; k < 3; k++)
        mpz_init(z[k]);
    for (int i = 0; i < CASES; i++) {
        pir_int256 v[3];
        pir_two_limbs two[3];
        check_case(&random, v, z, a, b);
        mpz_set_ui(b, 0);
        mpz_set_ui(c, 0);
        for (int k = 0; k < 3; k++) {
            two[k] = random_two(&random, 126);
            set_two(a, two[k]);
            mpz_addmul(b, z[k], a);
            mpz_addmul(c, a, a);
        }
        pir_int512 dot = pir_int256_dot_two(v, two), square = pir_two_square(two);
        set_wide(a, dot.limb, 8);
        assert_int_equal(mpz_cmp(a, b), 0);
        set_wide(a, square.limb, 8);
        assert_int_equal(mpz_cmp(a, c), 0);
    }
    for (int k = 0; k < 3; k++)
        mpz_clear(z[k]);
    mpz_clears(a, b, c, NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_of_products_are_exact), cmocka_unit_test(products_of_special_numbers_are_exact),
        cmocka_unit_test(products_with_two_limbs_are_exact), cmocka_unit_test(products_with_one_limb_are_exact)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
#else
int main(void) {
    return 77;
}
#endif

/* SPDX-License-Identifier: MIT */
/* Integers over bare limbs against GMP's own integers, on random sizes, with many carries and cancellations. */
#include "support/test.h"

#include <math.h>

#include "exact/vectors.h"
#include "support/integers.h"
#include "support/random.h"

#define CASES 4000

/* Three operands in both forms, a result, scratch. */
struct operands {
    mpz_t a, b, c, r;
    test_int x, y, z;
    mp_limb_t limbs[4 * TEST_LIMBS];
    pir_limbs scratch;
};

/* A number of up to `limbs` limbs: runs of ones and zeros provoke carries. */
static void random_number(test_random *random, mpz_t z, uint32_t limbs) {
    uint32_t n = test_random_below(random, limbs + 1);
    mpz_set_ui(z, 0);
    for (uint32_t i = 0; i < n; i++) {
        uint64_t bits = test_random_bits(random);
        switch (test_random_below(random, 4)) {
        case 0:
            bits = UINT64_MAX;
            break;
        case 1:
            bits = 0;
            break;
        default:
            break;
        }
        mpz_mul_2exp(z, z, 64);
        mpz_t low;
        mpz_init(low);
        mpz_import(low, 1, -1, sizeof bits, 0, 0, &bits);
        mpz_add(z, z, low);
        mpz_clear(low);
    }
    if (test_random_below(random, 2))
        mpz_neg(z, z);
}

static void operands_init(struct operands *o) {
    mpz_inits(o->a, o->b, o->c, o->r, NULL);
    o->scratch = (pir_limbs){o->limbs, 0, 4 * TEST_LIMBS};
}

static void operands_clear(struct operands *o) {
    mpz_clears(o->a, o->b, o->c, o->r, NULL);
}

static void operands_draw(struct operands *o, test_random *random, uint32_t limbs) {
    random_number(random, o->a, limbs);
    random_number(random, o->b, limbs);
    random_number(random, o->c, limbs);
    // equal and nearly equal magnitudes, so that top limbs cancel
    if (test_random_below(random, 4) == 0) {
        mpz_set(o->b, o->a);
        if (test_random_below(random, 2))
            mpz_add_ui(o->b, o->b, 1);
        if (test_random_below(random, 2))
            mpz_neg(o->b, o->b);
    }
    test_int_init(&o->x);
    test_int_init(&o->y);
    test_int_init(&o->z);
    test_int_set(&o->x.value, o->a);
    test_int_set(&o->y.value, o->b);
    test_int_set(&o->z.value, o->c);
}

static void sums_differences_and_products_are_those_of_gmp(void **state) {
    (void)state;
    struct operands o;
    operands_init(&o);
    for (uint64_t i = 0; i < CASES; i++) {
        test_random random = test_random_case("integer arithmetic", i);
        operands_draw(&o, &random, 12);
        test_int r;
        test_int_init(&r);

        mpz_add(o.r, o.a, o.b);
        pir_int_add(&r.value, &o.x.value, &o.y.value);
        expect(test_int_is(&r.value, o.r), "case %llu", (unsigned long long)i);
        mpz_sub(o.r, o.a, o.b);
        pir_int_sub(&r.value, &o.x.value, &o.y.value);
        expect(test_int_is(&r.value, o.r), "case %llu", (unsigned long long)i);
        mpz_mul(o.r, o.a, o.b);
        pir_int_mul(&r.value, &o.x.value, &o.y.value);
        expect(test_int_is(&r.value, o.r), "case %llu", (unsigned long long)i);

        // in place, and with a product on top
        mpz_set(o.r, o.a);
        mpz_addmul(o.r, o.b, o.c);
        pir_int_copy(&r.value, &o.x.value);
        pir_int_add_mul(&r.value, &o.y.value, &o.z.value, &o.scratch);
        expect(test_int_is(&r.value, o.r), "case %llu", (unsigned long long)i);
        mpz_submul(o.r, o.a, o.c);
        pir_int_sub_mul(&r.value, &o.x.value, &o.z.value, &o.scratch);
        expect(test_int_is(&r.value, o.r), "case %llu", (unsigned long long)i);
        expect(o.scratch.used == 0, "case %llu", (unsigned long long)i);
        pir_int_sub(&r.value, &r.value, &o.y.value);
        mpz_sub(o.r, o.r, o.b);
        expect(test_int_is(&r.value, o.r), "case %llu", (unsigned long long)i);

        assert_int_equal(pir_int_sign(&o.x.value), mpz_sgn(o.a));
    }
    operands_clear(&o);
}

static void shifts_and_bit_counts_are_those_of_gmp(void **state) {
    (void)state;
    struct operands o;
    operands_init(&o);
    for (uint64_t i = 0; i < CASES; i++) {
        test_random random = test_random_case("integer shifts", i);
        operands_draw(&o, &random, 8);
        uint32_t bits =
            test_random_below(&random, 3) ? test_random_below(&random, 300) : 64 * test_random_below(&random, 5);
        mpz_mul_2exp(o.r, o.a, bits);
        pir_int_shift_left(&o.x.value, &o.x.value, bits);
        expect(test_int_is(&o.x.value, o.r), "case %llu", (unsigned long long)i);
        assert_int_equal(pir_int_bits(&o.x.value), mpz_sgn(o.r) ? mpz_sizeinbase(o.r, 2) : 0);
        uint32_t zeros = mpz_sgn(o.r) ? (uint32_t)mpz_scan1(o.r, 0) : UINT32_MAX;
        assert_int_equal(pir_int_trailing_zeros(&o.x.value), zeros);
        if (zeros != UINT32_MAX) {
            mpz_tdiv_q_2exp(o.r, o.r, zeros);
            pir_int_shift_right(&o.x.value, zeros);
            expect(test_int_is(&o.x.value, o.r), "case %llu", (unsigned long long)i);
        }
    }
    operands_clear(&o);
}

static void doubles_of_any_size_become_integers_and_back(void **state) {
    (void)state;
    for (uint64_t i = 0; i < CASES; i++) {
        test_random random = test_random_case("integer doubles", i);
        double x = test_random_below(&random, 8) ? test_random_scaled(&random, -1074, 1023) : 0;
        int top = 0;
        frexp(x, &top);
        int exponent = -1074 - (int)test_random_below(&random, 3);
        test_int a;
        test_int_init(&a);
        assert_true(pir_double_limbs(top, exponent) <= TEST_LIMBS);
        // whatever it was before
        a.value.size = test_random_between(&random, -2, 2);
        pir_int_set_double(&a.value, x, exponent);
        assert_true(pir_int_length(&a.value) <= pir_double_limbs(top, exponent));

        // exactly x / 2^exponent
        mpq_t exact;
        mpz_t z;
        mpq_init(exact);
        mpz_init(z);
        mpq_set_d(exact, x);
        mpq_mul_2exp(exact, exact, (mp_bitcnt_t)-exponent);
        mpz_set(z, mpq_numref(exact));
        expect(mpz_cmp_ui(mpq_denref(exact), 1) == 0 && test_int_is(&a.value, z), "case %llu", (unsigned long long)i);

        int e;
        double m = pir_int_to_double(&a.value, &e);
        expect(x == 0 ? m == 0 && e == 0 : fabs(m) >= 0.5 && fabs(m) < 1, "case %llu: %g", (unsigned long long)i, m);
        expect(ldexp(m, e + exponent) == x, "case %llu: %a", (unsigned long long)i, x);
        mpq_clear(exact);
        mpz_clear(z);
    }
}

static void large_integers_become_doubles_within_the_stated_bound(void **state) {
    (void)state;
    struct operands o;
    mpf_t exact, near, bound;
    operands_init(&o);
    mpf_init2(exact, 1024);
    mpf_init2(near, 1024);
    mpf_init2(bound, 1024);
    for (uint64_t i = 0; i < CASES; i++) {
        test_random random = test_random_case("integer rounding", i);
        operands_draw(&o, &random, 8);
        if (mpz_sgn(o.a) == 0)
            continue;
        int e;
        double m = pir_int_to_double(&o.x.value, &e);
        mpf_set_z(exact, o.a);
        mpf_set_d(near, m);
        mpf_mul_2exp(near, near, (mp_bitcnt_t)e);
        mpf_sub(near, near, exact);
        mpf_abs(near, near);
        mpf_set_d(bound, 1.001 * 0x1p-53);
        mpf_mul(bound, bound, exact);
        mpf_abs(bound, bound);
        expect(mpf_cmp(near, bound) <= 0, "case %llu", (unsigned long long)i);
    }
    mpf_clears(exact, near, bound, NULL);
    operands_clear(&o);
}

static void cross_and_dot_products_are_exact(void **state) {
    (void)state;
    for (uint64_t i = 0; i < CASES / 4; i++) {
        test_random random = test_random_case("integer vectors", i);
        mpz_t a[3], b[3], r;
        test_int3 x, y, c;
        test_int d;
        mp_limb_t limbs[4 * TEST_LIMBS];
        pir_limbs scratch = {limbs, 0, 4 * TEST_LIMBS};
        test_int3_init(&x);
        test_int3_init(&y);
        test_int3_init(&c);
        test_int_init(&d);
        mpz_init(r);
        for (int k = 0; k < 3; k++) {
            mpz_inits(a[k], b[k], NULL);
            random_number(&random, a[k], 6);
            random_number(&random, b[k], 6);
            test_int_set(&x.value.c[k], a[k]);
            test_int_set(&y.value.c[k], b[k]);
        }
        pir_int3_cross(&c.value, &x.value, &y.value, &scratch);
        pir_int3_dot(&d.value, &x.value, &y.value, &scratch);
        for (int k = 0; k < 3; k++) {
            mpz_mul(r, a[(k + 1) % 3], b[(k + 2) % 3]);
            mpz_submul(r, a[(k + 2) % 3], b[(k + 1) % 3]);
            expect(test_int_is(&c.value.c[k], r), "case %llu", (unsigned long long)i);
        }
        mpz_mul(r, a[0], b[0]);
        mpz_addmul(r, a[1], b[1]);
        mpz_addmul(r, a[2], b[2]);
        expect(test_int_is(&d.value, r), "case %llu", (unsigned long long)i);
        for (int k = 0; k < 3; k++)
            mpz_clears(a[k], b[k], NULL);
        mpz_clear(r);
    }
}

/* Vectors lose the common factor of their components, and their array the limbs that none needs. */
static void vectors_are_divided_by_what_their_components_share(void **state) {
    (void)state;
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    static const double given[][3] = {{6, -10, 14}, {0, 0, -7}, {0x1p+100, 0, 0x1p+101}, {3, 5, 7}, {0, 0, 0}},
                        reduced[][3] = {{3, -5, 7}, {0, 0, -1}, {1, 0, 2}, {3, 5, 7}, {0, 0, 0}};
    pir_vectors vectors;
    assert_true(pir_vectors_init(&vectors, &allocator, 5, 4));
    for (uint32_t i = 0; i < 5; i++) {
        pir_int3 v = pir_vectors_at(&vectors, i);
        for (int k = 0; k < 3; k++)
            pir_int_set_double(&v.c[k], given[i][k], 0);
        pir_vectors_put(&vectors, i, &v);
    }
    assert_true(pir_vectors_bits(&vectors) == 102);
    assert_true(pir_vectors_reduce(&vectors, &allocator));
    assert_true(vectors.count == 5 && vectors.stride == 1 && pir_vectors_bits(&vectors) == 3);
    for (uint32_t i = 0; i < 5; i++) {
        pir_int3 v = pir_vectors_at(&vectors, i);
        for (int k = 0; k < 3; k++) {
            int exponent;
            double x = pir_int_to_double(&v.c[k], &exponent);
            expect(ldexp(x, exponent) == reduced[i][k], "vector %u, component %d: %g", i, k, ldexp(x, exponent));
        }
    }
    pir_vectors_finish(&vectors, &allocator);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_differences_and_products_are_those_of_gmp),
        cmocka_unit_test(shifts_and_bit_counts_are_those_of_gmp),
        cmocka_unit_test(doubles_of_any_size_become_integers_and_back),
        cmocka_unit_test(vectors_are_divided_by_what_their_components_share),
        cmocka_unit_test(large_integers_become_doubles_within_the_stated_bound),
        cmocka_unit_test(cross_and_dot_products_are_exact),
    };
    return cmocka_run_group_tests_name("integer", tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/* The double nearest to a·num/den, ties to even, held against its two neighbours by rationals: over all of the range,
   and beyond both ends of it. And square roots, rounded up. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include "exact/vectors.h"
#include "polytope/create/merge.h"
#include "support/integers.h"
#include "support/random.h"

/* a·num/den in the library's form. */
struct number {
    test_int a, num, den;
};

static double nearest(struct number *number, const mpq_t value, const mpz_t factor) {
    mpz_t whole;
    mpz_init(whole);
    test_int_init(&number->a);
    test_int_init(&number->num);
    test_int_init(&number->den);
    // split somehow between the three: value = (p/f)·(f)/q when f divides p
    if (mpz_divisible_p(mpq_numref(value), factor)) {
        mpz_divexact(whole, mpq_numref(value), factor);
        test_int_set(&number->a.value, whole);
        mpz_set(whole, factor);
    } else {
        test_int_set(&number->a.value, (mpz_ptr)mpq_numref(value));
        mpz_set_ui(whole, 1);
    }
    test_int_set(&number->num.value, whole);
    test_int_set(&number->den.value, (mpz_ptr)mpq_denref(value));
    mpz_clear(whole);
    return pir_scaled_nearest_double(&number->a.value, &number->num.value, &number->den.value);
}

static bool is_even(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits % 2 == 0;
}

/* The middle of two doubles, 2^1024 standing for the one after the last. */
static void middle_of(mpq_t middle, double a, double b) {
    mpq_t other;
    mpq_init(other);
    mpq_set_d(middle, isinf(a) ? copysign(0x1p1023, a) : a);
    mpq_set_d(other, isinf(b) ? copysign(0x1p1023, b) : b);
    if (isinf(a))
        mpq_mul_2exp(middle, middle, 1);
    if (isinf(b))
        mpq_mul_2exp(other, other, 1);
    mpq_add(middle, middle, other);
    mpq_div_2exp(middle, middle, 1);
    mpq_clear(other);
}

/* Whether d is the double nearest to value. */
static bool is_nearest(double d, const mpq_t value) {
    mpq_t middle;
    mpq_init(middle);
    bool right = true;
    for (int side = -1; side <= 1; side += 2) {
        double next = nextafter(d, side * HUGE_VAL);
        if (next == d)
            continue;
        middle_of(middle, d, next);
        int order = mpq_cmp(value, middle) * side;
        // beyond the middle another one is nearer; on it the even one of the two is meant
        right = right && (order < 0 || (order == 0 && is_even(d)));
    }
    mpq_clear(middle);
    return right;
}

/* value: a double of exponent `exponent`, or the middle of two, perhaps slightly more or less. */
static void draw(test_random *random, mpq_t value) {
    static const int ends[] = {-1080, -1075, -1074, -1073, -1050, -1022, -1021, 0, 1, 1022, 1023};
    uint32_t kind = test_random_below(random, 4);
    int exponent =
        test_random_below(random, 2) ? ends[test_random_below(random, 11)] : test_random_between(random, -1090, 1023);
    mpz_t mantissa;
    mpz_init_set_ui(mantissa, (unsigned long)(test_random_bits(random) >> 11 | UINT64_C(1) << 52));
    if (kind == 1)
        mpz_set_ui(mantissa, UINT64_C(1) << 52);
    if (kind == 2)
        mpz_set_ui(mantissa, (UINT64_C(1) << 53) - 1);
    if (kind == 3)
        mpz_set_ui(mantissa, 1 + test_random_below(random, 100));
    // in units of half a last place; few bits at the low end, where doubles have few
    mpz_mul_2exp(mantissa, mantissa, 1);
    mpz_add_ui(mantissa, mantissa, test_random_below(random, 2));
    mpq_set_z(value, mantissa);
    int shift = exponent - (int)mpz_sizeinbase(mantissa, 2) + 1;
    shift >= 0 ? mpq_mul_2exp(value, value, (mp_bitcnt_t)shift) : mpq_div_2exp(value, value, (mp_bitcnt_t)-shift);
    uint32_t nudge = test_random_below(random, 3);
    if (nudge > 0) {
        mpq_t part;
        mpq_init(part);
        mpq_div_2exp(part, value, 60 + test_random_below(random, 200));
        nudge == 1 ? mpq_add(value, value, part) : mpq_sub(value, value, part);
        mpq_clear(part);
    }
    // of no power of two, too
    if (test_random_below(random, 4) == 0) {
        mpq_t third;
        mpq_init(third);
        mpq_set_ui(third, 1 + test_random_below(random, 1000), 999);
        mpq_canonicalize(third);
        mpq_mul(value, value, third);
        mpq_clear(third);
    }
    if (test_random_below(random, 2))
        mpq_neg(value, value);
    mpz_clear(mantissa);
}

static void doubles_are_the_nearest_ones(void **state) {
    (void)state;
    mpq_t value;
    mpz_t factor;
    mpq_init(value);
    mpz_init(factor);
    uint32_t subnormal = 0, infinite = 0, zero = 0;
    for (uint64_t i = 0; i < 20000; i++) {
        test_random random = test_random_case("nearest", i);
        struct number number;
        draw(&random, value);
        mpz_set_ui(factor, i % 3 ? 2 : 3);
        mpz_pow_ui(factor, factor, i % 7);
        double d = nearest(&number, value, factor);
        expect(is_nearest(d, value), "case %llu: %a", (unsigned long long)i, d);
        subnormal += d != 0 && fabs(d) < 0x1p-1022;
        infinite += isinf(d) != 0;
        zero += d == 0;
    }
    print_message("# %u subnormal, %u infinite, %u zero\n", subnormal, infinite, zero);
    assert_true(subnormal > 1000 && infinite > 20 && zero > 200);
    mpz_clear(factor);
    mpq_clear(value);
}

static void zero_is_zero(void **state) {
    (void)state;
    struct number number;
    mpq_t value;
    mpz_t factor;
    mpq_init(value);
    mpz_init_set_ui(factor, 1);
    double d = nearest(&number, value, factor);
    assert_true(d == 0 && !signbit(d));
    mpz_clear(factor);
    mpq_clear(value);
}

/* Roots of squares from denormal to huge: at least the true ones, and but a few units in the last place above. */
static void roots_are_rounded_up_by_a_little(void **state) {
    (void)state;
    mpq_t square, root;
    mpq_inits(square, root, NULL);
    assert_true(pir_root_rounded_up(square) == 0);
    for (uint64_t i = 0; i < 400; i++) {
        test_random random = test_random_case("roots", i);
        // a double, its square, and a square with a third more
        double exact = fabs(test_random_scaled(&random, -1040, 1000));
        mpq_set_d(square, exact);
        mpq_mul(square, square, square);
        if (i % 2) {
            mpq_set_si(root, 4, 3);
            mpq_mul(square, square, root);
        }
        double up = pir_root_rounded_up(square), below = up;
        for (int k = 0; k < 4; k++)
            below = nextafter(below, 0);
        mpq_set_d(root, up);
        mpq_mul(root, root, root);
        expect(mpq_cmp(root, square) >= 0, "case %llu: %a is too little", (unsigned long long)i, up);
        mpq_set_d(root, below);
        mpq_mul(root, root, root);
        expect(mpq_cmp(root, square) <= 0, "case %llu: %a is too much", (unsigned long long)i, up);
    }
    mpq_clears(square, root, NULL);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(doubles_are_the_nearest_ones),
        cmocka_unit_test(zero_is_zero),
        cmocka_unit_test(roots_are_rounded_up_by_a_little),
    };
    return cmocka_run_group_tests_name("nearest", tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/*
 * The sign of s(n, e), three stages: the double filter within its proven bound, exact integers, ties settled as a real,
 * really tiny perturbation settles them.
 */
#include "support/test.h"

#include <math.h>

#include "exact/sign.h"
#include "oracle/perturbed.h"
#include "support/bodies.h"
#include "support/integers.h"

/* A question: two vectors in the library's form and the oracle's, and a rotation. */
struct question {
    test_int3 a, b;
    oracle_vec exact_a, exact_b;
    pir_quat q;
    pir_signs signs;
    pir_signs_room room;
};

static void question_init(struct question *question, const pir_allocator *allocator) {
    oracle_vec_init(question->exact_a);
    oracle_vec_init(question->exact_b);
    question->room = (pir_signs_room){.scratch = {0}};
    assert_int_equal(pir_signs_reserve(&question->room, allocator, TEST_LIMBS, TEST_LIMBS), PIR_OK);
    pir_signs_init(&question->signs, &question->room);
}

static void question_clear(struct question *question, const pir_allocator *allocator) {
    pir_signs_room_finish(&question->room, allocator);
    oracle_vec_clear(question->exact_b);
    oracle_vec_clear(question->exact_a);
}

static void question_set(struct question *question, pir_quat q, const double a[3], const double b[3]) {
    question->q = q;
    test_int3_set_doubles(&question->a, a[0], a[1], a[2]);
    test_int3_set_doubles(&question->b, b[0], b[1], b[2]);
    for (int k = 0; k < 3; k++) {
        test_int_get(question->exact_a[k], &question->a.value.c[k]);
        test_int_get(question->exact_b[k], &question->b.value.c[k]);
    }
    assert_int_equal(pir_rotation_set(&question->signs.rotation, q), PIR_OK);
}

/* Components of one magnitude, of mixed ones between 1e-150 and 1e150, or small integers; not zero. */
static void random_vector(test_random *random, double v[3]) {
    int shift = test_random_between(random, -450, 450);
    switch (test_random_below(random, 3)) {
    case 0:
        for (int k = 0; k < 3; k++)
            v[k] = ldexp(test_random_unit(random), shift);
        break;
    case 1:
        for (int k = 0; k < 3; k++)
            v[k] = test_random_scaled(random, -498, 498);
        break;
    default:
        for (int k = 0; k < 3; k++)
            v[k] = test_random_between(random, -2, 2);
        break;
    }
    if (v[0] == 0 && v[1] == 0 && v[2] == 0)
        v[test_random_below(random, 3)] = 1;
}

/* b within rounding of a right angle to the rotated a. */
static void nearly_orthogonal(test_random *random, const struct question *question, double b[3]) {
    pir_vec3 turned = pir_mat_apply(&question->signs.rotation.r, pir_int3_unit(&question->a.value));
    pir_vec3 across = pir_vec_cross(turned, test_random_direction(random));
    b[0] = across.x;
    b[1] = across.y;
    b[2] = across.z;
    if (b[0] == 0 && b[1] == 0 && b[2] == 0)
        b[0] = 1;
}

/* A random question: of any magnitudes, nearly or exactly degenerate in two cases of three. */
static void question_draw(struct question *question, test_random *random) {
    double a[3], b[3];
    random_vector(random, a);
    random_vector(random, b);
    question_set(question, test_rotation(random), a, b);
    if (test_random_below(random, 3) == 0) {
        nearly_orthogonal(random, question, b);
        question_set(question, question->q, a, b);
    }
}

/* The value that the filter looks at. */
static double filter_value(const struct question *question) {
    pir_vec3 a = pir_int3_unit(&question->a.value), b = pir_int3_unit(&question->b.value);
    return pir_vec_dot(pir_mat_apply(&question->signs.rotation.r, a), b);
}

/* |value − s/(|a||b|)|, to 400 bits. */
static double filter_error(struct question *question, double value) {
    oracle_quat q;
    oracle_vec turned;
    mpz_t s, square, unit, length;
    mpf_t exact, root;
    oracle_quat_init(q, question->q);
    oracle_vec_init(turned);
    mpz_inits(s, square, unit, length, NULL);
    mpf_init2(exact, 400);
    mpf_init2(root, 400);
    oracle_turn(turned, q, question->exact_a);
    oracle_dot(s, turned, question->exact_b);
    // |q|²·|a|·|b| as the root of the product of squares
    for (int k = 0; k < 4; k++)
        mpz_addmul(unit, q[k], q[k]);
    oracle_dot(square, question->exact_a, question->exact_a);
    oracle_dot(length, question->exact_b, question->exact_b);
    mpz_mul(square, square, length);
    mpf_set_z(root, square);
    mpf_sqrt(root, root);
    mpf_set_z(exact, unit);
    mpf_mul(root, root, exact);
    mpf_set_z(exact, s);
    mpf_div(exact, exact, root);
    mpf_set_d(root, value);
    mpf_sub(exact, exact, root);
    double error = fabs(mpf_get_d(exact));
    mpf_clears(exact, root, NULL);
    mpz_clears(s, square, unit, length, NULL);
    oracle_vec_clear(turned);
    oracle_quat_clear(q);
    return error;
}

static pir_allocator from_malloc(void) {
    return pir_allocator_or_default(NULL);
}

static void filter_is_within_its_bound_and_never_wrong(void **state) {
    (void)state;
    pir_allocator allocator = from_malloc();
    struct question question;
    double worst = 0;
    uint32_t decided = 0, left = 0;
    question_init(&question, &allocator);
    for (uint64_t i = 0; i < 5000; i++) {
        test_random random = test_random_case("sign filter", i);
        question_draw(&question, &random);
        double value = filter_value(&question), error = filter_error(&question, value);
        worst = fmax(worst, error);
        expect(error < PIR_SIGN_BOUND, "case %llu: off by %g", (unsigned long long)i, error);
        int sign = pir_filter_sign(value);
        if (sign == 0) {
            left++;
            continue;
        }
        decided++;
        expect(sign == pir_sign_true(&question.signs, &question.a.value, &question.b.value), "case %llu",
               (unsigned long long)i);
    }
    print_message("# largest error of the filter: %.2f of 64 units of 2^-53; it left %u of %u open\n", worst * 0x1p53,
                  left, left + decided);
    // the cases must be of both kinds, else this proves little
    assert_true(left > 100 && decided > 1000);
    question_clear(&question, &allocator);
}

static void exact_sign_is_that_of_rational_arithmetic(void **state) {
    (void)state;
    pir_allocator allocator = from_malloc();
    struct question question;
    uint32_t count[3] = {0, 0, 0};
    question_init(&question, &allocator);
    for (uint64_t i = 0; i < 5000; i++) {
        test_random random = test_random_case("sign exact", i);
        question_draw(&question, &random);
        oracle_quat q;
        oracle_quat_init(q, question.q);
        int expected = oracle_sign(q, question.exact_a, question.exact_b);
        oracle_quat_clear(q);
        count[expected + 1]++;
        int sign = pir_sign_true(&question.signs, &question.a.value, &question.b.value);
        expect(sign == expected, "case %llu: %d, not %d", (unsigned long long)i, sign, expected);
    }
    assert_true(count[0] > 1000 && count[1] > 20 && count[2] > 1000);
    question_clear(&question, &allocator);
}

/* Vectors and rotations for which s is often zero, and often its derivatives as well: parallel,
   orthogonal, along the axis. */
static void draw_tie(struct question *question, test_random *random) {
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = test_random_between(random, -1, 1);
        b[k] = test_random_between(random, -1, 1);
    }
    if (a[0] == 0 && a[1] == 0 && a[2] == 0)
        a[test_random_below(random, 3)] = -1;
    if (b[0] == 0 && b[1] == 0 && b[2] == 0)
        b[test_random_below(random, 3)] = 1;
    pir_quat q = test_random_below(random, 2) ? test_integer_rotation(random)
                                              : test_hard_rotation(test_random_below(random, TEST_HARD_ROTATIONS));
    question_set(question, q, a, b);
    // b exactly at a right angle to the rotated a, when doubles hold it
    if (test_random_below(random, 3) == 0) {
        oracle_quat exact;
        oracle_vec turned, other, across;
        oracle_quat_init(exact, q);
        oracle_vec_init(turned);
        oracle_vec_init(other);
        oracle_vec_init(across);
        oracle_turn(turned, exact, question->exact_a);
        for (int k = 0; k < 3; k++)
            mpz_set_si(other[k], test_random_between(random, -1, 1));
        oracle_cross(across, turned, other);
        if (!oracle_is_zero(across) && mpz_sizeinbase(across[0], 2) < 50 && mpz_sizeinbase(across[1], 2) < 50 &&
            mpz_sizeinbase(across[2], 2) < 50)
            question_set(question, q, a, (double[3]){mpz_get_d(across[0]), mpz_get_d(across[1]), mpz_get_d(across[2])});
        oracle_vec_clear(across);
        oracle_vec_clear(other);
        oracle_vec_clear(turned);
        oracle_quat_clear(exact);
    }
}

/*
 * About an axis of coordinates: a vector along it and one across it, which make s vanish whatever the angle is, and an
 * angle for which its derivative vanishes, too, or is within a few ulps of that.
 */
static void draw_close_call(struct question *question, test_random *random) {
    int k = (int)test_random_below(random, 3), l = (k + 1) % 3, m = (k + 2) % 3;
    double a[3] = {0, 0, 0}, b[3] = {0, 0, 0}, q[4] = {0, 0, 0, 0};
    a[k] = floor(test_random_unit(random) * 0x1p50);
    a[l] = 1 + floor(fabs(test_random_unit(random)) * 0x1p50);
    b[m] = 1 + floor(fabs(test_random_unit(random)) * 0x1p50);
    bool first = test_random_below(random, 2);
    q[m] = ldexp(first ? a[l] : a[k], -60);
    q[3] = ldexp(first ? -a[k] : a[l], -60);
    for (uint32_t i = test_random_below(random, 6); i > 0; i--) {
        int which = test_random_below(random, 2) ? m : 3;
        q[which] = nextafter(q[which], test_random_below(random, 2) ? HUGE_VAL : -HUGE_VAL);
    }
    bool swapped = test_random_below(random, 2);
    question_set(question, (pir_quat){q[0], q[1], q[2], q[3]}, swapped ? b : a, swapped ? a : b);
}

/* Multiplies both vectors by factors of a few limbs, which no double holds. */
static void lengthen(struct question *question, test_random *random) {
    mpz_t factor;
    mpz_init(factor);
    for (int side = 0; side < 2; side++) {
        mpz_ui_pow_ui(factor, 3, 41 + test_random_below(random, 60));
        for (int k = 0; k < 3; k++) {
            mpz_ptr exact = side ? question->exact_b[k] : question->exact_a[k];
            mpz_mul(exact, exact, factor);
            test_int_set(side ? &question->b.value.c[k] : &question->a.value.c[k], exact);
        }
    }
    mpz_clear(factor);
}

static void tie_is_settled_as_a_real_tiny_perturbation_settles_it(void **state) {
    (void)state;
    pir_allocator allocator = from_malloc();
    struct question question;
    uint32_t ties = 0;
    question_init(&question, &allocator);
    for (uint64_t i = 0; i < 3000; i++) {
        test_random random = test_random_case("sign ties", i);
        if (i % 5 == 4)
            draw_close_call(&question, &random);
        else
            draw_tie(&question, &random);
        // where small integers are settled by doubles, long ones of the same directions are settled exactly
        if (i % 3 == 2)
            lengthen(&question, &random);
        oracle_quat q;
        oracle_perturbed_quat_init(q, question.q, 256);
        int expected = oracle_sign(q, question.exact_a, question.exact_b);
        oracle_quat_clear(q);
        uint64_t before = question.signs.by_exact;
        ties += pir_sign_true(&question.signs, &question.a.value, &question.b.value) == 0;
        assert_int_equal(question.signs.by_exact, before + 1);
        int sign = pir_sign_perturbed(&question.signs, &question.a.value, &question.b.value);
        expect(expected != 0 && sign == expected, "case %llu: %d, not %d", (unsigned long long)i, sign, expected);
    }
    assert_true(ties > 500);
    print_message("# %u of 3000 were ties\n", ties);
    question_clear(&question, &allocator);
}

/* Doubles settle the ties of small integers where they can; long vectors of the same directions are
   settled by integers alone. */
static void sign_is_that_of_the_directions(void **state) {
    (void)state;
    pir_allocator allocator = from_malloc();
    struct question question;
    question_init(&question, &allocator);
    for (uint64_t i = 0; i < 20000; i++) {
        test_random random = test_random_case("sign directions", i);
        if (i % 4)
            draw_close_call(&question, &random);
        else
            draw_tie(&question, &random);
        int sign = pir_sign_perturbed(&question.signs, &question.a.value, &question.b.value);
        lengthen(&question, &random);
        expect(pir_sign_perturbed(&question.signs, &question.a.value, &question.b.value) == sign, "case %llu",
               (unsigned long long)i);
    }
    question_clear(&question, &allocator);
}

/* One rule for the sign of the quaternion: short vectors are settled by doubles, long ones by integers. */
static void quaternions_of_one_rotation_settle_ties_alike(void **state) {
    (void)state;
    static const double factors[] = {-1, 0.5, -4, 0x1p60};
    pir_allocator allocator = from_malloc();
    struct question question;
    question_init(&question, &allocator);
    for (uint64_t i = 0; i < 4000; i++) {
        test_random random = test_random_case("sign of multiples", i);
        draw_tie(&question, &random);
        if (i % 3 == 2)
            lengthen(&question, &random);
        const pir_quat q = question.q;
        const pir_int3 *a = &question.a.value, *b = &question.b.value;
        int sign = pir_sign_perturbed(&question.signs, a, b);
        for (size_t k = 0; k < sizeof factors / sizeof *factors; k++) {
            const double f = factors[k];
            const pir_quat other = {f * q.x, f * q.y, f * q.z, f * q.w};
            if (pir_rotation_set(&question.signs.rotation, other) != PIR_OK || other.x / f != q.x ||
                other.y / f != q.y || other.z / f != q.z || other.w / f != q.w)
                continue;
            expect(pir_sign_perturbed(&question.signs, a, b) == sign, "case %llu, factor %g", (unsigned long long)i, f);
        }
    }
    question_clear(&question, &allocator);
}

/*
 * A relative rotation is rounded to doubles. One of its components is 2^-166 here, and 0 in doubles, as if a vector and
 * the turned other one were at a right angle.
 */
static void zero_that_rounding_made_is_no_tie(void **state) {
    (void)state;
    pir_allocator allocator = from_malloc();
    struct question question;
    question_init(&question, &allocator);
    question_set(&question, (pir_quat){0, 0, 0, 1}, (double[3]){1, 0, 0}, (double[3]){0, 1, 0});
    for (int sign = -1; sign <= 1; sign += 2) {
        const pir_quat q = {0, 0x1p-83, 0.7, 0.7}, p = {0, sign * 0x1p-83, -0.7, 0.7};
        assert_int_equal(pir_rotation_set_relative(&question.signs.rotation, q, p), PIR_OK);
        assert_true(question.signs.rotation.given.w == 0);
        // M's entry for the two vectors is 2 (xy + wz), of which y or x is 0 and z is −2·0.7²
        int expected = pir_sign_true(&question.signs, &question.a.value, &question.b.value);
        assert_true(expected != 0);
        assert_int_equal(pir_sign_perturbed(&question.signs, &question.a.value, &question.b.value), expected);
    }
    question_clear(&question, &allocator);
}

static void negated(test_int3 *v) {
    for (int k = 0; k < 3; k++)
        pir_int_negate(&v->value.c[k]);
}

static void reversing_a_vector_reverses_the_sign_ties_included(void **state) {
    (void)state;
    pir_allocator allocator = from_malloc();
    struct question question;
    question_init(&question, &allocator);
    for (uint64_t i = 0; i < 3000; i++) {
        test_random random = test_random_case("sign reversal", i);
        if (i % 2)
            draw_tie(&question, &random);
        else
            question_draw(&question, &random);
        pir_signs *signs = &question.signs;
        int sign = pir_sign_perturbed(signs, &question.a.value, &question.b.value);
        assert_true(sign == 1 || sign == -1);
        negated(&question.a);
        expect(pir_sign_perturbed(signs, &question.a.value, &question.b.value) == -sign, "case %llu",
               (unsigned long long)i);
        negated(&question.b);
        expect(pir_sign_perturbed(signs, &question.a.value, &question.b.value) == sign, "case %llu",
               (unsigned long long)i);
        negated(&question.a);
        expect(pir_sign_perturbed(signs, &question.a.value, &question.b.value) == -sign, "case %llu",
               (unsigned long long)i);
    }
    question_clear(&question, &allocator);
}

static void each_sign_is_counted_once_and_scratch_is_given_back(void **state) {
    (void)state;
    pir_allocator allocator = from_malloc();
    struct question question;
    question_init(&question, &allocator);
    uint64_t exact = 0, perturbed = 0;
    for (uint64_t i = 0; i < 500; i++) {
        test_random random = test_random_case("sign counters", i);
        draw_tie(&question, &random);
        oracle_quat q;
        oracle_quat_init(q, question.q);
        int tie = oracle_sign(q, question.exact_a, question.exact_b) == 0;
        oracle_quat_clear(q);
        exact += !tie;
        perturbed += (uint64_t)tie;
        pir_sign_perturbed(&question.signs, &question.a.value, &question.b.value);
        assert_int_equal(question.signs.by_exact, exact);
        assert_int_equal(question.signs.by_perturbation, perturbed);
        assert_int_equal(question.signs.by_filter, 0);
        assert_int_equal(question.signs.scratch->used, 0);
    }
    question_clear(&question, &allocator);
}

static void unit_vectors_are_within_their_bound(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 3000; i++) {
        test_random random = test_random_case("sign unit", i);
        double v[3];
        random_vector(&random, v);
        test_int3 a;
        test_int3_set_doubles(&a, v[0], v[1], v[2]);
        pir_vec3 unit = pir_int3_unit(&a.value);
        const double near[3] = {unit.x, unit.y, unit.z};
        mpz_t z, square;
        mpf_t length, off, sum;
        mpz_inits(z, square, NULL);
        mpf_init2(length, 400);
        mpf_init2(off, 400);
        mpf_init2(sum, 400);
        for (int k = 0; k < 3; k++) {
            test_int_get(z, &a.value.c[k]);
            mpz_addmul(square, z, z);
        }
        mpf_set_z(length, square);
        mpf_sqrt(length, length);
        mpf_t component;
        mpf_init2(component, 400);
        for (int k = 0; k < 3; k++) {
            test_int_get(z, &a.value.c[k]);
            mpf_set_z(component, z);
            mpf_div(component, component, length);
            mpf_set_d(off, near[k]);
            mpf_sub(off, off, component);
            mpf_mul(off, off, off);
            mpf_add(sum, sum, off);
        }
        mpf_sqrt(sum, sum);
        expect(mpf_get_d(sum) < 8 * 0x1p-53, "case %llu", (unsigned long long)i);
        mpf_clears(length, off, sum, component, NULL);
        mpz_clears(z, square, NULL);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(filter_is_within_its_bound_and_never_wrong),
        cmocka_unit_test(exact_sign_is_that_of_rational_arithmetic),
        cmocka_unit_test(tie_is_settled_as_a_real_tiny_perturbation_settles_it),
        cmocka_unit_test(sign_is_that_of_the_directions),
        cmocka_unit_test(quaternions_of_one_rotation_settle_ties_alike),
        cmocka_unit_test(zero_that_rounding_made_is_no_tie),
        cmocka_unit_test(reversing_a_vector_reverses_the_sign_ties_included),
        cmocka_unit_test(each_sign_is_counted_once_and_scratch_is_given_back),
        cmocka_unit_test(unit_vectors_are_within_their_bound),
    };
    return cmocka_run_group_tests_name("sign", tests, NULL, NULL);
}

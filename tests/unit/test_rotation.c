/* SPDX-License-Identifier: MIT */
/* Quaternions of any length as exact rotations: the integers, the matrix of doubles and its
   bound, the bound on a turn. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include "base/processor.h"
#include "exact/relative_turn.h"
#include "oracle/points.h"
#include "support/bodies.h"
#include "support/integers.h"

static pir_quat rotation_of_case(test_random *random, uint64_t i) {
    if (i < TEST_HARD_ROTATIONS)
        return test_hard_rotation((uint32_t)i);
    if (i % 3 == 0)
        return (pir_quat){test_random_scaled(random, -1074, 1023), test_random_scaled(random, -1074, 1023),
                          test_random_scaled(random, -1074, 1023), test_random_scaled(random, -1074, 1023)};
    return test_rotation(random);
}

/* to = column `column` of |q|²·R by the oracle, and |q|² into `square`. */
static void exact_column(oracle_quat q, int column, oracle_vec to, mpz_t square) {
    oracle_vec unit;
    oracle_vec_init(unit);
    mpz_set_ui(unit[column], 1);
    oracle_turn(to, q, unit);
    mpz_set_ui(square, 0);
    for (int k = 0; k < 4; k++)
        mpz_addmul(square, q[k], q[k]);
    oracle_vec_clear(unit);
}

static void integer_matrix_is_a_positive_multiple_of_the_rotation(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 300; i++) {
        test_random random = test_random_case("rotation exact", i);
        pir_rotation_integers integers;
        pir_rotation rotation = {.integers = &integers};
        pir_quat q = rotation_of_case(&random, i);
        assert_int_equal(pir_rotation_set(&rotation, q), PIR_OK);
        pir_rotation_make_exact(&rotation);
        oracle_quat exact;
        oracle_vec column;
        mpz_t square, entry, norm, left, right;
        oracle_quat_init(exact, q);
        oracle_vec_init(column);
        mpz_inits(square, entry, norm, left, right, NULL);
        test_int_get(norm, &integers.norm);
        expect(mpz_sgn(norm) > 0, "case %llu", (unsigned long long)i);
        for (int c = 0; c < 3; c++) {
            exact_column(exact, c, column, square);
            for (int r = 0; r < 3; r++) {
                // m / norm = column / square
                test_int_get(entry, &integers.m[r][c]);
                mpz_mul(left, entry, square);
                mpz_mul(right, column[r], norm);
                expect(mpz_cmp(left, right) == 0, "case %llu: entry %d %d", (unsigned long long)i, r, c);
            }
        }
        mpz_clears(square, entry, norm, left, right, NULL);
        oracle_vec_clear(column);
        oracle_quat_clear(exact);
    }
}

/* conj(a)·b of GMP's integers. */
static void exact_product(oracle_quat a, oracle_quat b, oracle_quat to) {
    static const int of_a[4][4] = {{3, 0, 1, 2}, {3, 1, 2, 0}, {3, 2, 0, 1}, {3, 0, 1, 2}};
    static const int of_b[4][4] = {{0, 3, 2, 1}, {1, 3, 0, 2}, {2, 3, 1, 0}, {3, 0, 1, 2}};
    static const int sign[4][4] = {{1, -1, -1, 1}, {1, -1, -1, 1}, {1, -1, -1, 1}, {1, 1, 1, 1}};
    for (int k = 0; k < 4; k++) {
        mpz_set_ui(to[k], 0);
        for (int i = 0; i < 4; i++)
            if (sign[k][i] > 0)
                mpz_addmul(to[k], a[of_a[k][i]], b[of_b[k][i]]);
            else
                mpz_submul(to[k], a[of_a[k][i]], b[of_b[k][i]]);
    }
}

/* A quaternion whose integers are short, or of two limbs, or longer. */
static pir_quat factor_of_case(test_random *random, uint64_t i) {
    const int low = i % 3 == 0 ? -2 : i % 3 == 1 ? -40 : -300;
    return (pir_quat){test_random_scaled(random, low, 0), test_random_scaled(random, low, 0),
                      test_random_scaled(random, low, 0), test_random_scaled(random, low, 0)};
}

static void integer_matrix_of_a_relative_rotation_is_that_of_the_product(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 900; i++) {
        test_random random = test_random_case("rotation relative", i);
        pir_rotation_integers integers;
        pir_rotation rotation = {.integers = &integers};
        pir_quat a = factor_of_case(&random, i), b = factor_of_case(&random, i / 3);
        assert_int_equal(pir_rotation_set_relative(&rotation, a, b), PIR_OK);
        pir_rotation_make_exact(&rotation);
        oracle_quat of_a, of_b, product;
        oracle_vec column;
        mpz_t square, entry, norm;
        oracle_quat_init(of_a, a);
        oracle_quat_init(of_b, b);
        oracle_quat_init(product, a);
        oracle_vec_init(column);
        mpz_inits(square, entry, norm, NULL);
        exact_product(of_a, of_b, product);
        test_int_get(norm, &integers.norm);
        for (int c = 0; c < 3; c++) {
            exact_column(product, c, column, square);
            for (int r = 0; r < 3; r++) {
                test_int_get(entry, &integers.m[r][c]);
                mpz_mul(entry, entry, square);
                mpz_mul(column[r], column[r], norm);
                expect(mpz_cmp(entry, column[r]) == 0, "case %llu: entry %d %d", (unsigned long long)i, r, c);
            }
        }
        mpz_clears(square, entry, norm, NULL);
        oracle_vec_clear(column);
        oracle_quat_clear(product);
        oracle_quat_clear(of_b);
        oracle_quat_clear(of_a);
    }
}

/* A component at which versions could differ: 0, tiny, 1 but for rounding, any. */
static double component_of_case(test_random *random) {
    switch (test_random_below(random, 8)) {
    case 0:
        return test_random_below(random, 2) ? 0.0 : -0.0;
    case 1:
        return test_random_scaled(random, -402, -398);
    case 2:
        return test_random_scaled(random, -60, 0);
    default:
        return test_random_unit(random);
    }
}

/* A quaternion of such components, mostly of length 1. */
static pir_quat relative_of_case(test_random *random) {
    const pir_quat q = {component_of_case(random), component_of_case(random), component_of_case(random),
                        component_of_case(random)};
    const double length = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const double by = length > 0x1p-100 && test_random_below(random, 8) ? 1 / length : 1;
    return (pir_quat){q.x * by, q.y * by, q.z * by, q.w * by};
}

/* Whether whole + rest is the product but for 2^-100, and whole but for its last bit. */
static bool is_near_product(pir_quat a, pir_quat b, const pir_quat_product *product) {
    const double whole[4] = {product->whole.x, product->whole.y, product->whole.z, product->whole.w};
    const double rest[4] = {product->rest.x, product->rest.y, product->rest.z, product->rest.w};
    const double given[2][4] = {{a.x, a.y, a.z, a.w}, {b.x, b.y, b.z, b.w}};
    bool is_near = true;
    oracle_quat scaled[2], exact;
    for (int f = 0; f < 2; f++) {
        oracle_quat_init(scaled[f], f ? b : a);
        for (int k = 0; k < 4; k++) {
            mpq_t at;
            mpq_init(at);
            mpq_set_d(at, given[f][k]);
            mpq_mul_2exp(at, at, 1100);
            mpz_set_q(scaled[f][k], at);
            mpq_clear(at);
        }
    }
    oracle_quat_init(exact, a);
    exact_product(scaled[0], scaled[1], exact);
    for (int k = 0; k < 4; k++) {
        mpq_t off, part;
        mpq_inits(off, part, NULL);
        mpq_set_z(off, exact[k]);
        mpq_div_2exp(off, off, 2200);
        mpq_set_d(part, whole[k]);
        mpq_sub(off, off, part);
        is_near &= fabs(mpq_get_d(off)) <= 0x1.01p-53 * fabs(whole[k]) + 0x1p-100;
        mpq_set_d(part, rest[k]);
        mpq_sub(off, off, part);
        is_near &= fabs(mpq_get_d(off)) <= 0x1p-100;
        mpq_clears(off, part, NULL);
    }
    oracle_quat_clear(exact);
    oracle_quat_clear(scaled[1]);
    oracle_quat_clear(scaled[0]);
    return is_near;
}

/* What a version writes. */
struct written {
    pir_quat_product product;
    pir_quat unit[2];
    pir_mat3 r[2];
};

static void relative_rotations_have_the_same_bits_on_all_processors(void **state) {
    (void)state;
    uint32_t taken = 0;
    for (uint64_t i = 0; i < 30000; i++) {
        test_random random = test_random_case("rotation versions", i);
        const pir_quat q = relative_of_case(&random), p = relative_of_case(&random);
        struct written plain;
        memset(&plain, 0xff, sizeof plain);
        const pir_relative_version *first = pir_processor_version(0)->relative;
        const bool found = first->find(&q, &p, &plain.product, &plain.unit[0], &plain.r[0]);
        const bool turned = first->turn(&q, &plain.unit[1], &plain.r[1]);
        if (found && i < 6000)
            expect(is_near_product(q, p, &plain.product), "case %llu: product", (unsigned long long)i);
        taken += found;
        for (unsigned version = 1; pir_processor_version(version); version++) {
            const pir_relative_version *other = pir_processor_version(version)->relative;
            struct written written;
            memset(&written, 0xff, sizeof written);
            expect(other->find(&q, &p, &written.product, &written.unit[0], &written.r[0]) == found &&
                       other->turn(&q, &written.unit[1], &written.r[1]) == turned,
                   "case %llu: version %u takes it or not", (unsigned long long)i, version);
            expect(memcmp(&written, &plain, sizeof plain) == 0, "case %llu: version %u", (unsigned long long)i,
                   version);
        }
    }
    expect(taken > 5000, "only %u products were taken", taken);
}

static void double_matrix_is_within_its_bound(void **state) {
    (void)state;
    double worst = 0;
    for (uint64_t i = 0; i < 3000; i++) {
        test_random random = test_random_case("rotation doubles", i);
        pir_rotation rotation;
        pir_quat q = rotation_of_case(&random, i);
        assert_int_equal(pir_rotation_set(&rotation, q), PIR_OK);
        oracle_quat exact;
        oracle_vec column;
        mpz_t square;
        mpq_t entry, off;
        double error = 0;
        oracle_quat_init(exact, q);
        oracle_vec_init(column);
        mpz_init(square);
        mpq_inits(entry, off, NULL);
        for (int c = 0; c < 3; c++) {
            exact_column(exact, c, column, square);
            for (int r = 0; r < 3; r++) {
                mpq_set_num(entry, column[r]);
                mpq_set_den(entry, square);
                mpq_canonicalize(entry);
                mpq_set_d(off, rotation.r.m[r][c]);
                mpq_sub(off, off, entry);
                error += mpq_get_d(off) * mpq_get_d(off);
            }
        }
        error = sqrt(error) * 0x1p53;
        worst = fmax(worst, error);
        expect(error < 28, "case %llu: off by %g units of 2^-53", (unsigned long long)i, error);
        mpz_clear(square);
        mpq_clears(entry, off, NULL);
        oracle_vec_clear(column);
        oracle_quat_clear(exact);
    }
    print_message("# largest error of a matrix: %.2f of 28 units of 2^-53\n", worst);
}

/* The exact turn between two quaternions: cos²(θ/2) = (a·b)² / (|a|²|b|²), worked out from the
   sine for small angles. */
static double turn_between(pir_quat a, pir_quat b) {
    oracle_quat x, y;
    mpz_t dot, xx, yy, sine;
    oracle_quat_init(x, a);
    oracle_quat_init(y, b);
    mpz_inits(dot, xx, yy, sine, NULL);
    for (int k = 0; k < 4; k++) {
        mpz_addmul(dot, x[k], y[k]);
        mpz_addmul(xx, x[k], x[k]);
        mpz_addmul(yy, y[k], y[k]);
    }
    mpz_mul(xx, xx, yy);
    mpz_mul(dot, dot, dot);
    mpz_sub(sine, xx, dot);
    mpq_t square;
    mpq_init(square);
    mpq_set_num(square, sine);
    mpq_set_den(square, xx);
    mpq_canonicalize(square);
    double s = sqrt(mpq_get_d(square));
    mpq_set_num(square, dot);
    mpq_set_den(square, xx);
    mpq_canonicalize(square);
    double c = sqrt(mpq_get_d(square));
    mpq_clear(square);
    mpz_clears(dot, xx, yy, sine, NULL);
    oracle_quat_clear(x);
    oracle_quat_clear(y);
    return 2 * atan2(s, c);
}

static void angle_bound_is_never_below_the_turn_and_close_for_small_ones(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 3000; i++) {
        test_random random = test_random_case("rotation angle", i);
        pir_quat a = test_rotation(&random), b = test_rotation(&random);
        // half of the turns small, down to 2^-50; b at another length and perhaps the other sign
        if (i % 2) {
            double step = ldexp(1, -test_random_between(&random, 1, 50));
            pir_vec3 axis = test_random_direction(&random);
            a = test_general_rotation(&random);
            b = test_compose((pir_quat){axis.x * step, axis.y * step, axis.z * step, i % 4 == 1 ? -1 : 1}, a, 0);
        }
        pir_rotation one, other;
        assert_int_equal(pir_rotation_set(&one, a), PIR_OK);
        assert_int_equal(pir_rotation_set(&other, b), PIR_OK);
        double bound = pir_rotation_angle_bound(one.unit, other.unit), turn = turn_between(a, b);
        expect(bound >= turn * (1 - 0x1p-50), "case %llu: %.17g is below the turn %.17g", (unsigned long long)i, bound,
               turn);
        if (turn < 0.01)
            expect(bound <= turn * (1 + 1e-4) + 0x1p-46, "case %llu: %.17g is far above the turn %.17g",
                   (unsigned long long)i, bound, turn);
    }
}

static void bad_quaternions_are_refused_and_change_nothing(void **state) {
    (void)state;
    const struct {
        pir_quat q;
        pir_status status;
    } bad[] = {
        {{0, 0, 0, 0}, PIR_ERR_ZERO_QUATERNION},
        {{-0.0, 0, -0.0, 0}, PIR_ERR_ZERO_QUATERNION},
        {{(double)NAN, 0, 0, 1}, PIR_ERR_NOT_FINITE},
        {{0, (double)INFINITY, 0, 1}, PIR_ERR_NOT_FINITE},
        {{0, 0, -(double)INFINITY, 1}, PIR_ERR_NOT_FINITE},
        {{0, 0, 0, (double)NAN}, PIR_ERR_NOT_FINITE},
    };
    pir_rotation rotation, before;
    memset(&rotation, 0, sizeof rotation);
    assert_int_equal(pir_rotation_set(&rotation, (pir_quat){1, 2, 3, 4}), PIR_OK);
    memcpy(&before, &rotation, sizeof before);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(pir_rotation_set(&rotation, bad[i].q), bad[i].status);
        assert_memory_equal(&rotation, &before, sizeof before);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integer_matrix_is_a_positive_multiple_of_the_rotation),
        cmocka_unit_test(integer_matrix_of_a_relative_rotation_is_that_of_the_product),
        cmocka_unit_test(relative_rotations_have_the_same_bits_on_all_processors),
        cmocka_unit_test(double_matrix_is_within_its_bound),
        cmocka_unit_test(angle_bound_is_never_below_the_turn_and_close_for_small_ones),
        cmocka_unit_test(bad_quaternions_are_refused_and_change_nothing),
    };
    return cmocka_run_group_tests_name("rotation", tests, NULL, NULL);
}

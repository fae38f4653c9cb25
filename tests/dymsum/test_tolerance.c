/* SPDX-License-Identifier: MIT */
/*
 * Tolerance: the hull of the vertices that a lagging sum keeps, held against the true sum by their support functions in
 * exact arithmetic, in random directions and along the facets' normals; and that what settles is exact.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/live_mesh.h>

#include "support/bodies.h"
#include "support/meshes.h"

/* h(n)·|q|² of both: over all pairs of vertices, and over those that the live mesh holds. */
struct supports {
    mpq_t whole, kept, best_p, best_q, at, part, rotated[3], m[3][3], square, point[3], n[3];
};

static void start(struct supports *s) {
    mpq_inits(s->whole, s->kept, s->best_p, s->best_q, s->at, s->part, s->square, NULL);
    for (int i = 0; i < 3; i++) {
        mpq_inits(s->rotated[i], s->point[i], s->n[i], NULL);
        for (int j = 0; j < 3; j++)
            mpq_init(s->m[i][j]);
    }
}

static void finish(struct supports *s) {
    mpq_clears(s->whole, s->kept, s->best_p, s->best_q, s->at, s->part, s->square, NULL);
    for (int i = 0; i < 3; i++) {
        mpq_clears(s->rotated[i], s->point[i], s->n[i], NULL);
        for (int j = 0; j < 3; j++)
            mpq_clear(s->m[i][j]);
    }
}

/* to += factor·a·b, factor a small whole number. */
static void add_product(mpq_t to, mpq_t part, int factor, const mpq_t a, const mpq_t b) {
    mpq_t whole;
    mpq_init(whole);
    mpq_set_si(whole, factor, 1);
    mpq_mul(part, a, b);
    mpq_mul(part, part, whole);
    mpq_add(to, to, part);
    mpq_clear(whole);
}

/* M(q), whose entries are R's times |q|², from the textbook. */
static void set_rotation(struct supports *s, pir_quat q) {
    mpq_t c[4];
    const double given[4] = {q.x, q.y, q.z, q.w};
    for (int k = 0; k < 4; k++) {
        mpq_init(c[k]);
        mpq_set_d(c[k], given[k]);
    }
    mpq_set_ui(s->square, 0, 1);
    for (int k = 0; k < 4; k++)
        add_product(s->square, s->part, 1, c[k], c[k]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            mpq_set_ui(s->m[i][j], 0, 1);
            add_product(s->m[i][j], s->part, 2, c[i], c[j]);
            if (i == j) {
                add_product(s->m[i][j], s->part, 2, c[3], c[3]);
                mpq_sub(s->m[i][j], s->m[i][j], s->square);
            } else {
                // the cross product's matrix: −z at (0, 1), y at (0, 2), −x at (1, 2)
                int k = 3 - i - j, sign = (j - i + 3) % 3 == 1 ? -1 : 1;
                add_product(s->m[i][j], s->part, 2 * sign, c[3], c[k]);
            }
        }
    for (int k = 0; k < 4; k++)
        mpq_clear(c[k]);
}

/* at = n·M·p for a vertex of P, or |q|²·n·v for one of Q. */
static void support_of(struct supports *s, const pir_polytope *polytope, uint32_t v, bool rotates) {
    pir_polytope_vertex_exact(polytope, v, s->point);
    mpq_set_ui(s->at, 0, 1);
    for (int i = 0; i < 3; i++) {
        if (rotates) {
            mpq_set_ui(s->rotated[i], 0, 1);
            for (int j = 0; j < 3; j++)
                add_product(s->rotated[i], s->part, 1, s->m[i][j], s->point[j]);
        } else {
            mpq_mul(s->rotated[i], s->square, s->point[i]);
        }
        add_product(s->at, s->part, 1, s->n[i], s->rotated[i]);
    }
}

static void greatest(struct supports *s, const pir_polytope *polytope, bool rotates, mpq_t best) {
    for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope); v++) {
        support_of(s, polytope, v, rotates);
        if (v == 0 || mpq_cmp(s->at, best) > 0)
            mpq_set(best, s->at);
    }
}

/* Whether 0 ≤ h_M(n) − h_A(n) ≤ bound·|n|, exactly; *ret_short is told whether it is not zero. */
static bool is_within(struct supports *s, const pir_sum *sum, const pir_live_mesh *live, pir_vec3 n, double bound,
                      bool *ret_short) {
    const pir_polytope *p = pir_sum_p(sum), *q = pir_sum_q(sum);
    set_rotation(s, pir_sum_rotation(sum));
    mpq_set_d(s->n[0], n.x);
    mpq_set_d(s->n[1], n.y);
    mpq_set_d(s->n[2], n.z);
    greatest(s, p, true, s->best_p);
    greatest(s, q, false, s->best_q);
    mpq_add(s->whole, s->best_p, s->best_q);
    bool first = true;
    for (uint32_t i = 0; i < pir_live_mesh_vertex_slots(live); i++) {
        uint32_t pair[2];
        if (!pir_live_mesh_vertex_pair(live, i, pair))
            continue;
        support_of(s, p, pair[0], true);
        mpq_set(s->best_p, s->at);
        support_of(s, q, pair[1], false);
        mpq_add(s->at, s->at, s->best_p);
        if (first || mpq_cmp(s->at, s->kept) > 0)
            mpq_set(s->kept, s->at);
        first = false;
    }
    // (h_M − h_A)² against bound²·n²·|q|⁴
    mpq_sub(s->whole, s->whole, s->kept);
    *ret_short = mpq_sgn(s->whole) > 0;
    if (mpq_sgn(s->whole) < 0)
        return false;
    mpq_set_ui(s->kept, 0, 1);
    for (int i = 0; i < 3; i++)
        add_product(s->kept, s->part, 1, s->n[i], s->n[i]);
    mpq_set_d(s->at, bound);
    mpq_mul(s->at, s->at, s->square);
    mpq_mul(s->at, s->at, s->at);
    mpq_mul(s->kept, s->kept, s->at);
    mpq_mul(s->whole, s->whole, s->whole);
    return mpq_cmp(s->whole, s->kept) <= 0;
}

/* A turn by about `angle`. */
static pir_quat turn(test_random *random, pir_quat from, double angle) {
    pir_vec3 d = test_random_direction(random);
    return test_compose((pir_quat){angle / 2 * d.x, angle / 2 * d.y, angle / 2 * d.z, 1}, from, 1);
}

/* Holds a sum that may lag against its bound along the normals of both operands. */
static void check_bound(struct supports *s, pir_sum *sum, const char *what, int number) {
    pir_live_mesh *live;
    bool is_short;
    assert_int_equal(pir_live_mesh_create(sum, &live), PIR_OK);
    double bound = pir_sum_shortfall_bound(sum);
    expect(bound <= pir_sum_tolerance(sum), "%s %d: bound %g", what, number, bound);
    const pir_polytope *bodies[2] = {pir_sum_p(sum), pir_sum_q(sum)};
    for (int k = 0; k < 2; k++)
        for (uint32_t f = 0; f < pir_polytope_facet_count(bodies[k]); f++)
            expect(is_within(s, sum, live, pir_polytope_normal(bodies[k], f), bound, &is_short), "%s %d, facet %u",
                   what, number, f);
    pir_live_mesh_destroy(live);
}

/* The bound is one of lengths: what is behind before bodies grow is too far behind after. */
static void bound_holds_when_the_scale_changes(void **state) {
    (void)state;
    struct supports s;
    start(&s);
    for (int i = 0; i < 4; i++) {
        test_random random = test_random_case("tolerance and scale", (uint64_t)i);
        pir_polytope *p = test_sphere(&random, 60), *q = test_sphere(&random, 50);
        pir_sum *sum;
        pir_quat there = turn(&random, test_general_rotation(&random), 0.1);
        assert_int_equal(pir_sum_create(p, q, there, NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_set_tolerance(sum, 1.2), PIR_OK);
        assert_int_equal(pir_sum_rotate(sum, turn(&random, there, 0.4), PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_sum_get_statistics(sum).kept, 1);
        assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 1e6), PIR_OK);
        check_bound(&s, sum, "P grown", i);
        assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_Q, i % 2 ? 1e6 : 1e3), PIR_OK);
        check_bound(&s, sum, "both scaled", i);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    finish(&s);
}

/* Squares of such coordinates are beyond the doubles. */
static void bound_holds_for_tiny_and_huge_bodies(void **state) {
    (void)state;
    static const int exponents[] = {-1060, -560, -530, 510, 600, 1000};
    struct supports s;
    start(&s);
    uint32_t kept = 0;
    for (int i = 0; i < 6; i++) {
        test_random random = test_random_case("tolerance of tiny bodies", (uint64_t)i);
        test_points points[2];
        pir_polytope *bodies[2];
        for (int k = 0; k < 2; k++) {
            test_body_points(&random, TEST_SPHERE, 18, &points[k]);
            for (size_t v = 0; v < points[k].count; v++) {
                pir_vec3 *at = &points[k].at[v];
                *at = (pir_vec3){ldexp(at->x, exponents[i]), ldexp(at->y, exponents[i]), ldexp(at->z, exponents[i])};
            }
            bodies[k] = test_polytope(&points[k]);
        }
        pir_sum *sum;
        pir_quat there = turn(&random, test_general_rotation(&random), 0.1);
        assert_int_equal(pir_sum_create(bodies[0], bodies[1], there, NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_set_tolerance(sum, ldexp(1, exponents[i] - 5)), PIR_OK);
        for (int step = 0; step < 8; step++) {
            there = turn(&random, there, 0.01 * (1 << step));
            assert_int_equal(pir_sum_rotate(sum, there, PIR_METHOD_UPDATE), PIR_OK);
            check_bound(&s, sum, "exponent", exponents[i]);
        }
        uint32_t so_far = kept;
        kept += (uint32_t)pir_sum_get_statistics(sum).kept;
        expect(kept > so_far, "exponent %d: never behind", exponents[i]);
        pir_sum_destroy(sum);
        pir_polytope_release(bodies[0]);
        pir_polytope_release(bodies[1]);
    }
    finish(&s);
}

static void support_falls_short_by_no_more_than_the_bound(void **state) {
    (void)state;
    struct supports s;
    start(&s);
    uint32_t directions = 0, fell_short = 0, kept = 0;
    for (uint64_t i = 0; i < 8; i++) {
        test_random random = test_random_case("tolerance", i);
        pir_polytope *p = i % 3 ? test_sphere(&random, 26) : test_random_polytope(&random, TEST_BOX, 8),
                     *q = test_sphere(&random, 22);
        double tolerance = i % 2 ? 0.3 : 1.2;
        pir_sum *sum;
        pir_live_mesh *live;
        pir_quat there = test_general_rotation(&random);
        there = turn(&random, there, 0.1);
        assert_int_equal(pir_sum_create(p, q, there, NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_set_tolerance(sum, tolerance), PIR_OK);
        assert_int_equal(pir_live_mesh_create(sum, &live), PIR_OK);
        for (int step = 0; step < 30; step++) {
            there = turn(&random, there, tolerance / 12);
            assert_int_equal(pir_sum_rotate(sum, there, PIR_METHOD_UPDATE), PIR_OK);
            assert_int_equal(pir_live_mesh_refresh(live), PIR_OK);
            double bound = pir_sum_shortfall_bound(sum);
            assert_true(bound >= 0 && bound <= tolerance);
            pir_quat now = pir_sum_rotation(sum);
            assert_memory_equal(&now, &there, sizeof now);
            kept += bound > 0;
            for (int k = 0; k < 4; k++) {
                pir_vec3 n = k < 2 ? test_random_direction(&random)
                                   : pir_polytope_normal(q, test_random_below(&random, pir_polytope_facet_count(q)));
                bool is_short;
                expect(is_within(&s, sum, live, n, bound, &is_short), "case %d, step %d", (int)i, step);
                expect(bound > 0 || !is_short, "case %d, step %d", (int)i, step);
                directions++;
                fell_short += is_short;
            }
        }
        assert_int_equal(pir_sum_get_statistics(sum).kept + pir_sum_get_statistics(sum).updates, 30);
        // settled, it is the sum of now
        assert_int_equal(pir_sum_settle(sum), PIR_OK);
        assert_true(pir_sum_shortfall_bound(sum) == 0 && pir_sum_tolerance(sum) == tolerance);
        pir_sum *fresh;
        pir_mesh *a, *b;
        assert_int_equal(pir_sum_create(p, q, there, NULL, &fresh), PIR_OK);
        assert_true(pir_sum_same_pairing(sum, fresh) && pir_sum_is_valid(sum));
        assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &a), PIR_OK);
        assert_int_equal(pir_sum_mesh(fresh, PIR_DOUBLE, &b), PIR_OK);
        assert_true(pir_mesh_equal(a, b));
        pir_mesh_destroy(b);
        pir_mesh_destroy(a);
        pir_sum_destroy(fresh);
        pir_live_mesh_destroy(live);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    finish(&s);
    print_message("%u frames kept, %u of %u directions fell short\n", kept, fell_short, directions);
    assert_true(kept > 150 && fell_short > 15);
}

static void lagging_sum_is_copied_and_kept_in_bytes(void **state) {
    (void)state;
    test_random random = test_random_case("tolerance copies", 0);
    pir_polytope *p = test_sphere(&random, 20), *q = test_sphere(&random, 20);
    pir_sum *sum, *copy, *back;
    pir_quat there = turn(&random, (pir_quat){1, 2, 3, 4}, 0.1), next = turn(&random, there, 1e-3);
    assert_int_equal(pir_sum_create(p, q, there, NULL, &sum), PIR_OK);
    assert_int_equal(pir_sum_set_tolerance(sum, 0.1), PIR_OK);
    assert_int_equal(pir_sum_rotate(sum, next, PIR_METHOD_AUTO), PIR_OK);
    double bound = pir_sum_shortfall_bound(sum);
    assert_true(bound > 0);
    assert_int_equal(pir_sum_clone(sum, NULL, &copy), PIR_OK);
    static uint8_t bytes[1 << 16];
    size_t size = pir_sum_serialised_size(sum);
    assert_true(size <= sizeof bytes);
    assert_int_equal(pir_sum_serialise(sum, bytes, size), PIR_OK);
    assert_int_equal(pir_sum_restore(bytes, size, NULL, NULL, &back), PIR_OK);
    pir_sum_destroy(sum);
    pir_sum *both[2] = {copy, back};
    pir_mesh *mesh[2];
    for (int i = 0; i < 2; i++) {
        pir_quat now = pir_sum_rotation(both[i]), exact = pir_sum_pairing_rotation(both[i]);
        assert_memory_equal(&now, &next, sizeof now);
        assert_memory_equal(&exact, &there, sizeof exact);
        assert_true(pir_sum_shortfall_bound(both[i]) == bound);
        assert_int_equal(pir_sum_mesh(both[i], PIR_EXACT, &mesh[i]), PIR_OK);
    }
    assert_true(pir_mesh_equal(mesh[0], mesh[1]));
    for (int i = 0; i < 2; i++) {
        pir_mesh_destroy(mesh[i]);
        // a walk always brings the pairing to the rotation
        assert_int_equal(pir_sum_rotate(both[i], next, PIR_METHOD_WALK), PIR_OK);
        assert_true(pir_sum_shortfall_bound(both[i]) == 0 && pir_sum_is_valid(both[i]));
        pir_sum_destroy(both[i]);
    }
    pir_polytope_release(q);
    pir_polytope_release(p);
}

/* Signs that 600 steps of a 2500th of a turn ask for, about an axis that changes every 50. */
static uint64_t work_of(pir_polytope *p, pir_polytope *q, double tolerance, uint64_t *ret_kept) {
    test_random random = test_random_case("tolerance and work", 0);
    pir_quat there = {1, 2, 3, 4}, step = {0, 0, 0, 1};
    pir_sum *sum;
    assert_int_equal(pir_sum_create(p, q, there, NULL, &sum), PIR_OK);
    assert_int_equal(pir_sum_set_tolerance(sum, tolerance), PIR_OK);
    pir_sum_reset_statistics(sum);
    for (int frame = 0; frame < 600; frame++) {
        if (frame % 50 == 0) {
            pir_vec3 axis = test_random_direction(&random);
            step = (pir_quat){axis.x / 800, axis.y / 800, axis.z / 800, 1};
        }
        there = test_compose(step, there, 1);
        assert_int_equal(pir_sum_rotate(sum, there, PIR_METHOD_AUTO), PIR_OK);
    }
    pir_sum_statistics did = pir_sum_get_statistics(sum);
    pir_sum_destroy(sum);
    *ret_kept = did.kept;
    return did.by_filter + did.by_exact;
}

static void no_tolerance_takes_more_work_than_none(void **state) {
    (void)state;
    test_random random = test_random_case("tolerance and work", 1);
    pir_polytope *p = test_sphere(&random, 120), *q = test_sphere(&random, 100);
    uint64_t kept, exact = work_of(p, q, 0, &kept);
    for (double tolerance = 1e-9; tolerance < 1; tolerance *= 3) {
        uint64_t work = work_of(p, q, tolerance, &kept);
        expect(work <= exact + exact / 10, "tolerance %g: %llu signs, %llu without", tolerance,
               (unsigned long long)work, (unsigned long long)exact);
    }
    // the widest saves nearly all
    assert_true(kept > 500);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void tolerance_that_is_no_length_is_refused(void **state) {
    (void)state;
    test_random random = test_random_case("bad tolerance", 0);
    pir_polytope *p = test_sphere(&random, 10);
    pir_sum *sum;
    assert_int_equal(pir_sum_create(p, p, (pir_quat){1, 2, 3, 4}, NULL, &sum), PIR_OK);
    assert_int_equal(pir_sum_set_tolerance(NULL, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_set_tolerance(sum, -1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_set_tolerance(sum, (double)NAN), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_set_tolerance(sum, (double)INFINITY), PIR_ERR_NOT_FINITE);
    assert_true(pir_sum_tolerance(sum) == 0);
    assert_int_equal(pir_sum_set_tolerance(sum, 0.5), PIR_OK);
    assert_int_equal(pir_sum_rotate(sum, (pir_quat){0, 0, 0, 0}, PIR_METHOD_UPDATE), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_sum_settle(NULL), PIR_ERR_ARGUMENT);
    pir_sum_destroy(sum);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bound_holds_when_the_scale_changes),
        cmocka_unit_test(bound_holds_for_tiny_and_huge_bodies),
        cmocka_unit_test(support_falls_short_by_no_more_than_the_bound),
        cmocka_unit_test(lagging_sum_is_copied_and_kept_in_bytes),
        cmocka_unit_test(no_tolerance_takes_more_work_than_none),
        cmocka_unit_test(tolerance_that_is_no_length_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/*
 * A sum of solids on its way through random histories: small steps, jumps, back
 * and forth, degenerate rotations, scales. At each it is the sum that is made
 * there anew, bit for bit, and with scales the sum of solids that are made that
 * large.
 *
 * PIR_TEST_CASES sets how many rotations each pair goes through.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "solid/models.h"
#include "support/memory.h"
#include "support/solid_sums.h"

struct history {
    test_random random;
    pir_quat now;
    pir_vec3 axis;
    double step;
    int kind;
};

static pir_quat turned(pir_quat a, pir_vec3 axis, double angle) {
    const double s = sin(angle / 2), c = cos(angle / 2);
    const pir_quat b = {s * axis.x, s * axis.y, s * axis.z, c};
    pir_quat r = {b.w * a.x + b.x * a.w + b.y * a.z - b.z * a.y, b.w * a.y - b.x * a.z + b.y * a.w + b.z * a.x,
                  b.w * a.z + b.x * a.y - b.y * a.x + b.z * a.w, b.w * a.w - b.x * a.x - b.y * a.y - b.z * a.z};
    const double by = 1 / sqrt(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
    return (pir_quat){r.x * by, r.y * by, r.z * by, r.w * by};
}

/* A quaternion of small whole numbers, or a hair beside one: points meet, and planes of facets are one, that are not so
 * at rest. */
static pir_quat whole_rotation(test_random *random) {
    double x[4];
    const double hair = test_random_below(random, 3) == 0 ? ldexp(1, -8 - (int)test_random_below(random, 40)) : 0;
    for (int k = 0; k < 4; k++)
        x[k] = (double)test_random_below(random, 9) - 4 + hair * ((double)test_random_below(random, 3) - 1);
    return (pir_quat){x[0], x[1], x[2], x[3] + 5};
}

/* A few frames of one kind, then of another. */
static pir_quat next_rotation(struct history *h) {
    static const double steps[] = {2e-5, 1.3e-3, 1.3e-2, .13};
    if (test_random_below(&h->random, 8) == 0) {
        h->kind = (int)test_random_below(&h->random, 9);
        h->axis = test_random_direction(&h->random);
        h->step = steps[test_random_below(&h->random, 4)];
        if (test_random_below(&h->random, 3) == 0)
            h->axis = (pir_vec3){0, 0, 1};
    }
    if (h->kind == 0)
        h->now = (pir_quat){test_random_between(&h->random, -1, 1), test_random_between(&h->random, -1, 1),
                            test_random_between(&h->random, -1, 1), 1};
    else if (h->kind == 1)
        h->now = turned(h->now, test_random_direction(&h->random), 2 * test_random_unit(&h->random));
    else if (h->kind == 2)
        h->step = -h->step;
    else if (h->kind == 8)
        return h->now = whole_rotation(&h->random);
    if (h->kind > 1)
        h->now = turned(h->now, h->axis, h->step);
    return h->now;
}

static pir_solid_method any_method(test_random *random) {
    static const pir_solid_method methods[] = {PIR_SOLID_AUTO, PIR_SOLID_UPDATE, PIR_SOLID_UPDATE, PIR_SOLID_UPDATE,
                                               PIR_SOLID_REBUILD};
    return methods[test_random_below(random, 5)];
}

static void expect_same(pir_solid_sum *sum, pir_solid_sum *fresh, const char *what, uint64_t frame) {
    pir_mesh *a = NULL, *b = NULL;
    pir_solid_sum_info of_a, of_b;
    assert_int_equal(pir_solid_sum_mesh(sum, PIR_EXACT, &a), PIR_OK);
    assert_int_equal(pir_solid_sum_mesh(fresh, PIR_EXACT, &b), PIR_OK);
    assert_int_equal(pir_solid_sum_describe(sum, &of_a), PIR_OK);
    assert_int_equal(pir_solid_sum_describe(fresh, &of_b), PIR_OK);
    expect(pir_mesh_equal(a, b), "%s, frame %llu: %u and %u facets differ", what, (unsigned long long)frame,
           pir_mesh_facet_count(a), pir_mesh_facet_count(b));
    expect(of_a.vertices == of_b.vertices && of_a.edges == of_b.edges && of_a.facets == of_b.facets &&
               of_a.candidates == of_b.candidates && of_a.two_sided == of_b.two_sided,
           "%s, frame %llu: the counts differ", what, (unsigned long long)frame);
    mpq_t x[3], y[3];
    for (int k = 0; k < 3; k++)
        mpq_inits(x[k], y[k], NULL);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(a); v++) {
        pir_mesh_vertex_exact(a, v, x);
        pir_mesh_vertex_exact(b, v, y);
        for (int k = 0; k < 3; k++)
            expect(mpq_equal(x[k], y[k]), "%s, frame %llu: vertex %u", what, (unsigned long long)frame, v);
    }
    for (int k = 0; k < 3; k++)
        mpq_clears(x[k], y[k], NULL);
    pir_mesh_destroy(a);
    pir_mesh_destroy(b);
}

static void sum_is_that_made_anew_at_every_rotation(void **state) {
    (void)state;
    static const char *const pairs[][2] = {{"clamp", "cube"},   {"frame", "star5"},    {"stella", "clamp"},
                                           {"star5", "stella"}, {"mushroom6", "case"}, {"ell", "frame"}};
    for (uint64_t i = 0; i < 2 * sizeof pairs / sizeof *pairs; i++) {
        const char *const *name = pairs[i / 2];
        struct history history = {.random = test_random_case("turns", i), .now = {0, 0, 0, 1}, .axis = {0, 0, 1}};
        pir_solid *p = solid_model_new(name[0], 1), *q = solid_model_new(name[1], i < 10 ? 2 : 1);
        pir_solid_sum_options options = pir_solid_sum_options_default();
        pir_solid_sum *sum = NULL;
        double scale[2] = {1, 1};
        assert_true(p && q);
        options.difference = i % 4 > 1;
        options.open = i % 2;
        assert_int_equal(pir_solid_sum_create(p, q, history.now, &options, &sum), PIR_OK);
        for (uint64_t frame = 0; frame < solid_cases(30); frame++) {
            pir_solid_sum *fresh = NULL;
            const pir_quat rotation = next_rotation(&history);
            const uint64_t before = pir_solid_sum_generation(sum);
            assert_int_equal(pir_solid_sum_rotate(sum, rotation, any_method(&history.random)), PIR_OK);
            if (test_random_below(&history.random, 10) == 0) {
                const int operand = (int)test_random_below(&history.random, 2);
                scale[operand] =
                    test_random_below(&history.random, 2) ? 1 : .1 + 3 * fabs(test_random_unit(&history.random));
                assert_int_equal(pir_solid_sum_set_scale(sum, (pir_operand)operand, scale[operand]), PIR_OK);
            }
            expect(pir_solid_sum_generation(sum) > before, "frame %llu", (unsigned long long)frame);
            assert_int_equal(pir_solid_sum_create(p, q, rotation, &options, &fresh), PIR_OK);
            for (int k = 0; k < 2; k++)
                if (scale[k] != 1)
                    assert_int_equal(pir_solid_sum_set_scale(fresh, (pir_operand)k, scale[k]), PIR_OK);
            expect_same(sum, fresh, name[0], frame);
            pir_solid_sum_destroy(fresh);
        }
        pir_solid_sum *clone = NULL;
        assert_int_equal(pir_solid_sum_clone(sum, &clone), PIR_OK);
        expect_same(sum, clone, "clone", 0);
        pir_solid_sum_destroy(clone);
        pir_solid_sum_destroy(sum);
        pir_solid_release(q);
        pir_solid_release(p);
    }
}

/* At these rotations planes of candidates are one that are not at others, and one of them does not bound the sum. */
static void facets_stand_in_the_order_of_a_sum_made_anew(void **state) {
    (void)state;
    static const pir_quat rotations[] = {{1, 4, 0, 6}, {2, -3, -4, 4}, {2, 1, -3, 3}};
    pir_solid *p = solid_model_new("ell", 1), *q = solid_model_new("frame", 1);
    for (size_t i = 0; i < sizeof rotations / sizeof *rotations; i++) {
        pir_solid_sum *kept = NULL, *fresh = NULL;
        assert_int_equal(pir_solid_sum_create(p, q, (pir_quat){.3, .1, .2, .9}, NULL, &kept), PIR_OK);
        assert_int_equal(pir_solid_sum_create(p, q, rotations[i], NULL, &fresh), PIR_OK);
        assert_int_equal(pir_solid_sum_rotate(kept, rotations[i], PIR_SOLID_UPDATE), PIR_OK);
        expect_same(kept, fresh, "ell ⊕ frame", i);
        pir_solid_sum_destroy(kept);
        pir_solid_sum_destroy(fresh);
    }
    pir_solid_release(p);
    pir_solid_release(q);
}

/* The last of these turns the plane of a facet that stands to where it is parallel to the walls of its candidate. */
static void facets_stand_past_their_walls(void **state) {
    (void)state;
    static const pir_quat rotations[] = {{0, -2, -2, 4}, {-3, 0, 4, 4}, {4, -3, 0, 9}, {-1, -4, 2, 3}, {2, 0, 0, 7}};
    static const double scale[2] = {0.45867668220873659, 1.5748203511152419};
    pir_solid *p = solid_model_new("star5", 1), *q = solid_model_new("stella", 2);
    pir_solid_sum_options options = pir_solid_sum_options_default();
    pir_solid_sum *sum[2] = {NULL, NULL};
    options.difference = true;
    for (size_t first = 0; first + 1 < sizeof rotations / sizeof *rotations; first++) {
        for (int k = 0; k < 2; k++) {
            assert_int_equal(pir_solid_sum_create(p, q, rotations[first], &options, &sum[k]), PIR_OK);
            for (int operand = 0; operand < 2; operand++)
                assert_int_equal(pir_solid_sum_set_scale(sum[k], (pir_operand)operand, scale[operand]), PIR_OK);
        }
        for (size_t i = first; i < sizeof rotations / sizeof *rotations; i++) {
            assert_int_equal(pir_solid_sum_rotate(sum[0], rotations[i], PIR_SOLID_UPDATE), PIR_OK);
            assert_int_equal(pir_solid_sum_rotate(sum[1], rotations[i], PIR_SOLID_REBUILD), PIR_OK);
            expect_same(sum[0], sum[1], "star5 and stella", i);
        }
        for (int k = 0; k < 2; k++)
            pir_solid_sum_destroy(sum[k]);
    }
    pir_solid_release(p);
    pir_solid_release(q);
}

/* The exact volume of a sum. */
static void volume_of(pir_solid_sum *sum, mpq_t ret) {
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_solid_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
    mesh_volume(mesh, ret);
    pir_mesh_destroy(mesh);
}

static void scaled_sum_is_that_of_scaled_solids(void **state) {
    (void)state;
    static const double divisors[][2] = {{4, 1}, {1, 8}, {.25, 2}, {0x1p60, 0x1p60}};
    mpq_t a, b;
    mpq_inits(a, b, NULL);
    for (size_t i = 0; i < sizeof divisors / sizeof *divisors; i++) {
        const pir_quat turn = {1, 2, 3, 4};
        pir_solid *p[2] = {solid_model_new("clamp", 1), solid_model_new("clamp", divisors[i][0])};
        pir_solid *q[2] = {solid_model_new("star5", 1), solid_model_new("star5", divisors[i][1])};
        pir_solid_sum *sum[2] = {NULL, NULL};
        for (int k = 0; k < 2; k++)
            assert_int_equal(pir_solid_sum_create(p[k], q[k], turn, NULL, &sum[k]), PIR_OK);
        for (int k = 0; k < 2; k++)
            assert_int_equal(pir_solid_sum_set_scale(sum[0], (pir_operand)k, 1 / divisors[i][k]), PIR_OK);
        volume_of(sum[0], a);
        volume_of(sum[1], b);
        expect(mpq_equal(a, b), "case %zu: volumes %g and %g", i, mpq_get_d(a), mpq_get_d(b));
        for (int k = 0; k < 2; k++) {
            pir_solid_sum_destroy(sum[k]);
            pir_solid_release(p[k]);
            pir_solid_release(q[k]);
        }
    }
    mpq_clears(a, b, NULL);
}

static void refused_call_leaves_the_sum_as_it_was(void **state) {
    (void)state;
    pir_solid *p = solid_model_new("clamp", 1);
    pir_solid_sum *sum = NULL, *other = NULL;
    pir_mesh *mesh = NULL;
    const pir_quat turn = {1, 2, 3, 4}, zero = {0, 0, 0, 0}, nan_quat = {NAN, 0, 0, 1};
    assert_int_equal(pir_solid_sum_create(p, p, zero, NULL, &sum), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_solid_sum_create(p, NULL, turn, NULL, &sum), PIR_ERR_ARGUMENT);
    assert_null(sum);
    assert_int_equal(pir_solid_sum_create(p, p, turn, NULL, &sum), PIR_OK);
    assert_int_equal(pir_solid_sum_create(p, p, turn, NULL, &other), PIR_OK);
    assert_int_equal(pir_solid_sum_rotate(sum, zero, PIR_SOLID_AUTO), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_solid_sum_rotate(sum, nan_quat, PIR_SOLID_UPDATE), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_solid_sum_rotate(NULL, turn, PIR_SOLID_AUTO), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_sum_set_scale(sum, PIR_OPERAND_P, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_sum_set_scale(sum, PIR_OPERAND_P, INFINITY), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_solid_sum_set_scale(sum, (pir_operand)7, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_sum_mesh(sum, (pir_precision)7, &mesh), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_sum_clone(sum, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_sum_generation(sum), 0);
    assert_true(pir_solid_sum_rotation(sum).z == 3);
    expect_same(sum, other, "refused", 0);
    pir_solid_sum_destroy(other);
    pir_solid_sum_destroy(sum);
    pir_solid_sum_destroy(NULL);
    pir_solid_release(p);
}

/* Whichever request for memory fails, the sum is that of the rotation and the
 * scales before. */
static void sum_outlives_rotations_that_run_out_of_memory(void **state) {
    (void)state;
    const pir_quat first = {1, 2, 3, 4}, second = {.1, .7, -.3, .6};
    pir_solid *p = solid_model_new("clamp", 1), *q = solid_model_new("stella", 2);
    unsigned failures = 0;
    for (int open = 0; open < 2; open++) {
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_solid_sum_options options = pir_solid_sum_options_default();
        pir_solid_sum *sum = NULL, *fresh = NULL;
        options.open = open != 0;
        assert_int_equal(pir_solid_sum_create(p, q, first, &options, &fresh), PIR_OK);
        options.allocator = &allocator;
        assert_int_equal(pir_solid_sum_create(p, q, first, &options, &sum), PIR_OK);
        pir_status status = PIR_ERR_MEMORY;
        for (uint64_t n = 1; status != PIR_OK; n += 1 + n / 8) {
            const uint64_t generation = pir_solid_sum_generation(sum);
            memory.fail_at = memory.requests + n;
            status = n % 2 ? pir_solid_sum_rotate(sum, second, PIR_SOLID_UPDATE)
                           : pir_solid_sum_set_scale(sum, PIR_OPERAND_Q, 3);
            memory.fail_at = 0;
            if (status == PIR_OK)
                break;
            assert_int_equal(status, PIR_ERR_MEMORY);
            assert_int_equal(pir_solid_sum_generation(sum), generation);
            expect_same(sum, fresh, "out of memory", n);
            failures++;
        }
        pir_solid_sum_destroy(sum);
        pir_solid_sum_destroy(fresh);
        expect(memory.blocks == 0 && !memory.wrong_size && !memory.overrun, "%zu blocks are left", memory.blocks);
    }
    expect(failures > 20, "%u calls failed", failures);
    pir_solid_release(q);
    pir_solid_release(p);
}

/* Likewise in an update of what is kept, and in the mesh after it. */
static void kept_sum_outlives_updates_that_run_out_of_memory(void **state) {
    (void)state;
    const pir_quat first = {.3, .1, .2, .9}, second = {.301, .1, .203, .9};
    pir_solid *p = solid_model_new("star5", 1), *q = solid_model_new("stella", 2);
    pir_solid_sum *fresh[2] = {NULL, NULL}, *sum = NULL;
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    pir_solid_sum_options options = pir_solid_sum_options_default();
    unsigned failures = 0;
    assert_int_equal(pir_solid_sum_create(p, q, first, &options, &fresh[0]), PIR_OK);
    assert_int_equal(pir_solid_sum_create(p, q, second, &options, &fresh[1]), PIR_OK);
    options.allocator = &allocator;
    assert_int_equal(pir_solid_sum_create(p, q, first, &options, &sum), PIR_OK);
    for (uint64_t n = 1, done = 0; done == 0; n += 1 + n / 16) {
        pir_mesh *mesh = NULL;
        assert_int_equal(pir_solid_sum_rotate(sum, first, PIR_SOLID_UPDATE), PIR_OK);
        memory.fail_at = memory.requests + n;
        const pir_status turned = pir_solid_sum_rotate(sum, second, PIR_SOLID_UPDATE);
        const pir_status made = turned == PIR_OK ? pir_solid_sum_mesh(sum, PIR_DOUBLE, &mesh) : turned;
        memory.fail_at = 0;
        assert_true(made == PIR_OK || made == PIR_ERR_MEMORY);
        expect_same(sum, fresh[turned == PIR_OK], "an update out of memory", n);
        pir_mesh_destroy(mesh);
        failures += made != PIR_OK;
        done = made == PIR_OK;
    }
    pir_solid_sum_destroy(sum);
    expect(memory.blocks == 0 && !memory.wrong_size && !memory.overrun, "%zu blocks are left", memory.blocks);
    expect(failures > 10, "%u calls failed", failures);
    for (int k = 0; k < 2; k++)
        pir_solid_sum_destroy(fresh[k]);
    pir_solid_release(q);
    pir_solid_release(p);
}

/* Small steps about one axis are updates that clip little; where nothing can be kept, all is made. */
static void updates_clip_what_has_changed(void **state) {
    (void)state;
    pir_solid *p = solid_model_new("mushroom6", 1), *q = solid_model_new("star5", 1);
    pir_solid_sum *sum = NULL;
    pir_solid_sum_info info;
    struct history history = {.now = {.3, .1, .2, .9}};
    uint64_t clipped = 0, candidates = 0;
    assert_int_equal(pir_solid_sum_create(p, q, history.now, NULL, &sum), PIR_OK);
    for (int frame = 0; frame < 40; frame++) {
        history.now = turned(history.now, (pir_vec3){.48, .6, .64}, 1.3e-3);
        assert_int_equal(pir_solid_sum_rotate(sum, history.now, PIR_SOLID_AUTO), PIR_OK);
        assert_int_equal(pir_solid_sum_describe(sum, &info), PIR_OK);
        clipped += frame > 0 ? info.clipped : 0;
        candidates += frame > 0 ? info.candidates : 0;
    }
    expect(clipped > 0 && 4 * clipped < candidates, "%llu of %llu", (unsigned long long)clipped,
           (unsigned long long)candidates);
    assert_int_equal(pir_solid_sum_rotate(sum, (pir_quat){0, 0, 0, 1}, PIR_SOLID_UPDATE), PIR_OK);
    assert_int_equal(pir_solid_sum_describe(sum, &info), PIR_OK);
    assert_int_equal(info.clipped, info.candidates);
    assert_int_equal(pir_solid_sum_rotate(sum, history.now, (pir_solid_method)3), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_sum_describe(NULL, &info), PIR_ERR_ARGUMENT);
    pir_solid_sum_destroy(sum);
    pir_solid_release(q);
    pir_solid_release(p);
}

/* Once a motion was gone some times, it takes no more memory, though facets come and go. */
static void motion_gone_again_takes_no_memory(void **state) {
    (void)state;
    pir_solid *p = solid_model_new("gear8", 1), *q = solid_model_new("star5", .5);
    pir_solid_sum *sum = NULL;
    pir_solid_sum_info info;
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    const pir_quat first = {.3, .1, .2, .9};
    pir_solid_sum_options options = pir_solid_sum_options_default();
    uint64_t requests = 0, clipped = 0;
    options.allocator = &allocator;
    assert_int_equal(pir_solid_sum_create(p, q, first, &options, &sum), PIR_OK);
    for (int time = 0; time < 12; time++) {
        requests = memory.requests;
        clipped = 0;
        for (int frame = 0; frame < 20; frame++) {
            const pir_quat now = turned(first, (pir_vec3){.48, .6, .64}, 1e-2 * (frame < 10 ? frame : 20 - frame));
            assert_int_equal(pir_solid_sum_rotate(sum, now, PIR_SOLID_UPDATE), PIR_OK);
            assert_int_equal(pir_solid_sum_describe(sum, &info), PIR_OK);
            clipped += info.clipped;
        }
    }
    expect(memory.requests == requests, "%llu requests for memory", (unsigned long long)(memory.requests - requests));
    expect(clipped > 500, "%llu facets clipped", (unsigned long long)clipped);
    pir_solid_sum_destroy(sum);
    expect(memory.blocks == 0, "%zu blocks are left", memory.blocks);
    pir_solid_release(q);
    pir_solid_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sum_is_that_made_anew_at_every_rotation),
        cmocka_unit_test(facets_stand_in_the_order_of_a_sum_made_anew),
        cmocka_unit_test(facets_stand_past_their_walls),
        cmocka_unit_test(scaled_sum_is_that_of_scaled_solids),
        cmocka_unit_test(refused_call_leaves_the_sum_as_it_was),
        cmocka_unit_test(sum_outlives_rotations_that_run_out_of_memory),
        cmocka_unit_test(kept_sum_outlives_updates_that_run_out_of_memory),
        cmocka_unit_test(updates_clip_what_has_changed),
        cmocka_unit_test(motion_gone_again_takes_no_memory),
    };
    return cmocka_run_group_tests_name("sums of solids that turn", tests, NULL, NULL);
}

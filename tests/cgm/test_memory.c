/* SPDX-License-Identifier: MIT */
/*
 * Memory that runs out at every n-th request, once or from then on, in every call of cubical maps that asks for some,
 * on bodies of every kind and dimension: the call says so, its result is untouched, nothing leaks, and what was there
 * before is as it was.
 */
#include "support/test.h"

#include <pirouette/cgm.h>
#include <pirouette/exact.h>

#include "cgm/build.h"
#include "support/bodies.h"
#include "support/memory.h"

/* How far a run came, and what it made. */
struct run {
    test_memory memory;
    pir_allocator allocator;
    uint32_t failures;
};

/* Whether a call ran out of memory and left `result` as `before`; every other failure fails the test. */
static bool ran_out(struct run *run, pir_status status, const void *result, const void *before) {
    if (status == PIR_OK)
        return false;
    assert_int_equal(status, PIR_ERR_MEMORY);
    assert_ptr_equal(result, before);
    run->failures++;
    return true;
}

/* What asks for memory of a map that is there: its check, its planes, a locator, its mesh. */
static void use_map(struct run *run, const pir_cgm *cgm) {
    // the check asks once, and says no where it gets nothing
    uint64_t next = run->memory.requests + 1, fail_at = run->memory.fail_at;
    bool fails = next == fail_at || (run->memory.fail_after && next > fail_at);
    assert_int_equal(pir_cgm_is_valid(cgm), !fails);
    assert_int_equal(run->memory.requests, next);
    run->failures += fails;
    mpq_t plane[4], zero;
    mpq_inits(plane[0], plane[1], plane[2], plane[3], zero, NULL);
    pir_status status = pir_cgm_vertex_plane_exact(cgm, pir_cgm_total_counts(cgm).vertices / 2, plane);
    bool untouched = true;
    for (int k = 0; k < 3; k++)
        untouched = untouched && mpq_equal(plane[k], zero);
    // a normal is not zero
    assert_int_equal(ran_out(run, status, NULL, NULL), untouched);
    mpq_clears(plane[0], plane[1], plane[2], plane[3], zero, NULL);
    pir_cgm_locator *const locator_before = (pir_cgm_locator *)&locator_before, *locator = locator_before;
    if (!ran_out(run, pir_cgm_locator_create(cgm, &locator), locator, locator_before))
        pir_cgm_locator_destroy(locator);
    for (int precision = 0; precision < 2; precision++) {
        pir_mesh *const mesh_before = (pir_mesh *)&mesh_before, *mesh = mesh_before;
        status = pir_cgm_mesh(cgm, precision ? PIR_EXACT : PIR_DOUBLE, &mesh);
        if (!ran_out(run, status, mesh, mesh_before))
            pir_mesh_destroy(mesh);
    }
}

/* The maps of both bodies, of their sum, and of the sum with itself. */
static void make_all(struct run *run, pir_polytope *p, pir_polytope *q, const pir_quat *rotation) {
    pir_cgm *const before = (pir_cgm *)&before, *a = before, *b = before, *sum = before, *twice = before;
    bool have_a = !ran_out(run, pir_cgm_create(p, rotation, &run->allocator, &a), a, before);
    bool have_b = !ran_out(run, pir_cgm_create(q, NULL, &run->allocator, &b), b, before);
    if (have_a)
        use_map(run, a);
    if (have_a && have_b && !ran_out(run, pir_cgm_overlay(a, b, &sum), sum, before)) {
        use_map(run, sum);
        if (!ran_out(run, pir_cgm_overlay(sum, a, &twice), twice, before))
            pir_cgm_release(twice);
        pir_cgm_release(sum);
    }
    if (have_b)
        pir_cgm_release(b);
    if (have_a)
        pir_cgm_release(a);
}

static void every_failing_request_is_survived(void **state) {
    (void)state;
    uint64_t failures = 0;
    for (uint64_t i = 0; i < 16; i++) {
        test_random random = test_random_case("cgm memory", i);
        pir_polytope *p = test_random_polytope(&random, (test_body)(i % TEST_BODY_COUNT), 9);
        pir_polytope *q = test_random_polytope(&random, (test_body)(test_random_below(&random, TEST_BODY_COUNT)), 9);
        // tied with the cube's planes, or not
        pir_quat rotation = i < TEST_BODY_COUNT ? test_general_rotation(&random) : (pir_quat){0, 0, 1, 1};
        for (int persistent = 0; persistent < 2; persistent++)
            for (uint64_t n = 1;; n++) {
                struct run run = {.memory = {.fail_at = n, .fail_after = persistent != 0}};
                run.allocator = test_allocator(&run.memory);
                make_all(&run, p, q, &rotation);
                expect(run.memory.blocks == 0 && run.memory.bytes == 0 && !run.memory.wrong_size,
                       "case %llu, request %llu", (unsigned long long)i, (unsigned long long)n);
                failures += run.failures;
                if (run.memory.requests < n) {
                    assert_int_equal(run.failures, 0);
                    break;
                }
            }
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    print_message("# %llu calls failed\n", (unsigned long long)failures);
    assert_true(failures > 5000);
}

/* Long thin bodies across each other: far more crossings than an overlay makes room for, so that everything
   grows, in every step of it. */
static pir_polytope *fan(test_random *random, int upright) {
    pir_vec3 points[80];
    uint32_t count = 20 + 2 * test_random_below(random, 30);
    for (uint32_t i = 0; i < count; i++) {
        double t = ((double)i / count - 0.5) * 0.8, x = (1 - t * t) / (1 + t * t), y = 2 * t / (1 + t * t);
        x += i % 2 ? 0 : 1e-3;
        points[i] = upright ? (pir_vec3){x, y, i % 2 ? 0.5 : -0.5} : (pir_vec3){x, i % 2 ? 0.5 : -0.5, y};
    }
    pir_polytope *polytope = NULL;
    assert_int_equal(pir_polytope_create(points, count, NULL, &polytope), PIR_OK);
    return polytope;
}

static void overlays_that_cannot_grow_say_so(void **state) {
    (void)state;
    uint64_t failures = 0;
    for (uint64_t i = 0; i < 40; i++) {
        test_random random = test_random_case("cgm growth", i);
        pir_polytope *p = fan(&random, 1), *q = fan(&random, 0);
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_cgm *a, *b, *const before = (pir_cgm *)&before, *sum = before;
        assert_int_equal(pir_cgm_create(p, NULL, &allocator, &a), PIR_OK);
        assert_int_equal(pir_cgm_create(q, NULL, &allocator, &b), PIR_OK);
        size_t blocks = memory.blocks;
        uint64_t asked = 0;
        for (uint64_t n = 1; asked == 0; n++) {
            memory.requests = 0;
            memory.fail_at = n;
            pir_status status = pir_cgm_overlay(a, b, &sum);
            if (status == PIR_OK) {
                asked = memory.requests < n ? n : 0;
                memory.fail_at = 0;
                assert_true(pir_cgm_is_valid(sum));
                pir_cgm_release(sum);
                sum = before;
            } else {
                assert_int_equal(status, PIR_ERR_MEMORY);
                assert_ptr_equal(sum, before);
                failures++;
            }
            expect(memory.blocks == blocks && !memory.wrong_size, "case %llu, request %llu", (unsigned long long)i,
                   (unsigned long long)n);
        }
        pir_cgm_release(b);
        pir_cgm_release(a);
        assert_int_equal(memory.blocks, 0);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    print_message("# %llu overlays failed\n", (unsigned long long)failures);
    assert_true(failures > 1500);
}

static void statistics_tell_the_bytes_that_a_map_holds(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 3 * TEST_BODY_COUNT; i++) {
        test_random random = test_random_case("cgm bytes", i);
        pir_polytope *p = test_random_polytope(&random, (test_body)(i % TEST_BODY_COUNT), 20);
        pir_quat rotation = test_general_rotation(&random);
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_cgm *a, *b, *sum;
        assert_int_equal(pir_cgm_create(p, i % 2 ? &rotation : NULL, &allocator, &a), PIR_OK);
        size_t of_a = memory.bytes;
        assert_int_equal(pir_cgm_get_statistics(a).bytes, of_a);
        assert_int_equal(pir_cgm_create(p, &rotation, &allocator, &b), PIR_OK);
        size_t of_b = memory.bytes - of_a;
        assert_int_equal(pir_cgm_get_statistics(b).bytes, of_b);
        assert_int_equal(pir_cgm_overlay(a, b, &sum), PIR_OK);
        assert_int_equal(pir_cgm_get_statistics(sum).bytes, memory.bytes - of_a - of_b);
        pir_cgm_release(sum);
        pir_cgm_release(b);
        pir_cgm_release(a);
        assert_int_equal(memory.bytes, 0);
        pir_polytope_release(p);
    }
}

/* Blocks grow to twice their size or to what is asked, and to no more elements than 32-bit numbers
   with a bit to spare count. */
static void blocks_grow_within_their_limit(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    void *block = NULL;
    uint32_t capacity = 0;
    assert_true(pir_cgm_grow(&allocator, &block, &capacity, 5, 3));
    assert_int_equal(capacity, 5);
    assert_true(pir_cgm_grow(&allocator, &block, &capacity, 5, 3) && capacity == 5);
    assert_true(pir_cgm_grow(&allocator, &block, &capacity, 6, 3) && capacity == 10);
    assert_true(pir_cgm_grow(&allocator, &block, &capacity, 100, 3) && capacity == 100);
    uint64_t requests = memory.requests;
    assert_false(pir_cgm_grow(&allocator, &block, &capacity, (UINT32_C(1) << 30) + 1, 3));
    assert_true(capacity == 100 && memory.requests == requests && memory.bytes == 300);
    pir_memory_free(&allocator, block, capacity, 3);
    assert_int_equal(memory.blocks, 0);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_failing_request_is_survived), cmocka_unit_test(overlays_that_cannot_grow_say_so),
        cmocka_unit_test(statistics_tell_the_bytes_that_a_map_holds), cmocka_unit_test(blocks_grow_within_their_limit)};
    return cmocka_run_group_tests_name("cgm memory", tests, NULL, NULL);
}

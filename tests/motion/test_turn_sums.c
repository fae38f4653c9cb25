/* SPDX-License-Identifier: MIT */
/*
 * Sums between the events of a turn. A sum that is tracked from interval to interval, at short numbers κ between
 * events, has the pairing of one made there anew, the bits of its mesh, and the true facets that the events count. So
 * it is at the doubles next to an event, and at an event that is a double, where the count is not told. At hard axes,
 * rotations and places, and where memory runs out at every n-th request, events are those of the plain run.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/pirouette.h>

#include "support/bodies.h"
#include "support/memory.h"

/* (u, κ)·q₀, for whole numbers and short κ: exact. */
static pir_quat at_kappa(pir_vec3 u, double kappa, pir_quat q) {
    return (pir_quat){kappa * q.x + u.x * q.w + u.y * q.z - u.z * q.y, kappa * q.y + u.y * q.w + u.z * q.x - u.x * q.z,
                      kappa * q.z + u.z * q.w + u.x * q.y - u.y * q.x, kappa * q.w - u.x * q.x - u.y * q.y - u.z * q.z};
}

static bool is_short(double kappa) {
    return kappa == 0 ||
           (fabs(kappa) < 0x1p+30 && fabs(kappa) > 0x1p-12 && ldexp(kappa, 34) == nearbyint(ldexp(kappa, 34)));
}

#define UNTOLD UINT32_MAX

/* The sum at κ, tracked and new, against the count of facets, unless that is UNTOLD. */
static void check_sum(pir_sum *tracked, pir_quat rotation, bool difference, uint32_t facets) {
    pir_sum *fresh = NULL;
    pir_mesh *mesh = NULL, *tracked_mesh = NULL;
    pir_sum_options options = pir_sum_options_default();
    options.difference = difference;
    assert_int_equal(pir_sum_rotate(tracked, rotation, PIR_METHOD_UPDATE), PIR_OK);
    // the operand of a difference is reflected already
    options.difference = false;
    assert_int_equal(pir_sum_create((pir_polytope *)pir_sum_p(tracked), (pir_polytope *)pir_sum_q(tracked), rotation,
                                    &options, &fresh),
                     PIR_OK);
    assert_true(pir_sum_same_pairing(tracked, fresh));
    assert_int_equal(pir_sum_mesh(fresh, PIR_DOUBLE, &mesh), PIR_OK);
    expect(facets == UNTOLD || pir_mesh_facet_count(mesh) == facets, "at %g, %g, %g, %g: %u facets, not %u", rotation.x,
           rotation.y, rotation.z, rotation.w, (unsigned)pir_mesh_facet_count(mesh), (unsigned)facets);
    assert_int_equal(pir_sum_mesh(tracked, PIR_DOUBLE, &tracked_mesh), PIR_OK);
    assert_true(pir_mesh_equal(tracked_mesh, mesh));
    pir_mesh_destroy(tracked_mesh);
    pir_mesh_destroy(mesh);
    pir_sum_destroy(fresh);
}

/*
 * The sum beside an event or at it, for the start (0, 0, 0, 1), where quaternions are exact for every double. The
 * count `before` is that of the interval before, UNTOLD where no double lies in it. Where one does, the doubles around
 * the ends are in the interval as well. Returns how many angles were looked at.
 */
static uint32_t check_beside(pir_sum *tracked, pir_events *events, pir_vec3 axis, bool difference, uint32_t before) {
    const pir_quat start = {0, 0, 0, 1};
    double kappa[2], between;
    pir_events_kappa(events, kappa);
    if (!isfinite(kappa[0]) || !isfinite(kappa[1]))
        return 0;
    const bool at_event = kappa[0] == kappa[1];
    const bool has_after = pir_events_between(events, &between) == PIR_OK;
    const uint32_t after = has_after ? pir_events_facet_count(events) : UNTOLD;
    check_sum(tracked, at_kappa(axis, kappa[1], start), difference, at_event ? UNTOLD : before);
    if (at_event)
        return 1;
    check_sum(tracked, at_kappa(axis, kappa[0], start), difference, after);
    return 2;
}

/* All intervals of a turn; returns how many were looked at, at most `most`; adds to `beside` those at events. */
static uint32_t run_turn(uint64_t number, uint32_t most, uint32_t *beside) {
    static const char *const shapes[] = {"cube",         "octahedron", "icosahedron", "geodesic?level=2",
                                         "dodecahedron", "tetrahedron"};
    test_random random = test_random_case("turn sums", number);
    pir_polytope *p, *q;
    assert_int_equal(pir_shape_create(shapes[test_random_below(&random, 6)], NULL, NULL, &p), PIR_OK);
    if (test_random_below(&random, 3) == 0) {
        pir_polytope_release(p);
        p = test_sphere(&random, 30);
    }
    assert_int_equal(pir_shape_create(shapes[test_random_below(&random, 6)], NULL, NULL, &q), PIR_OK);
    const pir_vec3 axis = {test_random_between(&random, -3, 3), test_random_between(&random, -3, 3), 2};
    const pir_quat start = number % 2 == 0 ? (pir_quat){0, 0, 0, 1} : (pir_quat){1, 2, -1, 3};
    pir_events_options options = pir_events_options_default();
    pir_sum_options sum_options = pir_sum_options_default();
    options.difference = sum_options.difference = number % 3 == 0;
    pir_events *events;
    pir_sum *sum;
    assert_int_equal(pir_events_create(p, q, start, axis, &options, &events), PIR_OK);
    assert_int_equal(pir_sum_create(p, q, start, &sum_options, &sum), PIR_OK);
    uint32_t looked = 0;
    bool found = true;
    while (found && looked < most) {
        pir_event event;
        double kappa;
        // what would come together but for rounding in the models comes without a double in between
        const pir_status status = pir_events_between(events, &kappa);
        assert_true(status == PIR_OK || status == PIR_ERR_LIMIT);
        if (status == PIR_OK && is_short(kappa)) {
            check_sum(sum, at_kappa(axis, kappa, start), options.difference, pir_events_facet_count(events));
            looked++;
        }
        const uint32_t before = status == PIR_OK ? pir_events_facet_count(events) : UNTOLD;
        assert_int_equal(pir_events_next(events, &event, &found), PIR_OK);
        if (found && number % 2 == 0)
            *beside += check_beside(sum, events, axis, options.difference, before);
    }
    pir_events_destroy(events);
    pir_sum_destroy(sum);
    pir_polytope_release(p);
    pir_polytope_release(q);
    return looked;
}

static void sums_between_events_have_the_facets_counted(void **state) {
    (void)state;
    const char *told = getenv("PIR_TEST_ANGLES");
    const uint32_t angles = told ? (uint32_t)strtoul(told, NULL, 10) : 800;
    uint32_t looked = 0, beside = 0;
    for (uint64_t i = 0; looked < angles; i++)
        looked += run_turn(i, angles - looked, &beside);
    printf("# %u angles between events, %u beside or at them\n", (unsigned)looked, (unsigned)beside);
    assert_true(beside > angles / 4);
}

/* How many events there are, and the sum of what they change. */
static uint32_t count_events(pir_events *events, uint64_t *ret_changes) {
    uint32_t count = 0;
    double last = INFINITY;
    for (*ret_changes = 0;; count++) {
        pir_event event;
        double kappa[2];
        bool found;
        assert_int_equal(pir_events_next(events, &event, &found), PIR_OK);
        if (!found)
            return count;
        pir_events_kappa(events, kappa);
        assert_true(kappa[1] <= last);
        last = kappa[1];
        *ret_changes += event.lost_count + event.gained_count;
    }
}

/* The events of a sum are those of its operands and its rotation, and it may go before them. */
static void a_sum_gives_its_events(void **state) {
    (void)state;
    for (int difference = 0; difference < 2; difference++) {
        test_random random = test_random_case("events of a sum", (uint64_t)difference);
        pir_polytope *p = test_sphere(&random, 20), *q = test_box(1, 2, 3);
        const pir_quat start = test_general_rotation(&random);
        const pir_vec3 axis = test_random_direction(&random);
        pir_sum_options sum_options = pir_sum_options_default();
        pir_events_options options = pir_events_options_default();
        sum_options.difference = options.difference = difference;
        pir_sum *sum;
        pir_events *of_sum, *events;
        assert_int_equal(pir_sum_create(p, q, start, &sum_options, &sum), PIR_OK);
        assert_int_equal(pir_sum_events(sum, axis, NULL, &of_sum), PIR_OK);
        pir_sum_destroy(sum);
        assert_int_equal(pir_events_create(p, q, start, axis, &options, &events), PIR_OK);
        pir_polytope_release(p);
        pir_polytope_release(q);
        uint64_t changes[2];
        const uint32_t count = count_events(events, &changes[0]);
        assert_int_equal(count_events(of_sum, &changes[1]), count);
        assert_true(count > 50 && changes[0] == changes[1]);
        pir_events_destroy(of_sum);
        pir_events_destroy(events);
    }
}

/* Lengths of the axis and of q₀ change nothing but κ; neither do numbers at the ends of the doubles. */
static void hard_numbers_are_taken_as_they_are(void **state) {
    (void)state;
    test_random random = test_random_case("hard turns", 0);
    pir_polytope *p = test_random_polytope(&random, TEST_FAR, 12), *q = test_box(0x1p-30, 1, 0x1p+20);
    while (pir_polytope_dimension(p) < 3) {
        pir_polytope_release(p);
        p = test_random_polytope(&random, TEST_FAR, 12);
    }
    const pir_vec3 axes[] = {{1, 2, 3},
                             {0x1p-1060, 0x1p-1059, 3 * 0x1p-1060},
                             {0x1p+1000, 0x1p+1001, 3 * 0x1p+1000},
                             {1, 0x1p-900, 0x1p+90},
                             {0x1p-1074, 1, 0}};
    for (uint32_t r = 0; r < TEST_HARD_ROTATIONS; r++) {
        uint32_t first = 0;
        for (size_t i = 0; i < sizeof axes / sizeof *axes; i++) {
            pir_events *events;
            uint64_t changes;
            assert_int_equal(pir_events_create(p, q, test_hard_rotation(r), axes[i], NULL, &events), PIR_OK);
            const uint32_t count = count_events(events, &changes);
            // the first three are one axis
            if (i == 0)
                first = count;
            expect(i > 2 || count == first, "rotation %u, axis %zu: %u events, not %u", (unsigned)r, i, (unsigned)count,
                   (unsigned)first);
            pir_events_destroy(events);
        }
    }
    pir_polytope_release(p);
    pir_polytope_release(q);
}

/* A run under an allocator: PIR_ERR_MEMORY where it fails, after which the call may be made again. */
static bool run_in(test_memory *memory, pir_polytope *p, pir_polytope *q, pir_vec3 axis, uint32_t expected) {
    const pir_allocator allocator = test_allocator(memory);
    pir_events_options options = pir_events_options_default();
    options.allocator = &allocator;
    pir_events *const before = (pir_events *)&before, *events = before;
    bool failed = false;
    const pir_status status = pir_events_create(p, q, (pir_quat){0, 0, 0, 1}, axis, &options, &events);
    if (status != PIR_OK) {
        assert_int_equal(status, PIR_ERR_MEMORY);
        assert_ptr_equal(events, before);
        return true;
    }
    uint32_t count = 0;
    for (bool found = true; found;) {
        pir_event event;
        const pir_status next = pir_events_next(events, &event, &found);
        if (next == PIR_ERR_MEMORY) {
            failed = found = true;
            continue;
        }
        assert_int_equal(next, PIR_OK);
        count += found;
    }
    assert_int_equal(count, expected);
    pir_events_destroy(events);
    return failed;
}

static void memory_runs_out_at_every_request(void **state) {
    (void)state;
    // many sides meet many at once where these are parallel, so that room grows in events
    pir_polytope *prism;
    assert_int_equal(pir_shape_create("prism?sides=12", NULL, NULL, &prism), PIR_OK);
    const pir_vec3 axis = {0, 0, 1};
    pir_events *events;
    uint64_t changes;
    assert_int_equal(pir_events_create(prism, prism, (pir_quat){0, 0, 0, 1}, axis, NULL, &events), PIR_OK);
    const uint32_t expected = count_events(events, &changes);
    assert_true(expected > 0);
    pir_events_destroy(events);
    uint64_t n = 1;
    for (bool failed = true; failed; n++) {
        test_memory memory = {.fail_at = n};
        failed = run_in(&memory, prism, prism, axis, expected);
        assert_int_equal(memory.blocks, 0);
        assert_false(memory.wrong_size);
    }
    printf("# %d requests\n", (int)n - 2);
    assert_true(n > 10);
    pir_polytope_release(prism);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_between_events_have_the_facets_counted),
        cmocka_unit_test(a_sum_gives_its_events),
        cmocka_unit_test(hard_numbers_are_taken_as_they_are),
        cmocka_unit_test(memory_runs_out_at_every_request),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

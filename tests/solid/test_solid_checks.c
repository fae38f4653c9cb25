/* SPDX-License-Identifier: MIT */
/* What the parts of a sum of solids check as they go: what contradicts itself ends the job, and is no answer. */
#include "support/test.h"

#include <stdbool.h>
#include <string.h>

#include "base/memory.h"
#include "solid/glue/closed.h"
#include "solid/models.h"
#include "solid/space/exact.h"
#include "support/solid_sums.h"

static pir_allocator allocator;
static pir_space space;

static void begin(size_t bits) {
    allocator = pir_allocator_or_default(NULL);
    pir_space_init(&space, &allocator, (size_t)1 << 30, bits);
}

static mpz_t *scratch(long x, long y, long z) {
    static mpz_t v[4];
    static bool made;
    for (int k = 0; k < 4 && !made; k++)
        mpz_init(v[k]);
    made = true;
    mpz_set_si(v[0], x);
    mpz_set_si(v[1], y);
    mpz_set_si(v[2], z);
    mpz_set_si(v[3], 1);
    return v;
}

static uint32_t point(long x, long y, long z) {
    mpz_t *v = scratch(x, y, z);
    return pir_space_add_point(&space, v[0], v[1], v[2], v[3]);
}

static uint32_t direction(long x, long y, long z) {
    mpz_t *v = scratch(x, y, z);
    return pir_space_add_direction(&space, v[0], v[1], v[2]);
}

static uint32_t plane(uint32_t normal, uint32_t at) {
    return pir_space_add_plane(&space, (const uint32_t[]){normal, PIR_SPACE_NONE}, false,
                               (const uint32_t[]){at, PIR_SPACE_NONE});
}

static void planes_that_meet_in_no_point_are_a_fault(void **state) {
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        begin(40);
        const uint32_t o = point(0, 0, 0), far = point(0, 0, 5), x = direction(1, 0, 0), z = direction(0, 0, 1);
        if (kind == 0)
            pir_space_add_meet(&space, plane(x, o), plane(z, o), plane(z, far));
        else if (kind == 1)
            pir_space_add_plane(&space, (const uint32_t[]){x, direction(2, 0, 0)}, false,
                                (const uint32_t[]){o, PIR_SPACE_NONE});
        else
            direction(0, 0, 0);
        assert_int_equal(space.status, PIR_ERR_INTERNAL);
        pir_space_finish(&space);
    }
}

/* Doubles tell neither the point nor the plane, whose exact numbers are rounded then. */
static void numbers_of_nearly_parallel_planes_are_near_the_truth(void **state) {
    (void)state;
    begin(60);
    const long far = 1L << 58;
    const uint32_t a = direction(far, 0, 0), tilted = direction(far, 1, 0), z = direction(0, 0, 1);
    const uint32_t at = point(1L << 50, 1L << 50, 1L << 50);
    const uint32_t made = pir_space_add_meet(&space, plane(a, at), plane(tilted, at), plane(z, at));
    const uint32_t across =
        pir_space_add_plane(&space, (const uint32_t[]){a, tilted}, false, (const uint32_t[]){at, PIR_SPACE_NONE});
    assert_int_equal(space.status, PIR_OK);
    for (int k = 0; k < 3; k++)
        assert_true(space.point[made].x[k] == 0x1p50 * 0x1p-61);
    assert_true(space.point[made].err <= PIR_SPACE_ERROR && space.plane[across].err <= PIR_SPACE_ERROR);
    assert_true(space.plane[across].n[2] == 1);
    pir_space_finish(&space);
}

/* A square from −r to r round the middle of the plane z = 0, one way or the other, as runs. */
static void add_square(pir_union_outline *outline, uint32_t half, long r, bool hole) {
    uint32_t corner[4];
    const long at[4][2] = {{-r, -r}, {r, -r}, {r, r}, {-r, r}};
    for (int i = 0; i < 4; i++)
        corner[i] = point(at[i][0], at[i][1], 0);
    for (int i = 0; i < 4; i++) {
        const uint32_t from = corner[hole ? 3 - i : i], to = corner[hole ? (6 - i) % 4 : (i + 1) % 4];
        pir_union_outline_push(outline, (pir_run){0, half, outline->run_count, from, to, 1});
    }
}

static void hole_lies_in_the_innermost_facet_that_doubles_cannot_tell(void **state) {
    (void)state;
    begin(60);
    pir_union_outline outline;
    pir_loop_list loops = {0};
    pir_union_outline_init(&outline, &space);
    const uint32_t half = pir_half(plane(direction(0, 0, 1), point(0, 0, 0)), false);
    const long r = 1L << 58;
    for (int i = 0; i < 4; i++)
        add_square(&outline, half, r - i, i % 2);
    outline.loose = 1;
    pir_loops_begin(&loops, &space);
    pir_loops_trace(&loops, &outline);
    assert_int_equal(space.status, PIR_OK);
    assert_int_equal(loops.facet_count, 2);
    assert_int_equal(loops.hole_count, 2);
    // each facet is its square, a slit both ways and its hole
    assert_int_equal(loops.facet[0], 10);
    assert_int_equal(loops.facet[1], 20);
    pir_loop_list_finish(&loops);
    pir_union_outline_finish(&outline);
    pir_space_finish(&space);
}

static void outline_that_does_not_close_ends_the_job(void **state) {
    (void)state;
    for (uint32_t drop = 0; drop < 4; drop++) {
        begin(40);
        pir_union_outline outline;
        pir_loop_list loops = {0};
        pir_union_outline_init(&outline, &space);
        const uint32_t half = pir_half(plane(direction(0, 0, 1), point(0, 0, 0)), false);
        add_square(&outline, half, 100, false);
        outline.run[drop] = outline.run[--outline.run_count];
        // and one that leads into a loop which it is no part of
        pir_union_outline_push(&outline, (pir_run){0, half, 9, point(7, 500, 0), outline.run[0].a, 1});
        pir_loops_begin(&loops, &space);
        pir_loops_trace(&loops, &outline);
        assert_int_equal(space.status, PIR_ERR_INTERNAL);
        pir_loop_list_finish(&loops);
        pir_union_outline_finish(&outline);
        pir_space_finish(&space);
    }
}

/* The facets of a tetrahedron, without the last `missing`. */
static pir_status check_tetrahedron(uint32_t missing, bool turned) {
    static const uint32_t corner[12] = {1, 2, 3, 1, 4, 2, 2, 4, 3, 3, 4, 1};
    uint32_t facet[4] = {3, 6, 9, 12}, own[12];
    begin(40);
    for (int i = 0; i < 12; i++)
        own[i] = corner[i];
    if (turned) {
        own[0] = corner[1];
        own[1] = corner[0];
    }
    pir_loop_list loops = {.space = &space,
                           .facet_count = 4 - missing,
                           .boundary_count = 4 - missing,
                           .facet = facet,
                           .facet_corner = own,
                           .facet_corner_count = 12 - 3 * missing};
    pir_loops_check_closed(&loops);
    const pir_status status = space.status;
    pir_space_shrink(&space, loops.seat, loops.seat_room, sizeof *loops.seat);
    pir_space_finish(&space);
    return status;
}

static void surface_that_is_open_is_withheld(void **state) {
    (void)state;
    assert_int_equal(check_tetrahedron(0, false), PIR_OK);
    assert_int_equal(check_tetrahedron(1, false), PIR_ERR_INTERNAL);
    assert_int_equal(check_tetrahedron(0, true), PIR_ERR_INTERNAL);
}

static void limit_is_told_with_its_value_and_the_place(void **state) {
    (void)state;
    pir_solid *p = solid_model_new("gear8", 1);
    pir_solid_sum_options options = pir_solid_sum_options_default();
    pir_decompose_options decompose = pir_decompose_options_default();
    pir_report report = {0};
    pir_mesh *mesh = NULL;
    pir_pieces *pieces = NULL;
    options.report = decompose.report = &report;
    options.memory = 1000000;
    assert_int_equal(solid_sum_mesh(p, p, (pir_quat){0, 0, 0, 1}, &options, NULL, &mesh), PIR_ERR_LIMIT);
    expect(report.status == PIR_ERR_LIMIT && strstr(report.text, "limit of 1000000 bytes") &&
               strstr(report.text, "adding pairs of pieces, ") && strstr(report.text, " of 289 done"),
           "%s", report.text);
    assert_null(mesh);
    decompose.memory = 20000;
    assert_int_equal(pir_solid_decompose(p, &decompose, NULL, &pieces), PIR_ERR_LIMIT);
    expect(strstr(report.text, "limit of 20000 bytes"), "%s", report.text);
    pir_solid_release(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_that_meet_in_no_point_are_a_fault),
        cmocka_unit_test(numbers_of_nearly_parallel_planes_are_near_the_truth),
        cmocka_unit_test(hole_lies_in_the_innermost_facet_that_doubles_cannot_tell),
        cmocka_unit_test(outline_that_does_not_close_ends_the_job),
        cmocka_unit_test(surface_that_is_open_is_withheld),
        cmocka_unit_test(limit_is_told_with_its_value_and_the_place),
    };
    return cmocka_run_group_tests_name("what sums of solids check", tests, NULL, NULL);
}

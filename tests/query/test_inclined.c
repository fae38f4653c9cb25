/* SPDX-License-Identifier: MIT */
/*
 * Contacts of bodies that have no facet towards the other one: a segment at any inclination over a slab, a thin plate
 * on its corner. Their patch begins as one vertex and goes on along the edge that rises least.
 */
#include "support/test.h"

#include <math.h>

#include "query/contact_scene.h"
#include "support/vectors.h"

/* A slab whose top is at height 0. */
static pir_polytope *slab(void) {
    const pir_vec3 points[8] = {{-9, -9, -2}, {9, -9, -2}, {-9, 9, -2}, {9, 9, -2},
                                {-9, -9, 0},  {9, -9, 0},  {-9, 9, 0},  {9, 9, 0}};
    pir_polytope *p = NULL;
    assert_int_equal(pir_polytope_create(points, 8, NULL, &p), PIR_OK);
    return p;
}

static pir_polytope *body(const pir_vec3 *points, size_t count) {
    pir_polytope *p = NULL;
    assert_int_equal(pir_polytope_create(points, count, NULL, &p), PIR_OK);
    return p;
}

/* One contact at each of the heights above the slab, in any order. */
static void expect_heights(const contact_scene *scene, const double *heights, size_t count, double angle) {
    expect(scene->count == count, "%g: %zu contacts instead of %zu", angle, scene->count, count);
    for (size_t k = 0; k < count; k++) {
        size_t found = 0;
        for (size_t i = 0; i < scene->count; i++)
            found += fabs(scene->contact[i].distance - heights[k]) < 1e-12;
        expect(found == 1, "%g: %zu contacts at height %.17g", angle, found, heights[k]);
    }
}

static void a_segment_over_a_slab_has_both_ends_within_the_margin(void **state) {
    (void)state;
    static const double angles[6] = {1e-6, 1e-3, 0.03, 0.3, 0.9, 1.3}, gaps[3] = {0.01, 0, -0.02};
    const pir_vec3 ends[2] = {{-1, 0, 0}, {1, 0, 0}};
    for (size_t i = 0; i < 18; i++) {
        double angle = angles[i / 3], gap = gaps[i % 3], rise = 2 * sin(angle);
        // about y by −angle: the end at −x is the lower one
        const pir_quat r = {0, -sin(angle / 2), 0, cos(angle / 2)};
        contact_scene scene = contact_scene_make(body(ends, 2), slab(), r);
        scene.t = (pir_vec3){0.1, 0.2, gap + rise / 2};
        scene.margin = fmax(gap, 0) + rise + 0.001;
        contact_scene_check(&scene, "segment", i);
        expect_heights(&scene, (double[2]){gap, gap + rise}, 2, angle);
        contact_scene_clear(&scene);
    }
}

static void a_plate_on_its_corner_has_the_corner_that_rises_least(void **state) {
    (void)state;
    // a rectangle in the plane y = 0: from its lowest corner one edge rises by 0.2, the other by 1
    const pir_vec3 corners[4] = {{0, 0, 0}, {1, 0, 0.2}, {-0.2, 0, 1}, {0.8, 0, 1.2}};
    const pir_quat still = {0, 0, 0, 1};
    contact_scene scene = contact_scene_make(body(corners, 4), slab(), still);
    scene.t = (pir_vec3){0, 0, 0.01};
    scene.margin = 0.5;
    contact_scene_check(&scene, "plate", 0);
    expect_heights(&scene, (double[2]){0.01, 0.21}, 2, 0.2);
    contact_scene_clear(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_segment_over_a_slab_has_both_ends_within_the_margin),
                                       cmocka_unit_test(a_plate_on_its_corner_has_the_corner_that_rises_least)};
    return cmocka_run_group_tests_name("inclined", tests, NULL, NULL);
}

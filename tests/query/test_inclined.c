/* SPDX-License-Identifier: MIT */
/*
 * Contacts of bodies that have no facet towards the other one: a segment at any inclination over a slab, a thin plate
 * on its corner. Their patch begins as one vertex and goes on along the edge that rises least. And of a needle, whose
 * patch holds facets at any angle.
 */
#include "support/test.h"

#include <math.h>

#include "query/contact_scene.h"
#include "support/bodies.h"
#include "support/random.h"
#include "support/vectors.h"

/* A slab whose top is at height 0. */
static pir_polytope *slab(void) {
    const pir_vec3 points[8] = {{-9, -9, -2}, {9, -9, -2}, {-9, 9, -2}, {9, 9, -2},
                                {-9, -9, 0},  {9, -9, 0},  {-9, 9, 0},  {9, 9, 0}};
    pir_polytope *p = NULL;
    assert_int_equal(pir_polytope_create(points, 8, NULL, &p), PIR_OK);
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
        contact_scene scene = contact_scene_make(test_hull(ends, 2), slab(), r);
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
    contact_scene scene = contact_scene_make(test_hull(corners, 4), slab(), still);
    scene.t = (pir_vec3){0, 0, 0.01};
    scene.margin = 0.5;
    contact_scene_check(&scene, "plate", 0);
    expect_heights(&scene, (double[2]){0.01, 0.21}, 2, 0.2);
    contact_scene_clear(&scene);
}

/*
 * A needle 160 long and 0.004 thick in a body. Its patch goes around it, to facets that are nearly along the normal and
 * yet wider than rounding. Contacts on those were put on the planes beside them, 7e-8 off.
 */
static void contacts_beside_a_needle_lie_on_it(void **state) {
    (void)state;
    const pir_vec3 points[10] = {{0.1366271016794145, -0.82930411015622463, -0.24915081780089632},
                                 {0.0061154252612227733, 0.010409043168903898, -0.59539816455920835},
                                 {-0.65028550243264838, -0.92656148495802393, 0.8375694684553463},
                                 {-0.86675123465038784, 0.43933857763512751, 0.38217610840970084},
                                 {-0.43035863068977598, 0.28763898266891053, 0.79217480718447764},
                                 {-0.69462122769847756, -0.41170302569628037, -0.99383823984317754},
                                 {-0.48678348250929804, 0.61422223279270804, 0.706623006566238},
                                 {0.24684697723304039, 0.68652865663353824, 0.54245744968240017},
                                 {0.21707092455301447, -0.29253708510028131, 0.15142014822464778},
                                 {-0.59866497914466121, 0.71941512513402128, -0.7592691620330414}};
    const pir_vec3 needle[9] = {{-8.6652577635081265, 0.0017421385704296331, 0.0029370765247895688},
                                {68.167847586349467, 0.0014867123363605957, -0.0011735483139874599},
                                {55.16719218369586, 0.0022597606628754589, 0.0019045455451507649},
                                {-89.210083744745219, -0.0013197698346146612, 0.0022685158200397128},
                                {68.795789630113575, -0.0010101961296247503, 0.00020083264839221643},
                                {-62.418069505181165, 0.0014877635630621922, -0.001512206050944392},
                                {71.473963271668396, -0.00097021075344427788, 0.0018321467126937536},
                                {-26.134251386501916, -0.0026753999385623825, -0.0017416378983377563},
                                {-21.163585594382404, 0.0016444353293342518, -0.0019736960285414314}};
    const pir_quat r = {-15825507123.598532, 21333670007.519531, -16685079549.675241, 12710586795.677927};
    contact_scene scene = contact_scene_make(test_hull(points, 10), test_hull(needle, 9), r);
    scene.t = (pir_vec3){7.2558193423008661e-14, -2.2674435444690207e-15, -0.16145334610816486};
    scene.margin = 20;
    contact_scene_check(&scene, "needle", 0);
    assert_int_equal(contact_scene_corners(&scene), 4);
    contact_scene_clear(&scene);
}

/* --- edges that are nearly parallel --- */

/* Two segments at an angle: the second contact was beside P by up to 1e-6. */
static void contacts_of_segments_nearly_parallel_are_over_each_other(void **state) {
    (void)state;
    const pir_vec3 ends[2] = {{-1, 0, 0}, {1, 0, 0}};
    size_t pairs = 0;
    for (uint64_t i = 0; i < 2000; i++) {
        test_random random = test_random_case("nearly parallel", i);
        double angle = ldexp(1 + fabs(test_random_unit(&random)), -(int)(i % 45) - 6);
        const pir_quat r = {0, 0, -sin(angle / 2), cos(angle / 2)};
        contact_scene scene = contact_scene_make(test_hull(ends, 2), test_hull(ends, 2), r);
        scene.t = (pir_vec3){0.5 * test_random_unit(&random) * (i % 2 ? 1 : 1e-3),
                             ldexp(test_random_unit(&random), -(int)(i / 45 % 27)),
                             ldexp(fabs(test_random_unit(&random)), -(int)(i / 45 % 29))};
        scene.margin = i % 2;
        contact_scene_check(&scene, "segments", i);
        pairs += scene.count > 1;
        contact_scene_clear(&scene);
    }
    print_message("# %zu manifolds of two segments have more than one contact\n", pairs);
    assert_true(pairs > 50);
}

/* The edge of a box along a needle thinner than PIR_FLUSH, whose patch is a segment: points were 8e-8 off. */
static void contacts_of_an_edge_along_a_needle_are_over_each_other(void **state) {
    (void)state;
    const pir_vec3 needle[5] = {{0x1.f6adfd10feff9p-1, 0x1.45fc5f90577c2p-26, -0x1.d1776b10868cap-31},
                                {0x1.8cf7946526181p-3, 0x1.a949e9cff1dd4p-26, 0x1.97b7562bc8addp-24},
                                {-0x1.fcb06bf558197p-1, 0x1.11e94ae23c5f7p-27, 0x1.15c936cdaf5f1p-27},
                                {-0x1.c47406c712fd6p-1, 0x1.646e12c599bbfp-25, -0x1.7411d869fed45p-26},
                                {0x1.44a11d65594d1p-4, 0x1.901192116e533p-25, -0x1.7a8b132f3f242p-24}};
    contact_scene scene =
        contact_scene_make(contact_scene_box(1, 0x1.39a3a943fb868p-1, 1), test_hull(needle, 5), (pir_quat){0, 0, 0, 1});
    scene.t = (pir_vec3){0x1.ff56ac4c1642ap-1, 0x1.7f05fbada3c6p+0, 0x1.31690bc2d5d3dp+0};
    scene.margin = 10;
    contact_scene_check(&scene, "needle along an edge", 0);
    // the box's corner over x = -0.0013 is beside the needle
    assert_int_equal(scene.count, 2);
    contact_scene_clear(&scene);
}

/*
 * A plate whose lower facet an ulp has split, over an inclined facet. The way from one half to the rim passes the
 * other, which is lower by less than rounding: a contact was put on the plane of the facet, 1.3e-6 beside the plate.
 */
static void contacts_of_a_plate_that_an_ulp_has_split_lie_on_it(void **state) {
    (void)state;
    const double half = 0x1.0c6f7a0b5ed8dp-20;
    const pir_vec3 plate[8] = {{-0x1.0000000000002p+0, -1, -half},
                               {1, -1, -0x1.0c6f7a0b5ed8fp-20},
                               {-1, 1, -half},
                               {1, 1, -half},
                               {-1, -1, half},
                               {1, -1, half},
                               {-1, 1, half},
                               {1, 1, half}};
    const pir_vec3 lattice[13] = {{-0x1.ffffffffffffep-1, -0x1.0000000000001p+1, 0},
                                  {-1, 1, -1},
                                  {1, -1, -1},
                                  {0, 2, 1},
                                  {0, -2, 0},
                                  {-1, 0, 1},
                                  {1, 1, 2},
                                  {-1, 1, 2},
                                  {0, 2, 2},
                                  {2, -1, -2},
                                  {-2, 2, 0},
                                  {0, 2, -2},
                                  {2, 1, 0}};
    contact_scene scene = contact_scene_make(test_hull(plate, 8), test_hull(lattice, 13), (pir_quat){0, 0, 0, 1});
    scene.t = (pir_vec3){0x1.26783a298ccaep-1, -0x1.8613dc46a0e0ep-1, 0x1.000008637bd06p+1};
    contact_scene_check(&scene, "split plate", 0);
    contact_scene_clear(&scene);
}

/* --- tilted facets --- */

/* A prism about z, of half height 0.5 and radius 1, rotated in double. */
static pir_polytope *prism(uint32_t sides, pir_quat turned) {
    pir_vec3 at[128];
    for (uint32_t i = 0; i < sides; i++) {
        double angle = 2 * acos(-1.0) * i / sides;
        at[i] = (pir_vec3){cos(angle), sin(angle), -0.5};
        at[sides + i] = (pir_vec3){cos(angle), sin(angle), 0.5};
    }
    return contact_scene_baked(at, 2 * sides, turned);
}

/*
 * A prism rocks on a slab. Of its rim some edges are flatter than PIR_FLAT between 0.06 and 1 degrees of tilt, and only
 * those corners were contacts. All corners are, whether within the margin or below the surface.
 */
static void a_prism_tilted_by_any_angle_has_all_its_corners(void **state) {
    (void)state;
    static const uint32_t sides[4] = {3, 8, 16, 64};
    static const double degrees[14] = {0, 1e-9, 0.01, 0.05, 0.06, 0.08, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 2, 5};
    const pir_quat still = {0, 0, 0, 1}, baked = {0.3, -0.2, 0.5, 0.7}, back = {-0.3, 0.2, -0.5, 0.7};
    for (uint64_t i = 0; i < 4 * 14 * 4; i++) {
        double angle = degrees[i / 4 % 14] * acos(-1.0) / 180, c = cos(angle / 2), s = sin(angle / 2);
        bool is_baked = i / 56 % 2, deep = i / 112;
        pir_quat r = {0, s, 0, c};
        // the tilt after what takes the rotation in double back
        pir_quat both = {c * back.x + s * back.z, c * back.y + s * back.w, c * back.z - s * back.x,
                         c * back.w - s * back.y};
        contact_scene scene =
            contact_scene_make(prism(sides[i % 4], is_baked ? baked : still), slab(), is_baked ? both : r);
        scene.t = (pir_vec3){0, 0, 0.5 * cos(angle) + sin(angle) + (deep ? -0.3 : 0.001)};
        scene.margin = deep ? 0 : 0.3;
        contact_scene_check(&scene, "prism", i);
        expect(contact_scene_corners(&scene) == sides[i % 4], "%u sides, %g degrees%s%s: %zu corners", sides[i % 4],
               degrees[i / 4 % 14], is_baked ? ", rotated in double" : "", deep ? ", deep" : "",
               contact_scene_corners(&scene));
        contact_scene_clear(&scene);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_segment_over_a_slab_has_both_ends_within_the_margin),
                                       cmocka_unit_test(a_plate_on_its_corner_has_the_corner_that_rises_least),
                                       cmocka_unit_test(contacts_beside_a_needle_lie_on_it),
                                       cmocka_unit_test(contacts_of_segments_nearly_parallel_are_over_each_other),
                                       cmocka_unit_test(contacts_of_an_edge_along_a_needle_are_over_each_other),
                                       cmocka_unit_test(contacts_of_a_plate_that_an_ulp_has_split_lie_on_it),
                                       cmocka_unit_test(a_prism_tilted_by_any_angle_has_all_its_corners)};
    return cmocka_run_group_tests_name("inclined", tests, NULL, NULL);
}

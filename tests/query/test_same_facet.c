/* SPDX-License-Identifier: MIT */
/*
 * Facets of D by doubles alone, and climbs in both bodies of a frame: every version gives the bits of the plain one,
 * for facets that hold the foot of x, for others, and for what is no facet at all.
 */
#include "support/test.h"

#include <string.h>

#include "base/processor.h"
#include "facet_scene.h"
#include "query/walk/walker.h"

static void check_piece(const facet_scene *scene, const pir_placement *placement, pir_piece piece, uint32_t proven[3]) {
    pir_same_facet plain, same;
    memset(&plain, 0, sizeof plain);
    pir_same is = pir_processor_version(0)->walker->prove(&scene->frame, placement, piece, &plain);
    proven[piece.kind] += is == PIR_SAME_PROVEN;
    for (unsigned version = 1; pir_processor_version(version); version++) {
        memset(&same, 0, sizeof same);
        assert_int_equal(pir_processor_version(version)->walker->prove(&scene->frame, placement, piece, &same), is);
        if (is == PIR_SAME_PROVEN)
            assert_memory_equal(&same, &plain, sizeof same);
        if (is == PIR_SAME_NEAR)
            assert_true(pir_facet_same(&same.facet, &plain.facet) && same.margin == plain.margin);
    }
}

static void check_supports(test_random *random, const pir_frame *frame) {
    const pir_vec3 n = test_random_direction(random);
    const uint32_t from_a = test_random_below(random, frame->p.polytope->vertex_count);
    const uint32_t from_b = test_random_below(random, frame->q.polytope->vertex_count);
    uint32_t a = from_a, b = from_b;
    pir_vec3 back;
    pir_processor_version(0)->walker->supports(frame, n, &a, &b, &back);
    for (unsigned version = 1; pir_processor_version(version); version++) {
        uint32_t c[2] = {from_a, from_b}, at[2] = {a, b};
        pir_vec3 turned;
        pir_processor_version(version)->walker->supports(frame, n, &c[0], &c[1], &turned);
        assert_true(c[0] == a && c[1] == b && memcmp(&turned, &back, sizeof back) == 0);
        // from where it ends it goes no further
        pir_processor_version(version)->walker->supports(frame, n, &at[0], &at[1], &turned);
        assert_true(at[0] == a && at[1] == b);
    }
}

static void versions_give_the_same_bits(void **state) {
    (void)state;
    uint32_t proven[3] = {0}, cases = 400;
    for (uint64_t i = 0; i < cases; i++) {
        test_random random = test_random_case("same facet", i);
        facet_scene scene;
        facet_scene_make(&random, &scene);
        for (int k = 0; k < 40; k++) {
            pir_vec3 in, normal;
            pir_piece piece = facet_scene_piece(&random, &scene.frame, &in, &normal);
            pir_placement placement = facet_scene_place(&random, &scene.frame, in, normal);
            check_piece(&scene, &placement, piece, proven);
            check_supports(&random, &scene.frame);
        }
        facet_scene_free(&scene);
    }
    print_message("%u and %u facets of a body, %u of two edges proven\n", proven[PIR_FACET_FV], proven[PIR_FACET_VF],
                  proven[PIR_FACET_EE]);
    assert_true(proven[0] > cases && proven[1] > cases && proven[2] > cases);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(versions_give_the_same_bits)};
    return cmocka_run_group_tests_name("same facet", tests, NULL, NULL);
}

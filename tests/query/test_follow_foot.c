/* SPDX-License-Identifier: MIT */
/*
 * From facet to facet after the foot of x. Every version gives the bits of the plain one. Where x is inside of D the
 * end is a facet that holds the foot, mostly with less slack than the start; and where its disc and the ball in D tell
 * that it is the least, it is the least of all planes that D can have, one after another.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include "base/processor.h"
#include "facet_scene.h"
#include "query/walk/foot.h"
#include "query/walk/walker.h"

/* What this test takes for rounding. */
#define ROUNDING 1e-9

/* --- all planes --- */

static double support(const pir_body *body, pir_vec3 n) {
    double most = -HUGE_VAL;
    for (uint32_t v = 0; v < body->polytope->vertex_count; v++)
        most = fmax(most, pir_vec_dot(n, body->vertex[v]));
    return most;
}

/* How far x is below the plane that touches D along n, a unit vector. */
static double slack_along(const pir_frame *frame, pir_vec3 n, pir_vec3 x) {
    return support(&frame->p, pir_mat_apply_transposed(&frame->r, n)) + support(&frame->q, n) - pir_vec_dot(n, x);
}

/* The least slack along the normals of facets and across all pairs of edges, either way. */
static double least_slack(const pir_frame *frame, pir_vec3 x) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    double least = HUGE_VAL;
    for (uint32_t f = 0; f < p->facet_count; f++)
        least = fmin(least, slack_along(frame, pir_mat_apply(&frame->r, p->normal[f]), x));
    for (uint32_t g = 0; g < q->facet_count; g++)
        least = fmin(least, slack_along(frame, q->normal[g], x));
    for (uint32_t e = 0; e < p->edge_count; e++) {
        pir_vec3 along = pir_mat_apply(&frame->r, p->direction[p->edge_half[e]]);
        for (uint32_t h = 0; h < q->half_count; h++) {
            pir_vec3 n = pir_vec_cross(q->direction[h], along);
            double length = sqrt(pir_vec_dot(n, n));
            if (length > 1e-6)
                least = fmin(least, slack_along(frame, pir_vec_scale(n, 1 / length), x));
        }
    }
    return least;
}

/* --- the way --- */

/* Goes on from a piece by all versions. Returns what is said of it first; *ret_end is by the plain version. */
static pir_same follow(const pir_frame *frame, const pir_placement *placement, pir_piece piece,
                       pir_same_facet *ret_start, pir_same_facet *ret_end, pir_same *ret_is) {
    memset(ret_start, 0, sizeof *ret_start);
    pir_same from = pir_processor_version(0)->walker->prove(frame, placement, piece, ret_start);
    *ret_end = *ret_start;
    *ret_is = pir_processor_version(0)->walker->follow(frame, placement, from, ret_end);
    for (unsigned version = 1; pir_processor_version(version); version++) {
        pir_same_facet other = *ret_start;
        assert_int_equal(pir_processor_version(version)->walker->follow(frame, placement, from, &other), *ret_is);
        if (*ret_is == PIR_SAME_PROVEN)
            assert_true(memcmp(&other.facet, &ret_end->facet, sizeof other.facet) == 0 &&
                        memcmp(&other.touch, &ret_end->touch, sizeof other.touch) == 0 &&
                        other.slack == ret_end->slack && other.margin == ret_end->margin);
    }
    return from;
}

struct counts {
    uint32_t ways, ended, settled, others, rose;
};

/* A way inside of D. */
static void check_way(const pir_frame *frame, const pir_placement *placement, pir_piece piece, double least,
                      struct counts *counts) {
    pir_same_facet start, end;
    pir_same is, from = follow(frame, placement, piece, &start, &end, &is);
    if (from > PIR_SAME_BESIDE)
        return;
    counts->ways++;
    if (is != PIR_SAME_PROVEN)
        return;
    counts->ended++;
    // a plane that touches D, and its foot in D
    assert_true(fabs(slack_along(frame, end.facet.n, placement->x) - end.slack) < ROUNDING);
    assert_true(least_slack(frame, pir_vec_add(placement->x, pir_vec_scale(end.facet.n, end.slack))) > -ROUNDING);
    if (from == PIR_SAME_BESIDE)
        counts->rose += start.facet.h - pir_vec_dot(start.facet.n, placement->x) < end.slack - ROUNDING;
    bool is_least = end.slack < least + ROUNDING;
    counts->others += !is_least;
    if (pir_foot_settles_within(frame, placement, &end.facet, end.slack, end.margin)) {
        counts->settled++;
        assert_true(is_least);
    }
}

/* A place that is mostly inside of D, under a point of its surface. */
static pir_placement place_under(test_random *random, const pir_frame *frame, pir_vec3 in) {
    pir_placement placement;
    memset(&placement, 0, sizeof placement);
    placement.x = pir_vec_scale(in, 1 - (test_random_below(random, 2) ? 0.4 : 0.1) * test_random_unit(random));
    pir_frame_set_reach(frame, 0, &placement);
    return placement;
}

static bool has_insides(const facet_scene *scene) {
    return scene->frame.p.polytope->dimension == 3 && scene->frame.q.polytope->dimension == 3;
}

static void a_processor_with_avx2_has_its_version(void **state) {
    (void)state;
#if defined(__x86_64__) && defined(__GNUC__)
    if (__builtin_cpu_supports("avx2")) {
        assert_non_null(pir_processor_version(1));
    }
#endif
    // the plain table, that of AVX2 and that of AVX-512
    assert_null(pir_processor_version(3));
}

static void inside_the_end_holds_the_foot(void **state) {
    (void)state;
    struct counts counts = {0};
    for (uint64_t i = 0; i < 200; i++) {
        test_random random = test_random_case("follow foot", i);
        facet_scene scene;
        facet_scene_make(&random, &scene);
        for (int k = 0; k < 12 && has_insides(&scene); k++) {
            pir_vec3 in, other, normal;
            pir_piece piece = facet_scene_piece(&random, &scene.frame, &in, &normal);
            pir_piece far = facet_scene_piece(&random, &scene.frame, &other, &normal);
            pir_placement placement = place_under(&random, &scene.frame, in);
            double least = least_slack(&scene.frame, placement.x);
            if (!(least > ROUNDING))
                continue;
            check_way(&scene.frame, &placement, piece, least, &counts);
            check_way(&scene.frame, &placement, far, least, &counts);
        }
        facet_scene_free(&scene);
    }
    print_message("%u ways, %u to their end: %u settled, %u not at the least facet, %u astray\n", counts.ways,
                  counts.ended, counts.settled, counts.others, counts.rose);
    assert_true(counts.ended > counts.ways / 2 && counts.settled > counts.ended / 8 && counts.others > 50);
    // only where facets are coplanar but for rounding
    assert_true(counts.rose < counts.ended / 50);
}

static void outside_versions_give_the_same_bits(void **state) {
    (void)state;
    uint32_t ended = 0;
    for (uint64_t i = 0; i < 400; i++) {
        test_random random = test_random_case("follow foot outside", i);
        facet_scene scene;
        facet_scene_make(&random, &scene);
        for (int k = 0; k < 20; k++) {
            pir_vec3 in, other, normal, far;
            facet_scene_piece(&random, &scene.frame, &in, &normal);
            pir_piece piece = facet_scene_piece(&random, &scene.frame, &other, &far);
            pir_placement placement = facet_scene_place(&random, &scene.frame, in, normal);
            pir_same_facet start, end;
            pir_same is, from = follow(&scene.frame, &placement, piece, &start, &end, &is);
            ended += from <= PIR_SAME_BESIDE && is == PIR_SAME_PROVEN;
            assert_true(has_insides(&scene) || is == from);
        }
        facet_scene_free(&scene);
    }
    print_message("%u ways to their end\n", ended);
    assert_true(ended > 100);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_processor_with_avx2_has_its_version),
        cmocka_unit_test(inside_the_end_holds_the_foot),
        cmocka_unit_test(outside_versions_give_the_same_bits),
    };
    return cmocka_run_group_tests_name("follow foot", tests, NULL, NULL);
}

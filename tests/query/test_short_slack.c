/* SPDX-License-Identifier: MIT */
/*
 * Slacks in integers of fixed length are those in integers of any length, to the bit, for facets, vertices and edges of
 * scenes that are aligned, nearly aligned and general, from 1e-150 to 1e150, Q standing, moved, or turned and moved;
 * and where coordinates are doubles of like size they are not refused.
 */
#include "support/test.h"

#include <string.h>

#include "pair/pair.h"
#include "query/decide/short_slack.h"
#include "query/exact_poses.h"

#define SCENES 150
#define POSES  6
#define PIECES 12

/* Any facet with any vertex, or any two edges. */
static pir_piece random_piece(test_random *random, const pir_polytope *p, const pir_polytope *q) {
    pir_piece piece = {PIR_FACET_FV, test_random_below(random, p->facet_count),
                       test_random_below(random, q->vertex_count)};
    uint32_t kind = test_random_below(random, 3);
    if (kind == 1)
        piece = (pir_piece){PIR_FACET_VF, test_random_below(random, p->vertex_count),
                            test_random_below(random, q->facet_count)};
    if (kind == 2)
        piece = (pir_piece){PIR_FACET_EE, test_random_below(random, p->edge_count),
                            q->edge_half[test_random_below(random, q->edge_count)]};
    return piece;
}

/* The slack by the integers of placed.h. False where the edges are parallel. */
static bool long_slack(pir_exact *exact, pir_vec3 translation, const pir_facet *facet, int *ret_sign,
                       double *ret_slack) {
    pir_exact_begin(exact, translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 normal = pir_exact_normal(exact, facet->piece), corner = pir_exact_corner(exact, facet->a, facet->b);
    bool some = !pir_int3_is_zero(&normal);
    if (some) {
        pir_int dot = pir_exact_dot(exact, &normal, &corner);
        pir_real slack = pir_real_over(pir_real_of(&dot), pir_exact_length(exact, &normal));
        *ret_sign = pir_int_sign(&dot);
        *ret_slack = pir_real_double(pir_real_times(slack, pir_exact_unit(exact)));
    }
    exact->scratch.used = mark;
    return some;
}

/* Counts the pieces that were looked at and those that were short. */
struct count {
    uint32_t seen, brief;
};

static void check_pose(test_random *random, pir_workspace *workspace, const pir_placement *placement, uint64_t scene,
                       struct count *count) {
    pir_frame *frame = &workspace->frame;
    for (int k = 0; k < PIECES; k++) {
        pir_facet facet = {.piece = random_piece(random, frame->p.polytope, frame->q.polytope)};
        int sign, side;
        double slack, brief;
        pir_piece_corner(frame, facet.piece, &facet.a, &facet.b);
        if (!long_slack(&workspace->exact, placement->translation, &facet, &sign, &slack))
            continue;
        count->seen++;
        if (!pir_short_slack(&workspace->exact, placement->translation, &facet, &side, &brief))
            continue;
        count->brief++;
        expect(side == sign && memcmp(&slack, &brief, sizeof slack) == 0, "scene %llu: %.17g is not %.17g",
               (unsigned long long)scene, brief, slack);
    }
}

/* How Q is posed. */
enum { STANDS, MOVED, TURNED, WAYS };

/* `count`: for each way that Q is posed. */
static void run_scene(uint64_t number, pir_workspace *workspace, struct count count[WAYS]) {
    test_random random = test_random_case("short slacks", number);
    exact_scene scene;
    exact_scene_make(&random, number, &scene);
    pir_polytope *p = test_polytope(&scene.points_p), *q = test_polytope(&scene.points_q);
    pir_pair *pair;
    assert_int_equal(pir_pair_create(p, q, NULL, &pair), PIR_OK);
    pir_pair_input input = pir_pair_input_default();
    for (int pose = 0; pose < WAYS * POSES; pose++) {
        const int way = pose / POSES;
        pir_vec3 d = test_random_direction(&random);
        double far = scene.scale * test_random_between(&random, 0, 3);
        // where P touches a vertex of Q with one of its own, and anywhere
        pir_vec3 at = q->vertex[test_random_below(&random, q->vertex_count)];
        input.pose_p.rotation = exact_rotation(&random, &scene);
        input.pose_p.translation = pose % 2 ? at : (pir_vec3){far * d.x, far * d.y, far * d.z};
        if (way != STANDS) {
            pir_vec3 e = test_random_direction(&random);
            input.pose_q.rotation = way == TURNED ? exact_rotation(&random, &scene) : (pir_quat){0, 0, 0, 1};
            input.pose_q.translation = pose % 3 ? (pir_vec3){far * e.x, far * e.y, far * e.z} : at;
        }
        if (p->facet_count > 0 && q->facet_count > 0 && pir_pair_begin(pair, workspace, &input) == PIR_OK)
            check_pose(&random, workspace, &workspace->placement, number, &count[way]);
    }
    pir_pair_destroy(pair);
    pir_polytope_release(p);
    pir_polytope_release(q);
}

static void slacks_have_the_same_bits(void **state) {
    (void)state;
    pir_workspace *workspace;
    struct count count[WAYS] = {{0, 0}};
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < SCENES; i++)
        run_scene(i, workspace, count);
    pir_workspace_destroy(workspace);
    for (int way = 0; way < WAYS; way++) {
        print_message("%u slacks, %u of them in integers of fixed length\n", count[way].seen, count[way].brief);
#if GMP_NUMB_BITS == 64
        assert_true(count[way].seen > 1000 && 2 * count[way].brief > count[way].seen);
#endif
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(slacks_have_the_same_bits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

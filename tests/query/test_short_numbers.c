/* SPDX-License-Identifier: MIT */
/*
 * Numbers in integers of fixed length are those in integers of any length, to the bit, for facets, vertices and edges
 * of scenes that are aligned, nearly aligned and general, from 1e-150 to 1e150, Q standing, moved, or turned and moved;
 * and where coordinates are doubles of like size they are not refused. So are slacks, normals of two edges, where these
 * cross, and distances from corners and edges of D with their directions.
 */
#include "support/test.h"

#include <string.h>

#include "pair/pair.h"
#include "query/decide/short_numbers.h"
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

/* The normal of two edges by GMP's integers. */
static pir_vec3 long_normal(pir_exact *exact, pir_piece piece) {
    pir_rotation_make_exact(exact->rotation);
    uint32_t mark = exact->scratch.used;
    pir_int3 n = pir_exact_normal(exact, piece);
    pir_vec3 unit = pir_int3_is_zero(&n) ? (pir_vec3){0, 0, 0} : pir_int3_unit(&n);
    exact->scratch.used = mark;
    return unit;
}

/* m·W at the origin of Q's edge over what that is less at its target, m = (d × M e) × M e. */
static double long_part(pir_exact *exact, pir_vec3 translation, uint32_t half_p, uint32_t half_q) {
    const pir_polytope *p = exact->frame->p.polytope, *q = exact->frame->q.polytope;
    pir_exact_begin(exact, translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 n = pir_exact_normal(exact, (pir_piece){PIR_FACET_EE, p->edge[half_p], half_q}),
             e = pir_exact_half_p(exact, half_p), m = pir_exact_cross(exact, &n, &e);
    pir_int3 from = pir_exact_corner(exact, p->origin[half_p], q->origin[half_q]),
             to = pir_exact_corner(exact, p->origin[half_p], q->target[half_q]);
    pir_int first = pir_exact_dot(exact, &m, &from);
    from = pir_exact_difference(exact, &from, &to);
    pir_int whole = pir_exact_dot(exact, &m, &from);
    double part = pir_real_double(pir_real_over(pir_real_of(&first), pir_real_of(&whole)));
    exact->scratch.used = mark;
    return part;
}

/* The distance from a corner or an edge of D, and the direction. */
static double long_distance(pir_exact *exact, pir_vec3 translation, const pir_edge_of_d *edge, pir_vec3 *ret_normal) {
    pir_exact_begin(exact, translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 n = pir_exact_corner(exact, edge->a, edge->b);
    pir_real over = {0.5, 1};
    if (edge->of_p || edge->of_q) {
        pir_int3 e = edge->of_p ? pir_exact_half_p(exact, edge->half) : pir_exact_half_q(exact, edge->half);
        pir_int along = pir_exact_dot(exact, &n, &e), square = pir_exact_square(exact, &e);
        pir_int3 back = pir_exact_scaled(exact, &n, &square), by = pir_exact_scaled(exact, &e, &along);
        n = pir_exact_difference(exact, &back, &by);
        over = pir_real_of(&square);
    }
    for (int k = 0; k < 3; k++)
        pir_int_negate(&n.c[k]);
    pir_real length = pir_exact_length(exact, &n);
    if (edge->of_p || edge->of_q)
        length = pir_real_over(length, over);
    *ret_normal = pir_int3_is_zero(&n) ? (pir_vec3){1, 0, 0} : pir_int3_unit(&n);
    exact->scratch.used = mark;
    return pir_real_double(pir_real_times(length, pir_exact_unit(exact)));
}

/* Counts the numbers that were looked at and those that were short. */
struct count {
    uint32_t seen, brief;
};

static bool have_same_bits(double a, double b) {
    return memcmp(&a, &b, sizeof a) == 0;
}

static bool are_same(pir_vec3 a, pir_vec3 b) {
    return have_same_bits(a.x, b.x) && have_same_bits(a.y, b.y) && have_same_bits(a.z, b.z);
}

/* The normal of two edges, and where they cross. */
static void check_edges(pir_exact *exact, pir_vec3 translation, pir_piece piece, uint64_t scene, struct count *count) {
    pir_vec3 normal, brief;
    double part;
    if (piece.kind != PIR_FACET_EE)
        return;
    normal = long_normal(exact, piece);
    const uint32_t half = exact->frame->p.polytope->edge_half[piece.first];
    count->seen += 2;
    if (pir_short_normal(exact, piece, &brief)) {
        count->brief++;
        expect(are_same(normal, brief), "scene %llu: normal of edges %u, %u", (unsigned long long)scene, piece.first,
               piece.second);
    }
    if (pir_vec_dot(normal, normal) > 0 && pir_short_part(exact, translation, half, piece.second, &part)) {
        const double right = long_part(exact, translation, half, piece.second);
        count->brief++;
        expect(have_same_bits(part, right), "scene %llu: part %.17g is not %.17g", (unsigned long long)scene, part,
               right);
    }
}

/* Distances from a corner and from edges at it. */
static void check_distances(pir_exact *exact, pir_vec3 translation, uint32_t a, uint32_t b, uint64_t scene,
                            struct count *count) {
    const pir_polytope *p = exact->frame->p.polytope, *q = exact->frame->q.polytope;
    const pir_edge_of_d edges[3] = {
        {a, b, false, false, 0}, {a, b, true, false, p->ring_start[a]}, {a, b, false, true, q->ring_start[b]}};
    for (int k = 0; k < 3; k++) {
        pir_vec3 normal, away;
        double distance;
        count->seen++;
        if (!pir_short_distance(exact, translation, &edges[k], &distance, &away))
            continue;
        const double right = long_distance(exact, translation, &edges[k], &normal);
        count->brief++;
        expect(have_same_bits(distance, right) && are_same(away, normal), "scene %llu: distance %.17g is not %.17g",
               (unsigned long long)scene, distance, right);
    }
}

static void check_pose(test_random *random, pir_workspace *workspace, const pir_placement *placement, uint64_t scene,
                       struct count *count) {
    pir_frame *frame = &workspace->frame;
    pir_exact *exact = &workspace->exact;
    for (int k = 0; k < PIECES; k++) {
        pir_facet facet = {.piece = random_piece(random, frame->p.polytope, frame->q.polytope)};
        int sign, side;
        double slack, brief;
        pir_piece_corner(frame, facet.piece, &facet.a, &facet.b);
        check_edges(exact, placement->translation, facet.piece, scene, count);
        check_distances(exact, placement->translation, facet.a, facet.b, scene, count);
        if (!long_slack(exact, placement->translation, &facet, &sign, &slack))
            continue;
        count->seen++;
        if (!pir_short_slack(exact, placement->translation, &facet, &side, &brief))
            continue;
        count->brief++;
        expect(side == sign && have_same_bits(slack, brief), "scene %llu: %.17g is not %.17g",
               (unsigned long long)scene, brief, slack);
    }
}

/* How Q is posed. */
enum { STANDS, MOVED, TURNED, WAYS };

/* `count`: for each way that Q is posed. */
static void run_scene(uint64_t number, pir_workspace *workspace, struct count count[WAYS]) {
    test_random random = test_random_case("short numbers", number);
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

static void numbers_have_the_same_bits(void **state) {
    (void)state;
    pir_workspace *workspace;
    struct count count[WAYS] = {{0, 0}};
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < SCENES; i++)
        run_scene(i, workspace, count);
    pir_workspace_destroy(workspace);
    for (int way = 0; way < WAYS; way++) {
        print_message("%u numbers, %u of them in integers of fixed length\n", count[way].seen, count[way].brief);
#if GMP_NUMB_BITS == 64
        assert_true(count[way].seen > 10000 && 2 * count[way].brief > count[way].seen);
#endif
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_have_the_same_bits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/*
 * Facets of D by doubles alone, and climbs in both bodies of a frame: every version gives the bits of the plain one,
 * for facets that hold the foot of x, for others, and for what is no facet at all.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include "query/frame/body.h"
#include "query/frame/supports.h"
#include "query/last/same_facet.h"
#include "support/bodies.h"

/* A difference in its frame. */
struct scene {
    pir_polytope *p, *q, *reflected;
    pir_frame frame;
};

/* A body with tables of what is around its vertices, or too large or too flat for them. */
static pir_polytope *some_body(test_random *random) {
    static const test_body kinds[5] = {TEST_BOX, TEST_SPHERE, TEST_OCTAHEDRON, TEST_SPHERE, TEST_POLYGON};
    test_points points;
    uint32_t kind = test_random_below(random, 5);
    test_body_points(random, kinds[kind], kind == 3 ? 40 : 20, &points);
    if (test_random_below(random, 2) == 0)
        test_bake(&points, test_general_rotation(random));
    pir_polytope *p = test_polytope(&points);
    if (p->dimension >= 2)
        return p;
    // without facets there is nothing to prove
    pir_polytope_release(p);
    return some_body(random);
}

static void make_scene(test_random *random, struct scene *scene) {
    static pir_rotation_integers integers;
    pir_rotation rotation = {.integers = &integers};
    memset(scene, 0, sizeof *scene);
    scene->p = some_body(random);
    scene->q = some_body(random);
    assert_int_equal(pir_polytope_reflect(scene->p, &scene->reflected), PIR_OK);
    assert_int_equal(pir_frame_set_bodies(&scene->frame, scene->reflected, scene->q), PIR_OK);
    assert_int_equal(pir_rotation_set(&rotation, test_rotation(random)), PIR_OK);
    pir_frame_turn(&scene->frame, &rotation);
}

static void free_scene(struct scene *scene) {
    pir_polytope_release(scene->reflected);
    pir_polytope_release(scene->p);
    pir_polytope_release(scene->q);
}

/* The middle of a facet's corners, in its body's frame. */
static pir_vec3 middle_of(const pir_body *body, uint32_t facet) {
    const pir_polytope *p = body->polytope;
    const uint32_t start = p->loop_start[facet], end = p->loop_start[facet + 1];
    pir_vec3 sum = {0, 0, 0};
    for (uint32_t i = start; i < end; i++)
        sum = pir_vec_add(sum, body->vertex[p->origin[p->loop[i]]]);
    return pir_vec_scale(sum, 1.0 / (end - start));
}

static pir_vec3 half_way(const pir_body *body, uint32_t half) {
    const pir_polytope *p = body->polytope;
    return pir_vec_scale(pir_vec_add(body->vertex[p->origin[half]], body->vertex[p->target[half]]), 0.5);
}

/* A piece that may be a facet of D, a point in it and its normal. */
static pir_piece some_piece(test_random *random, const pir_frame *frame, pir_vec3 *ret_in, pir_vec3 *ret_normal) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    const uint32_t kind = test_random_below(random, 3);
    if (kind == 0) {
        uint32_t f = test_random_below(random, p->facet_count);
        *ret_normal = pir_mat_apply(&frame->r, p->normal[f]);
        uint32_t b = pir_climb(q, *ret_normal, test_random_below(random, q->vertex_count));
        *ret_in = pir_vec_add(pir_mat_apply(&frame->r, middle_of(&frame->p, f)), frame->q.vertex[b]);
        return (pir_piece){PIR_FACET_FV, f, test_random_below(random, 2) ? b : 0};
    }
    if (kind == 1) {
        uint32_t g = test_random_below(random, q->facet_count);
        *ret_normal = q->normal[g];
        pir_vec3 back = pir_mat_apply_transposed(&frame->r, *ret_normal);
        uint32_t a = pir_climb(p, back, test_random_below(random, p->vertex_count));
        *ret_in = pir_vec_add(pir_mat_apply(&frame->r, frame->p.vertex[a]), middle_of(&frame->q, g));
        return (pir_piece){PIR_FACET_VF, test_random_below(random, 2) ? a : 0, g};
    }
    // most edges do not cross: a few tries find some that do
    pir_piece piece = {PIR_FACET_EE, 0, 0};
    for (int tries = 0; tries < 200; tries++) {
        piece.first = test_random_below(random, p->edge_count);
        piece.second = test_random_below(random, q->half_count);
        uint32_t half = p->edge_half[piece.first], a = p->origin[half], b = q->origin[piece.second];
        pir_vec3 n = pir_vec_cross(q->direction[piece.second], pir_mat_apply(&frame->r, p->direction[half]));
        n = pir_vec_scale(n, 1 / sqrt(pir_vec_dot(n, n)));
        pir_vec3 back = pir_mat_apply_transposed(&frame->r, n);
        *ret_normal = n;
        *ret_in = pir_vec_add(pir_mat_apply(&frame->r, half_way(&frame->p, half)), half_way(&frame->q, piece.second));
        // at a corner that is a support along its normal, but for rounding
        if (pir_climb_above(p, back, 0x1p-40, a) == a && pir_climb_above(q, n, 0x1p-40, b) == b)
            break;
    }
    return piece;
}

/* A place of x over the point along the normal, or beside that. */
static pir_placement place(test_random *random, const pir_frame *frame, pir_vec3 in, pir_vec3 normal) {
    pir_placement placement;
    double up = test_random_below(random, 8) == 0 ? 0 : 0.5 * test_random_unit(random);
    pir_vec3 beside = test_random_direction(random);
    double far = test_random_below(random, 2) ? 0.3 * test_random_unit(random) : 0.01;
    memset(&placement, 0, sizeof placement);
    placement.x = pir_vec_add(pir_vec_add(in, pir_vec_scale(normal, up)), pir_vec_scale(beside, far));
    pir_frame_set_reach(frame, 0, &placement);
    return placement;
}

static void check_piece(const struct scene *scene, const pir_placement *placement, pir_piece piece,
                        const pir_same_known *known, uint32_t proven[3]) {
    pir_same_facet plain, same;
    memset(&plain, 0, sizeof plain);
    pir_same is = pir_same_facet_version(0)(&scene->frame, placement, piece, known, &plain);
    proven[piece.kind] += is == PIR_SAME_PROVEN;
    for (unsigned version = 1; pir_same_facet_version(version); version++) {
        memset(&same, 0, sizeof same);
        assert_int_equal(pir_same_facet_version(version)(&scene->frame, placement, piece, known, &same), is);
        if (is == PIR_SAME_PROVEN)
            assert_memory_equal(&same, &plain, sizeof same);
        if (is == PIR_SAME_NEAR)
            assert_true(pir_facet_same(&same.facet, &plain.facet) && same.margin == plain.margin &&
                        same.falls == plain.falls);
    }
}

static void check_supports(test_random *random, const pir_frame *frame) {
    const pir_vec3 n = test_random_direction(random);
    const uint32_t from_a = test_random_below(random, frame->p.polytope->vertex_count);
    const uint32_t from_b = test_random_below(random, frame->q.polytope->vertex_count);
    uint32_t a = from_a, b = from_b;
    pir_vec3 back;
    pir_supports_version(0)(frame, n, &a, &b, &back);
    for (unsigned version = 1; pir_supports_version(version); version++) {
        uint32_t c[2] = {from_a, from_b}, at[2] = {a, b};
        pir_vec3 turned;
        pir_supports_version(version)(frame, n, &c[0], &c[1], &turned);
        assert_true(c[0] == a && c[1] == b && memcmp(&turned, &back, sizeof back) == 0);
        // from where it ends it goes no further
        pir_supports_version(version)(frame, n, &at[0], &at[1], &turned);
        assert_true(at[0] == a && at[1] == b);
    }
}

static void versions_give_the_same_bits(void **state) {
    (void)state;
    uint32_t proven[3] = {0}, cases = 400;
    for (uint64_t i = 0; i < cases; i++) {
        test_random random = test_random_case("same facet", i);
        struct scene scene;
        make_scene(&random, &scene);
        for (int k = 0; k < 40; k++) {
            pir_vec3 in, normal;
            pir_piece piece = some_piece(&random, &scene.frame, &in, &normal);
            pir_placement placement = place(&random, &scene.frame, in, normal);
            const pir_same_known known = {0.25, 0};
            check_piece(&scene, &placement, piece, NULL, proven);
            check_piece(&scene, &placement, piece, &known, proven);
            check_supports(&random, &scene.frame);
        }
        free_scene(&scene);
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

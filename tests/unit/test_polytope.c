/* SPDX-License-Identifier: MIT */
/* What callers see of a polytope: counts, numbering, rounded and exact coordinates, reflection, sharing, bad input. */
#include "support/test.h"

#include <math.h>

#include <pirouette/exact.h>

#include "polytope/polytope.h"
#include "support/bodies.h"
#include "support/memory.h"

static pir_polytope *make_box(double x, double y, double z) {
    pir_vec3 points[8];
    for (int i = 0; i < 8; i++)
        points[i] = (pir_vec3){i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z};
    return test_hull(points, 8);
}

static void vertices_keep_the_order_of_their_points(void **state) {
    (void)state;
    const pir_vec3 points[] = {{0.1, 0.1, 0.1}, {3, 0, 0}, {0, 0, 0}, {0, 0, 3}, {3, 0, 0}, {0, 3, 0}, {1, 0, 0}};
    const uint32_t expected[] = {1, 2, 3, 5};
    pir_polytope *p = test_hull(points, sizeof points / sizeof *points);
    assert_int_equal(pir_polytope_vertex_count(p), 4);
    for (uint32_t v = 0; v < 4; v++) {
        assert_int_equal(pir_polytope_source(p, v), expected[v]);
        pir_vec3 at = pir_polytope_vertex(p, v);
        assert_memory_equal(&at, &points[expected[v]], sizeof at);
    }
    pir_polytope_release(p);
}

static void edges_name_their_smaller_vertex_first_and_each_bounds_two_facets(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 100; i++) {
        test_random random = test_random_case("polytope edges", i);
        pir_polytope *p = test_random_polytope(&random, (test_body)(i % TEST_BODY_COUNT), 20);
        uint32_t ends[2], before[2] = {0, 0};
        for (uint32_t e = 0; e < pir_polytope_edge_count(p); e++) {
            pir_polytope_edge(p, e, ends);
            assert_true(ends[0] < ends[1]);
            if (e > 0)
                assert_true(before[0] < ends[0] || (before[0] == ends[0] && before[1] < ends[1]));
            before[0] = ends[0];
            before[1] = ends[1];
            uint32_t there = 0, back = 0, corner[TEST_POINTS_MAX];
            for (uint32_t f = 0; f < pir_polytope_facet_count(p); f++) {
                uint32_t n = pir_polytope_facet_size(p, f);
                pir_polytope_facet(p, f, corner);
                for (uint32_t k = 0; k < n; k++) {
                    there += corner[k] == ends[0] && corner[(k + 1) % n] == ends[1];
                    back += corner[k] == ends[1] && corner[(k + 1) % n] == ends[0];
                }
            }
            uint32_t expected = pir_polytope_dimension(p) >= 2;
            expect(there == expected && back == expected, "case %llu", (unsigned long long)i);
        }
        pir_polytope_release(p);
    }
}

static void box_has_its_volume_bounds_and_normals(void **state) {
    (void)state;
    pir_polytope *box = make_box(1, 2, 0.25);
    pir_vec3 low, high;
    pir_polytope_bounds(box, &low, &high);
    assert_true(low.x == -1 && low.y == -2 && low.z == -0.25 && high.x == 1 && high.y == 2 && high.z == 0.25);
    assert_true(fabs(pir_polytope_volume(box) - 4) < 1e-14);
    // each normal is a unit vector of an axis, each once, and its facet lies on that side
    unsigned seen = 0;
    for (uint32_t f = 0; f < 6; f++) {
        uint32_t corner[4];
        pir_vec3 n = pir_polytope_normal(box, f);
        pir_polytope_facet(box, f, corner);
        pir_vec3 x = pir_polytope_vertex(box, corner[0]);
        const double c[3] = {n.x, n.y, n.z}, at[3] = {x.x, x.y, x.z};
        for (int k = 0; k < 3; k++)
            if (c[k] != 0) {
                assert_true(fabs(c[k]) == 1 && c[k] * at[k] > 0);
                seen |= 1u << (2 * k + (c[k] > 0));
            }
        assert_true(fabs(c[0]) + fabs(c[1]) + fabs(c[2]) == 1);
    }
    assert_int_equal(seen, 63);
    pir_polytope_release(box);
}

static void reflection_has_the_same_facets_backwards(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 100; i++) {
        test_random random = test_random_case("polytope reflection", i);
        pir_polytope *p = test_random_polytope(&random, (test_body)(i % TEST_BODY_COUNT), 25), *minus, *again;
        assert_int_equal(pir_polytope_reflect(p, &minus), PIR_OK);
        assert_int_equal(pir_polytope_reflect(minus, &again), PIR_OK);
        assert_true(pir_polytope_is_valid(minus));
        assert_int_equal(pir_polytope_vertex_count(p), pir_polytope_vertex_count(minus));
        assert_int_equal(pir_polytope_edge_count(p), pir_polytope_edge_count(minus));
        assert_int_equal(pir_polytope_facet_count(p), pir_polytope_facet_count(minus));
        for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
            pir_vec3 a = pir_polytope_vertex(p, v), b = pir_polytope_vertex(minus, v),
                     c = pir_polytope_vertex(again, v);
            assert_true(a.x == -b.x && a.y == -b.y && a.z == -b.z && a.x == c.x && a.y == c.y && a.z == c.z);
            assert_int_equal(pir_polytope_source(p, v), pir_polytope_source(minus, v));
        }
        pir_polytope_release(again);
        pir_polytope_release(minus);
        pir_polytope_release(p);
    }
}

static void reflection_is_made_once_and_outlives_its_polytope(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    const pir_polytope_options options = {.size = sizeof options, .allocator = &allocator};
    const pir_vec3 points[4] = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {-1, -1, -1}};
    pir_polytope *p = NULL, *minus = NULL, *same = NULL, *again = NULL;
    assert_int_equal(pir_polytope_create(points, 4, &options, &p), PIR_OK);
    // a failed attempt leaves nothing
    memory.fail_at = memory.requests + 1;
    assert_int_equal(pir_polytope_reflect(p, &minus), PIR_ERR_MEMORY);
    memory.fail_at = 0;
    assert_int_equal(pir_polytope_reflect(p, &minus), PIR_OK);
    uint64_t requests = memory.requests;
    assert_int_equal(pir_polytope_reflect(p, &same), PIR_OK);
    assert_ptr_equal(minus, same);
    assert_int_equal(memory.requests, requests);
    pir_polytope_release(same);
    pir_polytope_release(p);
    assert_true(pir_polytope_is_valid(minus));
    assert_int_equal(pir_polytope_reflect(minus, &again), PIR_OK);
    assert_true(pir_polytope_vertex(again, 2).z == 3);
    pir_polytope_release(minus);
    assert_true(pir_polytope_is_valid(again));
    pir_polytope_release(again);
    assert_int_equal(memory.blocks, 0);
    assert_false(memory.wrong_size);
}

/* x, y, z of `count` points as fractions a/b. */
static mpq_t *fractions(const int (*numbers)[2], size_t count) {
    mpq_t *q = test_malloc(3 * count * sizeof *q);
    for (size_t i = 0; i < 3 * count; i++) {
        mpq_init(q[i]);
        mpq_set_si(q[i], numbers[i][0], (unsigned long)numbers[i][1]);
        mpq_canonicalize(q[i]);
    }
    return q;
}

static void free_fractions(mpq_t *q, size_t count) {
    for (size_t i = 0; i < 3 * count; i++)
        mpq_clear(q[i]);
    test_free(q);
}

static void rational_points_are_kept_exactly(void **state) {
    (void)state;
    // a third is no double: in doubles the fifth point would not lie on the plane x + y + z = 1
    const int numbers[][2] = {{1, 1}, {0, 1},  {0, 1},  {0, 1},   {1, 1}, {0, 1}, {0, 1}, {0, 1},
                              {1, 1}, {-2, 7}, {-1, 3}, {-5, 11}, {1, 3}, {1, 3}, {1, 3}};
    mpq_t *q = fractions(numbers, 5);
    pir_polytope *p = NULL;
    assert_int_equal(pir_polytope_create_exact((const mpq_t *)q, 5, NULL, &p), PIR_OK);
    assert_true(pir_polytope_is_valid(p));
    assert_int_equal(pir_polytope_vertex_count(p), 4);
    assert_int_equal(pir_polytope_facet_count(p), 4);
    mpq_t x[3];
    mpq_inits(x[0], x[1], x[2], NULL);
    for (uint32_t v = 0; v < 4; v++) {
        pir_polytope_vertex_exact(p, v, x);
        for (int k = 0; k < 3; k++)
            assert_true(mpq_equal(x[k], q[3 * v + (uint32_t)k]));
    }
    assert_true(pir_polytope_vertex(p, 3).x == -2.0 / 7 && pir_polytope_vertex(p, 3).y == -1.0 / 3 &&
                pir_polytope_vertex(p, 3).z == -5.0 / 11);
    mpq_clears(x[0], x[1], x[2], NULL);
    pir_polytope_release(p);
    free_fractions(q, 5);
}

static void doubles_are_kept_exactly(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 100; i++) {
        test_random random = test_random_case("polytope exact", i);
        pir_vec3 points[4];
        for (int k = 0; k < 4; k++)
            points[k] = (pir_vec3){test_random_scaled(&random, -1074, 1000), test_random_scaled(&random, -1074, 1000),
                                   test_random_scaled(&random, -1074, 1000)};
        pir_polytope *p = test_hull(points, 4);
        mpq_t x[3], expected;
        mpq_inits(x[0], x[1], x[2], expected, NULL);
        for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
            pir_vec3 at = points[pir_polytope_source(p, v)], near = pir_polytope_vertex(p, v);
            const double c[3] = {at.x, at.y, at.z};
            pir_polytope_vertex_exact(p, v, x);
            for (int k = 0; k < 3; k++) {
                mpq_set_d(expected, c[k]);
                assert_true(mpq_equal(x[k], expected));
            }
            assert_true(near.x == at.x && near.y == at.y && near.z == at.z);
        }
        mpq_clears(x[0], x[1], x[2], expected, NULL);
        pir_polytope_release(p);
    }
}

static void last_reference_frees(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    const pir_vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    pir_polytope *p = NULL;
    const pir_polytope_options options = {sizeof options, &allocator, 0};
    assert_int_equal(pir_polytope_create(points, 4, &options, &p), PIR_OK);
    assert_ptr_equal(pir_polytope_retain(p), p);
    pir_polytope_release(p);
    assert_true(memory.blocks > 0 && pir_polytope_is_valid(p));
    pir_polytope_release(p);
    assert_int_equal(memory.blocks, 0);
    assert_int_equal(memory.bytes, 0);
    assert_false(memory.wrong_size);
    pir_polytope_release(NULL);
}

static void check_of_a_polytope_sees_facets_left_unmerged(void **state) {
    (void)state;
    // a pyramid, its square base once whole and once as two triangles
    static const int at[5][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 1}};
    uint32_t whole[] = {0, 3, 2, 1, 0, 1, 4, 1, 2, 4, 2, 3, 4, 0, 4, 3}, whole_start[] = {0, 4, 7, 10, 13, 16};
    uint32_t split[] = {0, 3, 2, 0, 2, 1, 0, 1, 4, 1, 2, 4, 2, 3, 4, 0, 4, 3}, split_start[] = {0, 3, 6, 9, 12, 15, 18};
    const pir_loops loops[] = {{5, whole_start, whole}, {6, split_start, split}};
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    const uint32_t vertices[] = {0, 1, 2, 3, 4};
    pir_vectors points;
    pir_scale scale;
    assert_true(pir_vectors_init(&points, &allocator, 5, 1) && pir_scale_init_power(&scale, &allocator, 0));
    for (uint32_t v = 0; v < 5; v++) {
        pir_int3 x = pir_vectors_at(&points, v);
        for (int k = 0; k < 3; k++)
            pir_int_set_double(&x.c[k], at[v][k], 0);
        pir_vectors_put(&points, v, &x);
    }
    for (int i = 0; i < 2; i++) {
        pir_polytope *p = NULL;
        pir_polytope_parts parts = {.points = &points,
                                    .scale = &scale,
                                    .dimension = 3,
                                    .vertices = vertices,
                                    .vertex_count = 5,
                                    .facets = &loops[i]};
        assert_int_equal(pir_polytope_build(&parts, &allocator, &p), PIR_OK);
        assert_int_equal(pir_polytope_is_valid(p), i == 0);
        pir_polytope_release(p);
    }
    pir_scale_finish(&scale, &allocator);
    pir_vectors_finish(&points, &allocator);
}

static void bad_points_are_refused_and_the_result_is_untouched(void **state) {
    (void)state;
    pir_polytope *const before = (pir_polytope *)&before;
    pir_polytope *p = before;
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    const pir_vec3 point = {1, 2, 3};
    assert_int_equal(pir_polytope_create(&point, 0, NULL, &p), PIR_ERR_EMPTY);
    assert_int_equal(pir_polytope_create(NULL, 0, NULL, &p), PIR_ERR_EMPTY);
    assert_int_equal(pir_polytope_create(NULL, 3, NULL, &p), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_create(&point, 1, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_reflect(NULL, &p), PIR_ERR_ARGUMENT);
    for (int k = 0; k < 9; k++) {
        pir_vec3 points[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        double *c[3] = {&points[2].x, &points[2].y, &points[2].z};
        *c[k % 3] = bad[k / 3];
        assert_int_equal(pir_polytope_create(points, 3, NULL, &p), PIR_ERR_NOT_FINITE);
    }
    assert_int_equal(pir_polytope_create(&point, (size_t)1 << 30, NULL, &p), PIR_ERR_LIMIT);
    assert_int_equal(pir_polytope_create_exact(NULL, 1, NULL, &p), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_create_exact(NULL, 0, NULL, &p), PIR_ERR_EMPTY);
    assert_ptr_equal(p, before);
}

static void every_status_has_words(void **state) {
    (void)state;
    for (int s = PIR_OK; s <= PIR_ERR_INTERNAL + 1; s++) {
        const char *text = pir_status_text((pir_status)s);
        assert_non_null(text);
        assert_true(text[0] != 0);
    }
}

/* Whether the check notices that *at holds another number. */
static int notices(const pir_polytope *p, uint32_t *at, uint32_t other) {
    uint32_t kept = *at;
    *at = other;
    int noticed = !pir_polytope_is_valid(p);
    *at = kept;
    return noticed;
}

/* Gives halfedge a the number b and the reverse, in all that names them. */
static void exchange_numbers(pir_polytope *p, uint32_t a, uint32_t b) {
    uint32_t *of_halves[] = {p->target, p->left, p->edge, p->twin};
    for (int k = 0; k < 4; k++) {
        uint32_t kept = of_halves[k][a];
        of_halves[k][a] = of_halves[k][b];
        of_halves[k][b] = kept;
    }
    p->twin[p->twin[a]] = a;
    p->twin[p->twin[b]] = b;
    for (uint32_t i = 0; i < p->half_count; i++)
        p->loop[i] = p->loop[i] == a ? b : p->loop[i] == b ? a : p->loop[i];
    for (uint32_t e = 0; e < p->edge_count; e++)
        p->edge_half[e] = p->edge_half[e] == a ? b : p->edge_half[e] == b ? a : p->edge_half[e];
}

static void check_of_a_polytope_sees_a_ring_out_of_order(void **state) {
    (void)state;
    test_random random = test_random_case("rings out of order", 0);
    pir_polytope *p = test_sphere(&random, 30);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        uint32_t h = p->ring_start[v];
        exchange_numbers(p, h, h + 1);
        assert_false(pir_polytope_is_valid(p));
        exchange_numbers(p, h, h + 1);
        assert_true(pir_polytope_is_valid(p));
    }
    pir_polytope_release(p);
}

static void check_of_a_polytope_sees_every_kind_of_damage(void **state) {
    (void)state;
    test_random random = test_random_case("polytope damage", 0);
    pir_polytope *p = test_sphere(&random, 30);
    assert_true(pir_polytope_is_valid(p));
    for (uint32_t h = 0; h < p->half_count; h += 7) {
        assert_true(notices(p, &p->twin[h], h));
        assert_true(notices(p, &p->twin[h], UINT32_MAX));
        assert_true(notices(p, &p->origin[h], p->target[h]));
        assert_true(notices(p, &p->edge_half[p->edge[h]], p->twin[p->edge_half[p->edge[h]]]));
        assert_true(notices(p, &p->edge_half[p->edge[h]], p->edge_half[(p->edge[h] + 1) % p->edge_count]));
        assert_true(notices(p, &p->target[h], p->origin[h]));
        assert_true(notices(p, &p->left[h], (p->left[h] + 1) % p->facet_count));
        assert_true(notices(p, &p->edge[h], (p->edge[h] + 1) % p->edge_count));
        assert_true(notices(p, &p->loop[h], (p->loop[h] + 1) % p->half_count));
    }
    // an edge or a normal that points elsewhere
    p->exact_edge.size[0] = -p->exact_edge.size[0];
    assert_false(pir_polytope_is_valid(p));
    p->exact_edge.size[0] = -p->exact_edge.size[0];
    p->exact_normal.size[4] = -p->exact_normal.size[4];
    assert_false(pir_polytope_is_valid(p));
    p->exact_normal.size[4] = -p->exact_normal.size[4];
    assert_true(pir_polytope_is_valid(p));
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertices_keep_the_order_of_their_points),
        cmocka_unit_test(edges_name_their_smaller_vertex_first_and_each_bounds_two_facets),
        cmocka_unit_test(box_has_its_volume_bounds_and_normals),
        cmocka_unit_test(reflection_has_the_same_facets_backwards),
        cmocka_unit_test(reflection_is_made_once_and_outlives_its_polytope),
        cmocka_unit_test(rational_points_are_kept_exactly),
        cmocka_unit_test(doubles_are_kept_exactly),
        cmocka_unit_test(last_reference_frees),
        cmocka_unit_test(bad_points_are_refused_and_the_result_is_untouched),
        cmocka_unit_test(check_of_a_polytope_sees_every_kind_of_damage),
        cmocka_unit_test(check_of_a_polytope_sees_a_ring_out_of_order),
        cmocka_unit_test(check_of_a_polytope_sees_facets_left_unmerged),
        cmocka_unit_test(every_status_has_words),
    };
    return cmocka_run_group_tests_name("polytope", tests, NULL, NULL);
}

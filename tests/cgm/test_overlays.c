/* SPDX-License-Identifier: MIT */
/*
 * Sums made three ways, over random pairs and poses of which more than half are degenerate: by walking the Gaussian
 * maps, by overlaying the cubical ones, as the hull of all pairwise sums. Pairings and meshes must be equal bit for
 * bit, and every map valid.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/baseline.h>
#include <pirouette/cgm.h>
#include <pirouette/exact.h>
#include <pirouette/sum.h>

#include "support/bodies.h"

#define CASES 2000

struct ways {
    pir_polytope *p, *q;
    pir_quat rotation;
    pir_sum *walked, *overlaid;
    pir_cgm *of_p, *of_q, *of_sum;
    pir_mesh *by_walk, *by_cgm, *by_hull;
};

static struct ways make_ways(const test_pose *pose, int difference) {
    struct ways w = {.p = test_polytope(&pose->p), .q = test_polytope(&pose->q), .rotation = pose->rotation};
    if (difference) {
        pir_polytope *reflected = NULL;
        assert_int_equal(pir_polytope_reflect(w.p, &reflected), PIR_OK);
        pir_polytope_release(w.p);
        w.p = reflected;
    }
    assert_int_equal(pir_sum_create(w.p, w.q, w.rotation, NULL, &w.walked), PIR_OK);
    // made elsewhere, so that the rebuild has something to replace
    assert_int_equal(pir_sum_create(w.p, w.q, (pir_quat){0.1, -0.7, 0.3, 0.5}, NULL, &w.overlaid), PIR_OK);
    assert_int_equal(pir_sum_rotate(w.overlaid, w.rotation, PIR_METHOD_CGM), PIR_OK);
    assert_int_equal(pir_cgm_create(w.p, &w.rotation, NULL, &w.of_p), PIR_OK);
    assert_int_equal(pir_cgm_create(w.q, NULL, NULL, &w.of_q), PIR_OK);
    assert_int_equal(pir_cgm_overlay(w.of_p, w.of_q, &w.of_sum), PIR_OK);
    assert_int_equal(pir_cgm_mesh(w.of_sum, PIR_EXACT, &w.by_cgm), PIR_OK);
    assert_int_equal(pir_sum_mesh(w.walked, PIR_EXACT, &w.by_walk), PIR_OK);
    assert_int_equal(pir_hull_sum(w.p, w.q, w.rotation, NULL, PIR_EXACT, &w.by_hull), PIR_OK);
    return w;
}

static void release_ways(struct ways *w) {
    pir_mesh_destroy(w->by_hull);
    pir_mesh_destroy(w->by_walk);
    pir_mesh_destroy(w->by_cgm);
    pir_cgm_release(w->of_sum);
    pir_cgm_release(w->of_q);
    pir_cgm_release(w->of_p);
    pir_sum_destroy(w->overlaid);
    pir_sum_destroy(w->walked);
    pir_polytope_release(w->q);
    pir_polytope_release(w->p);
}

/* Whether two meshes hold the same exact coordinates and kinds of facets. */
static int same_details(const pir_mesh *a, const pir_mesh *b) {
    int same = pir_mesh_edge_count(a) == pir_mesh_edge_count(b);
    mpq_t x[3], y[3];
    for (int k = 0; k < 3; k++)
        mpq_inits(x[k], y[k], NULL);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(a) && same; v++) {
        same = pir_mesh_vertex_exact(a, v, x) == PIR_OK && pir_mesh_vertex_exact(b, v, y) == PIR_OK;
        for (int k = 0; k < 3; k++)
            same = same && mpq_equal(x[k], y[k]);
    }
    for (uint32_t f = 0; f < pir_mesh_facet_count(a); f++)
        same = same && pir_mesh_facet_kind(a, f) == pir_mesh_facet_kind(b, f);
    for (int k = 0; k < 3; k++)
        mpq_clears(x[k], y[k], NULL);
    return same;
}

/* Whether a normal or arc of P touches one of Q other than by crossing it. */
static int has_tie(const pir_cgm *cgm) {
    pir_cgm_counts total = pir_cgm_total_counts(cgm);
    for (uint32_t h = 0; h < total.halfedges; h++) {
        uint32_t origin = pir_cgm_halfedge_at(cgm, h).origin;
        int of_p = pir_cgm_halfedge_edge(cgm, h, 0) != PIR_CGM_NONE,
            of_q = pir_cgm_halfedge_edge(cgm, h, 1) != PIR_CGM_NONE;
        if ((of_p && (of_q || pir_cgm_vertex_facet(cgm, origin, 1) != PIR_CGM_NONE)) ||
            (of_q && pir_cgm_vertex_facet(cgm, origin, 0) != PIR_CGM_NONE))
            return 1;
    }
    return 0;
}

/* A pose whose bodies and rotation, four times of five, are of a kind that ties. */
static void make_pose(test_random *random, test_pose *pose) {
    static const test_body tying[] = {TEST_GRID, TEST_BOX, TEST_OCTAHEDRON, TEST_PRISM, TEST_POLYGON};
    size_t most = 4 + test_random_below(random, 12);
    test_random_pose(random, most, pose);
    if (test_random_below(random, 5) == 0)
        return;
    pose->situation = "bodies of the grid, turned within it";
    test_body_points(random, tying[test_random_below(random, 5)], most, &pose->p);
    if (test_random_below(random, 4) == 0)
        pose->q = pose->p;
    else
        test_body_points(random, tying[test_random_below(random, 5)], most, &pose->q);
    static const pir_quat turns[] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0, 1},
                                     {1, 1, 1, 1}, {0, 1, 0, 0}, {1, 1, 0, 0}};
    pose->rotation = turns[test_random_below(random, 6)];
}

static void three_ways_give_the_same_sum(void **state) {
    (void)state;
    uint64_t ties = 0;
    for (uint64_t i = 0; i < CASES; i++) {
        test_random random = test_random_case("cgm", i);
        test_pose pose;
        make_pose(&random, &pose);
        struct ways w = make_ways(&pose, (int)test_random_below(&random, 2));
        const char *where = pose.situation;
        expect(pir_sum_same_pairing(w.walked, w.overlaid), "case %llu, %s: pairing", (unsigned long long)i, where);
        expect(pir_sum_is_valid(w.overlaid), "case %llu, %s: validity", (unsigned long long)i, where);
        expect(pir_mesh_equal(w.by_cgm, w.by_walk), "case %llu, %s: walk", (unsigned long long)i, where);
        expect(pir_mesh_equal(w.by_cgm, w.by_hull), "case %llu, %s: hull", (unsigned long long)i, where);
        expect(same_details(w.by_cgm, w.by_walk), "case %llu, %s: details", (unsigned long long)i, where);
        expect(pir_cgm_is_valid(w.of_p) && pir_cgm_is_valid(w.of_q) && pir_cgm_is_valid(w.of_sum),
               "case %llu, %s: maps", (unsigned long long)i, where);
        ties += (uint64_t)has_tie(w.of_sum);
        release_ways(&w);
    }
    print_message("# %llu of %d poses were degenerate\n", (unsigned long long)ties, CASES);
    expect(2 * ties >= CASES, "%llu of %d poses were degenerate", (unsigned long long)ties, CASES);
}

/* A sum of three, by overlaying overlays either way round, and by taking the sum of two as a polytope of its own. */
static void overlays_can_be_overlaid(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 200; i++) {
        test_random random = test_random_case("cgm of three", i);
        test_pose pose, other;
        test_random_pose(&random, 8, &pose);
        test_random_pose(&random, 8, &other);
        struct ways w = make_ways(&pose, 0);
        pir_polytope *third = test_polytope(&other.q);
        pir_cgm *of_third, *left, *right_part, *right;
        assert_int_equal(pir_cgm_create(third, &other.rotation, NULL, &of_third), PIR_OK);
        assert_int_equal(pir_cgm_overlay(w.of_sum, of_third, &left), PIR_OK);
        assert_int_equal(pir_cgm_overlay(w.of_q, of_third, &right_part), PIR_OK);
        assert_int_equal(pir_cgm_overlay(w.of_p, right_part, &right), PIR_OK);
        expect(pir_cgm_is_valid(left) && pir_cgm_is_valid(right), "case %llu", (unsigned long long)i);
        pir_mesh *of_left, *of_right;
        assert_int_equal(pir_cgm_mesh(left, PIR_EXACT, &of_left), PIR_OK);
        assert_int_equal(pir_cgm_mesh(right, PIR_EXACT, &of_right), PIR_OK);
        expect(pir_mesh_equal(of_left, of_right) && same_details(of_left, of_right), "case %llu",
               (unsigned long long)i);

        // the first two as one polytope
        uint32_t n = pir_mesh_vertex_count(w.by_cgm);
        mpq_t *points = malloc(3 * n * sizeof *points);
        for (uint32_t k = 0; k < 3 * n; k++)
            mpq_init(points[k]);
        for (uint32_t v = 0; v < n; v++)
            assert_int_equal(pir_mesh_vertex_exact(w.by_cgm, v, points + 3 * v), PIR_OK);
        pir_polytope *two = NULL;
        assert_int_equal(pir_polytope_create_exact((const mpq_t *)points, n, NULL, &two), PIR_OK);
        pir_cgm *of_two, *of_all;
        pir_mesh *of_hull;
        assert_int_equal(pir_cgm_create(two, NULL, NULL, &of_two), PIR_OK);
        assert_int_equal(pir_cgm_overlay(of_two, of_third, &of_all), PIR_OK);
        assert_int_equal(pir_cgm_mesh(of_all, PIR_EXACT, &of_hull), PIR_OK);
        expect(pir_mesh_vertex_count(of_hull) == pir_mesh_vertex_count(of_left) &&
                   pir_mesh_edge_count(of_hull) == pir_mesh_edge_count(of_left) &&
                   pir_mesh_facet_count(of_hull) == pir_mesh_facet_count(of_left),
               "case %llu: %u vertices, not %u", (unsigned long long)i, pir_mesh_vertex_count(of_left),
               pir_mesh_vertex_count(of_hull));
        // the map of a sum does not depend on how it came about
        for (uint32_t map = 0; map < 6; map++) {
            pir_cgm_counts a = pir_cgm_map_counts(of_all, map), b = pir_cgm_map_counts(left, map);
            expect(a.vertices == b.vertices && a.halfedges == b.halfedges && a.faces == b.faces, "case %llu, map %u",
                   (unsigned long long)i, map);
        }
        for (uint32_t k = 0; k < 3 * n; k++)
            mpq_clear(points[k]);
        free(points);
        pir_mesh_destroy(of_hull);
        pir_cgm_release(of_all);
        pir_cgm_release(of_two);
        pir_polytope_release(two);
        pir_mesh_destroy(of_right);
        pir_mesh_destroy(of_left);
        pir_cgm_release(right);
        pir_cgm_release(right_part);
        pir_cgm_release(left);
        pir_cgm_release(of_third);
        pir_polytope_release(third);
        release_ways(&w);
    }
}

/* The mesh of one polytope's map is the polytope's. */
static void there_and_back_is_the_same_polytope(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 500; i++) {
        test_random random = test_random_case("cgm there and back", i);
        test_pose pose;
        test_random_pose(&random, 20, &pose);
        pir_polytope *p = test_polytope(&pose.p);
        pir_cgm *cgm;
        pir_mesh *mesh, *own;
        assert_int_equal(pir_cgm_create(p, NULL, NULL, &cgm), PIR_OK);
        assert_int_equal(pir_cgm_mesh(cgm, PIR_EXACT, &mesh), PIR_OK);
        assert_int_equal(pir_mesh_from_polytope(p, &own), PIR_OK);
        expect(pir_mesh_equal(mesh, own) && same_details(mesh, own), "case %llu, %s", (unsigned long long)i,
               pose.situation);
        pir_mesh_destroy(own);
        pir_mesh_destroy(mesh);
        pir_cgm_release(cgm);
        pir_polytope_release(p);
    }
}

/* Every vertex's plane, real or artificial, has the whole sum on one side and touches it; facets have three
   corners on theirs at least. */
static void planes_support_the_sum(void **state) {
    (void)state;
    mpq_t plane[4], x[3], height, part;
    mpq_inits(plane[0], plane[1], plane[2], plane[3], x[0], x[1], x[2], height, part, NULL);
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("cgm planes", i);
        test_pose pose;
        make_pose(&random, &pose);
        struct ways w = make_ways(&pose, 0);
        for (uint32_t v = 0; v < pir_cgm_total_counts(w.of_sum).vertices; v++) {
            assert_int_equal(pir_cgm_vertex_plane_exact(w.of_sum, v, plane), PIR_OK);
            uint32_t touching = 0;
            for (uint32_t k = 0; k < pir_mesh_vertex_count(w.by_walk); k++) {
                assert_int_equal(pir_mesh_vertex_exact(w.by_walk, k, x), PIR_OK);
                mpq_neg(height, plane[3]);
                for (int c = 0; c < 3; c++) {
                    mpq_mul(part, plane[c], x[c]);
                    mpq_add(height, height, part);
                }
                expect(mpq_sgn(height) <= 0, "case %llu, %s: vertex %u", (unsigned long long)i, pose.situation, v);
                touching += mpq_sgn(height) == 0;
            }
            pir_vec3 normal;
            double offset;
            pir_cgm_vertex_plane(w.of_sum, v, &normal, &offset);
            expect(touching > 0 && (touching >= 3) == pir_cgm_vertex_at(w.of_sum, v).real, "case %llu: vertex %u",
                   (unsigned long long)i, v);
            // the rounded plane is the exact one's
            double scale = sqrt(mpq_get_d(plane[0]) * mpq_get_d(plane[0]) + mpq_get_d(plane[1]) * mpq_get_d(plane[1]) +
                                mpq_get_d(plane[2]) * mpq_get_d(plane[2]));
            double size = 0;
            for (uint32_t k = 0; k < pir_mesh_vertex_count(w.by_walk); k++) {
                pir_vec3 y = pir_mesh_vertices(w.by_walk)[k];
                size = fmax(size, fmax(fabs(y.x), fmax(fabs(y.y), fabs(y.z))));
            }
            if (isfinite(scale) && scale > 1e-200 && size < 1e100)
                expect(fabs(offset - mpq_get_d(plane[3]) / scale) <= 1e-9 * (size + fabs(offset)),
                       "case %llu: vertex %u", (unsigned long long)i, v);
        }
        release_ways(&w);
    }
    mpq_clears(plane[0], plane[1], plane[2], plane[3], x[0], x[1], x[2], height, part, NULL);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_ways_give_the_same_sum),
        cmocka_unit_test(overlays_can_be_overlaid),
        cmocka_unit_test(there_and_back_is_the_same_polytope),
        cmocka_unit_test(planes_support_the_sum),
    };
    return cmocka_run_group_tests_name("cgm overlays", tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/*
 * Sections of meshes, beside an oracle that knows no facets: the hull of all points where the plane cuts the segment of
 * two vertices, in rationals. Planes go through vertices, edges and facets more often than not.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/section.h>
#include <pirouette/sum.h>

#include "support/bodies.h"
#include "support/memory.h"

/* --- the oracle --- */

/* Points of a plane, each with all three coordinates, and room for them. */
struct cloud {
    size_t count, room;
    mpq_t (*at)[3];
};

/* The plane normal·x = offset. */
struct plane {
    mpq_t normal[3], offset;
};

static void plane_init(struct plane *plane, pir_vec3 normal, double offset) {
    const double n[3] = {normal.x, normal.y, normal.z};
    for (int k = 0; k < 3; k++) {
        mpq_init(plane->normal[k]);
        mpq_set_d(plane->normal[k], n[k]);
    }
    mpq_init(plane->offset);
    mpq_set_d(plane->offset, offset);
}

static void plane_clear(struct plane *plane) {
    mpq_clears(plane->normal[0], plane->normal[1], plane->normal[2], plane->offset, NULL);
}

static void cloud_init(struct cloud *cloud, size_t room) {
    *cloud = (struct cloud){0, room, malloc(room * sizeof *cloud->at)};
    for (size_t i = 0; i < room; i++)
        mpq_inits(cloud->at[i][0], cloud->at[i][1], cloud->at[i][2], NULL);
}

static void cloud_clear(struct cloud *cloud) {
    for (size_t i = 0; i < cloud->room; i++)
        mpq_clears(cloud->at[i][0], cloud->at[i][1], cloud->at[i][2], NULL);
    free(cloud->at);
}

/* h = normal·x − offset. */
static void height(mpq_t h, const struct plane *plane, mpq_t x[3]) {
    mpq_t part;
    mpq_init(part);
    mpq_neg(h, plane->offset);
    for (int k = 0; k < 3; k++) {
        mpq_mul(part, plane->normal[k], x[k]);
        mpq_add(h, h, part);
    }
    mpq_clear(part);
}

/* All vertices in the plane, and where it cuts the segments from vertices above it to vertices below. */
static void cut_all_pairs(struct cloud *cloud, const struct plane *plane, const pir_mesh *mesh) {
    uint32_t count = pir_mesh_vertex_count(mesh);
    struct cloud vertex;
    mpq_t *h = malloc(count * sizeof *h), t, part;
    mpq_inits(t, part, NULL);
    cloud_init(&vertex, count);
    cloud_init(cloud, count + (size_t)count * count / 4);
    for (uint32_t v = 0; v < count; v++) {
        pir_mesh_vertex_exact(mesh, v, vertex.at[v]);
        mpq_init(h[v]);
        height(h[v], plane, vertex.at[v]);
        for (int k = 0; mpq_sgn(h[v]) == 0 && k < 3; k++)
            mpq_set(cloud->at[cloud->count][k], vertex.at[v][k]);
        cloud->count += mpq_sgn(h[v]) == 0;
    }
    for (uint32_t a = 0; a < count; a++)
        for (uint32_t b = 0; b < count; b++) {
            if (mpq_sgn(h[a]) <= 0 || mpq_sgn(h[b]) >= 0)
                continue;
            // a + t·(b − a) with t = h_a / (h_a − h_b)
            mpq_sub(t, h[a], h[b]);
            mpq_div(t, h[a], t);
            for (int k = 0; k < 3; k++) {
                mpq_sub(part, vertex.at[b][k], vertex.at[a][k]);
                mpq_mul(part, part, t);
                mpq_add(cloud->at[cloud->count][k], vertex.at[a][k], part);
            }
            cloud->count++;
        }
    for (uint32_t v = 0; v < count; v++)
        mpq_clear(h[v]);
    free(h);
    cloud_clear(&vertex);
    mpq_clears(t, part, NULL);
}

static int compare_points(const void *a, const void *b) {
    mpq_t *x = *(mpq_t(*)[3])a, *y = *(mpq_t(*)[3])b;
    for (int k = 0; k < 3; k++)
        if (mpq_cmp(x[k], y[k]) != 0)
            return mpq_cmp(x[k], y[k]);
    return 0;
}

/* The sign of normal·((b − a) × (c − a)). */
static int turn(const struct plane *plane, mpq_t a[3], mpq_t b[3], mpq_t c[3]) {
    mpq_t sum, u, v;
    mpq_inits(sum, u, v, NULL);
    for (int k = 0; k < 3; k++)
        for (int way = 0; way < 2; way++) {
            int i = (k + 1 + way) % 3, j = (k + 2 - way) % 3;
            mpq_sub(u, b[i], a[i]);
            mpq_sub(v, c[j], a[j]);
            mpq_mul(u, u, v);
            mpq_mul(u, u, plane->normal[k]);
            if (way)
                mpq_neg(u, u);
            mpq_add(sum, sum, u);
        }
    int sign = mpq_sgn(sum);
    mpq_clears(sum, u, v, NULL);
    return sign;
}

/* The strict hull of the points, counter-clockwise about the normal: Andrew's chains. The number of its corners. */
static size_t hull(const struct plane *plane, struct cloud *cloud, size_t *corner) {
    qsort(cloud->at, cloud->count, sizeof *cloud->at, compare_points);
    size_t count = 0;
    for (size_t i = 0; i < cloud->count; i++)
        if (i == 0 || compare_points(&cloud->at[i], &cloud->at[i - 1]) != 0)
            corner[count++] = i;
    if (count < 3)
        return count;
    size_t *sorted = malloc(count * sizeof *sorted), top = 0;
    memcpy(sorted, corner, count * sizeof *sorted);
    for (int back = 0; back < 2; back++) {
        size_t least = top + 1;
        for (size_t n = 0; n < count; n++) {
            size_t i = sorted[back ? count - 1 - n : n];
            while (top > least &&
                   turn(plane, cloud->at[corner[top - 2]], cloud->at[corner[top - 1]], cloud->at[i]) <= 0)
                top--;
            corner[top++] = i;
        }
        top--; // the last begins the other chain
    }
    free(sorted);
    return top;
}

/* --- one section --- */

/* Holds the section against the oracle's; the number of its corners. */
static uint32_t check_section(const pir_mesh *mesh, pir_vec3 normal, double offset, const char *what, uint64_t number) {
    pir_section *section = NULL;
    struct plane plane;
    struct cloud cloud;
    mpq_t own[3];
    assert_int_equal(pir_mesh_section(mesh, normal, offset, &section), PIR_OK);
    plane_init(&plane, normal, offset);
    mpq_inits(own[0], own[1], own[2], NULL);
    cut_all_pairs(&cloud, &plane, mesh);
    size_t *corner = malloc((2 * cloud.count + 2) * sizeof *corner), count = hull(&plane, &cloud, corner), at = 0;
    expect(count == pir_section_corner_count(section), "%s, case %llu: %u corners, the oracle's has %zu", what,
           (unsigned long long)number, pir_section_corner_count(section), count);
    uint32_t last[2] = {0, 0};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t edge[2];
        pir_section_edge(section, i, edge);
        assert_int_equal(pir_section_corner_exact(section, mesh, i, own), PIR_OK);
        while (i == 0 && at < count && compare_points(&own, &cloud.at[corner[at]]) != 0)
            at++;
        expect(at < count && compare_points(&own, &cloud.at[corner[(at + i) % count]]) == 0, "%s, case %llu, corner %u",
               what, (unsigned long long)number, i);
        // the edge says where the corner is, and the first edge is the smallest
        expect(edge[0] <= edge[1] && (i == 0 || memcmp(edge, last, sizeof edge) != 0), "%s, case %llu", what,
               (unsigned long long)number);
        uint32_t first[2];
        pir_section_edge(section, 0, first);
        expect(first[0] < edge[0] || (first[0] == edge[0] && first[1] <= edge[1]), "%s, case %llu", what,
               (unsigned long long)number);
        memcpy(last, edge, sizeof last);
        const pir_vec3 double_corner = pir_section_corners(section)[i];
        const double d[3] = {double_corner.x, double_corner.y, double_corner.z};
        for (int k = 0; k < 3; k++) {
            double down = mpq_get_d(own[k]); // towards zero
            expect(d[k] == down || d[k] == nextafter(down, mpq_sgn(own[k]) < 0 ? -HUGE_VAL : HUGE_VAL),
                   "%s, case %llu: %a %a", what, (unsigned long long)number, d[k], down);
        }
    }
    free(corner);
    cloud_clear(&cloud);
    plane_clear(&plane);
    mpq_clears(own[0], own[1], own[2], NULL);
    pir_section_destroy(section);
    return (uint32_t)count;
}

static pir_mesh *mesh_of(const test_pose *pose, int difference) {
    pir_polytope *p = test_polytope(&pose->p), *q = test_polytope(&pose->q);
    pir_sum_options options = pir_sum_options_default();
    options.difference = difference;
    pir_sum *sum = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_sum_create(p, q, pose->rotation, &options, &sum), PIR_OK);
    assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return mesh;
}

/* --- the tests --- */

static void sections_of_sums_are_the_hulls_of_what_the_plane_cuts(void **state) {
    (void)state;
    uint32_t kinds[4] = {0, 0, 0, 0};
    for (uint64_t i = 0; i < 240; i++) {
        test_random random = test_random_case("sections", i);
        test_pose pose;
        test_random_pose(&random, 8, &pose);
        pir_mesh *mesh = mesh_of(&pose, i % 2);
        for (int n = 0; n < 3; n++) {
            // through a vertex where its coordinates are doubles; along an axis, along the grid or any way
            pir_vec3 normal = {test_random_between(&random, -1, 1), test_random_between(&random, -1, 1),
                               test_random_between(&random, -2, 2)};
            if (n == 0 || (normal.x == 0 && normal.y == 0 && normal.z == 0))
                normal = (pir_vec3){i % 3 == 0, i % 3 == 1, i % 3 == 2};
            else if (n == 2 && i % 2)
                normal = test_random_direction(&random);
            pir_vec3 x = pir_mesh_vertices(mesh)[test_random_below(&random, pir_mesh_vertex_count(mesh))];
            double offset = normal.x * x.x + normal.y * x.y + normal.z * x.z;
            if (i % 5 == 4)
                offset += test_random_unit(&random);
            uint32_t count = check_section(mesh, normal, offset, pose.situation, i);
            kinds[count > 3 ? 3 : count]++;
        }
        pir_mesh_destroy(mesh);
    }
    for (int kind = 0; kind < 4; kind++)
        expect(kinds[kind] >= 2, "sections of %d corners: %u", kind, kinds[kind]);
}

/* The mesh of a box from (−1, −1, −1) to (1, 1, 1) whose sides in z and y may be left out. */
static pir_mesh *box_mesh(int dimension) {
    test_points points = {0, {{0, 0, 0}}};
    for (int i = 0; i < 1 << dimension; i++)
        points.at[points.count++] = (pir_vec3){i & 1 ? 1 : -1,
                                               dimension < 2 ? 0
                                               : i & 2       ? 1
                                                             : -1,
                                               dimension < 3 ? 0
                                               : i & 4       ? 1
                                                             : -1};
    pir_polytope *polytope = test_polytope(&points);
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_mesh_from_polytope(polytope, &mesh), PIR_OK);
    pir_polytope_release(polytope);
    return mesh;
}

static void planes_through_vertices_edges_and_facets_of_boxes(void **state) {
    (void)state;
    const struct {
        int dimension;
        pir_vec3 normal;
        double offset;
        uint32_t corners;
    } cases[] = {
        {3, {0, 0, 1}, 0, 4},   {3, {0, 0, 1}, 1, 4},    {3, {0, 0, 1}, -1, 4},          {3, {0, 0, -1}, 1, 4},
        {3, {0, 0, 1}, 1.5, 0}, {3, {1, 1, 0}, 0, 4},    {3, {1, 1, 0}, 2, 2},           {3, {1, 1, 0}, -2, 2},
        {3, {1, 1, 1}, 0, 6},   {3, {1, 1, 1}, 3, 1},    {3, {1, 1, 1}, -3, 1},          {3, {1, 1, 1}, 1, 3},
        {3, {1, 1, 1}, -1, 3},  {3, {1, 1, 2}, 0, 4},    {3, {0, 0, 1e-310}, 1e-310, 4}, {3, {1e300, 0, 0}, 1e300, 4},
        {2, {0, 0, 1}, 0, 4},   {2, {0, 0, -2}, 0, 4},   {2, {0, 0, 1}, 0.5, 0},         {2, {1, 1, 0}, 0, 2},
        {2, {1, 1, 0}, 2, 1},   {2, {1, 0, 0}, 1, 2},    {2, {1, 0, 5}, 0.5, 2},         {1, {1, 0, 0}, 0, 1},
        {1, {1, 0, 0}, 1, 1},   {1, {1, 0, 0}, -1.5, 0}, {1, {0, 1, 0}, 0, 2},           {1, {0, 1, 0}, 1, 0},
        {0, {0, 1, 0}, 0, 1},   {0, {1, 1, 0}, -1, 1},   {0, {1, 0, 0}, 1, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pir_mesh *mesh = box_mesh(cases[i].dimension);
        uint32_t count = check_section(mesh, cases[i].normal, cases[i].offset, "box", i);
        expect(count == cases[i].corners, "case %zu: %u corners", i, count);
        pir_mesh_destroy(mesh);
    }
}

static void what_is_no_plane_is_refused(void **state) {
    (void)state;
    pir_mesh *mesh = box_mesh(3);
    pir_section *section = (pir_section *)&mesh, *const before = section;
    const pir_vec3 up = {0, 0, 1};
    assert_int_equal(pir_mesh_section(mesh, (pir_vec3){0, 0, 0}, 1, &section), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mesh_section(mesh, (pir_vec3){0, NAN, 1}, 1, &section), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_mesh_section(mesh, up, HUGE_VAL, &section), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_mesh_section(NULL, up, 1, &section), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mesh_section(mesh, up, 1, NULL), PIR_ERR_ARGUMENT);
    assert_ptr_equal(section, before);
    // a mesh without exact coordinates
    test_random random = test_random_case("sections", 0);
    pir_polytope *p = test_sphere(&random, 8);
    pir_sum *sum = NULL;
    pir_mesh *plain = NULL;
    assert_int_equal(pir_sum_create(p, p, (pir_quat){0, 0, 1, 2}, NULL, &sum), PIR_OK);
    assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &plain), PIR_OK);
    assert_int_equal(pir_mesh_section(plain, up, 0, &section), PIR_ERR_ARGUMENT);
    assert_ptr_equal(section, before);
    mpq_t c[3];
    mpq_inits(c[0], c[1], c[2], NULL);
    assert_int_equal(pir_mesh_section(mesh, up, 0, &section), PIR_OK);
    assert_int_equal(pir_section_corner_exact(section, mesh, 4, c), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_section_corner_exact(section, plain, 0, c), PIR_ERR_ARGUMENT);
    mpq_clears(c[0], c[1], c[2], NULL);
    pir_section_destroy(section);
    pir_section_destroy(NULL);
    pir_mesh_destroy(plain);
    pir_mesh_destroy(mesh);
    pir_sum_destroy(sum);
    pir_polytope_release(p);
}

static void memory_that_runs_out_leaves_nothing(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    const pir_polytope_options options = {sizeof options, &allocator, 0};
    test_random random = test_random_case("sections", 1);
    test_points points;
    test_body_points(&random, TEST_SPHERE, 12, &points);
    pir_polytope *polytope = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_polytope_create(points.at, points.count, &options, &polytope), PIR_OK);
    assert_int_equal(pir_mesh_from_polytope(polytope, &mesh), PIR_OK);
    size_t blocks = memory.blocks;
    uint32_t failures = 0;
    for (uint64_t n = 1;; n++) {
        pir_section *section = NULL;
        memory.requests = 0;
        memory.fail_at = n;
        pir_status status = pir_mesh_section(mesh, (pir_vec3){1, 2, 3}, 0.1, &section);
        if (status == PIR_OK)
            pir_section_destroy(section);
        assert_int_equal(memory.blocks, blocks);
        if (status == PIR_OK)
            break;
        assert_int_equal(status, PIR_ERR_MEMORY);
        assert_null(section);
        failures++;
    }
    memory.fail_at = 0;
    assert_true(failures >= 5 && !memory.wrong_size);
    pir_mesh_destroy(mesh);
    pir_polytope_release(polytope);
    assert_int_equal(memory.blocks, 0);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sections_of_sums_are_the_hulls_of_what_the_plane_cuts),
        cmocka_unit_test(planes_through_vertices_edges_and_facets_of_boxes),
        cmocka_unit_test(what_is_no_plane_is_refused),
        cmocka_unit_test(memory_that_runs_out_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

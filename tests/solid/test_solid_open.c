/* SPDX-License-Identifier: MIT */
/*
 * Sums of open solids: what they leave out within the closed sum.
 *
 * Known ones: a maze with corridors as wide as the cube, a frame that the cube passes through, a cavity that it fills.
 * Random ones, of unions of unit cubes, against a count over the cells of the grid, of every dimension: the sum of two
 * open solids is that of the cells, corners to cubes, of which they consist.
 *
 * PIR_TEST_CASES sets how many random cases there are.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "support/solid_sums.h"

static const pir_quat no_turn = {0, 0, 0, 1};

static pir_mesh *open_sum(const cells *p, const cells *q, pir_solid_sum_info *info) {
    pir_solid_sum_options options = pir_solid_sum_options_default();
    pir_mesh *mesh = NULL;
    pir_solid *of_p = solid_of_cells(p), *of_q = solid_of_cells(q);
    options.open = true;
    assert_int_equal(solid_sum_mesh(of_p, of_q, no_turn, &options, info, &mesh), PIR_OK);
    pir_solid_release(of_q);
    pir_solid_release(of_p);
    return mesh;
}

/* --- the grid --- */

/* Cells of every dimension, numbered by twice the middle's coordinates: odd ones have a length along that axis. */
enum { SPAN = 4 * CELLS + 1 };

struct grid {
    bool in[SPAN][SPAN][SPAN];
};

/* Whether all cubes around a cell are full, so that it is inside the open solid. */
static bool is_inside(const cells *of, int x, int y, int z) {
    for (int i = 0; i < 8; i++)
        if (!cells_full(of, (x - (x % 2 == 0 && (i & 1))) >> 1, (y - (y % 2 == 0 && (i >> 1 & 1))) >> 1,
                        (z - (z % 2 == 0 && i >> 2)) >> 1))
            return false;
    return true;
}

/* The sum of two open intervals or points: from *low to *high in cells. */
static void add_axis(int a, int b, int *low, int *high) {
    const bool both = a % 2 && b % 2;
    *low = a + b - both;
    *high = a + b + both;
}

static void add_cells(struct grid *sum, const int a[3], const int b[3]) {
    int low[3], high[3];
    for (int k = 0; k < 3; k++)
        add_axis(a[k], b[k], &low[k], &high[k]);
    for (int x = low[0]; x <= high[0]; x++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int z = low[2]; z <= high[2]; z++)
                sum->in[x][y][z] = true;
}

static int list_inside(const cells *of, int (*ret_cell)[3]) {
    int count = 0;
    for (int x = 0; x <= 2 * CELLS; x++)
        for (int y = 0; y <= 2 * CELLS; y++)
            for (int z = 0; z <= 2 * CELLS; z++)
                if (is_inside(of, x, y, z)) {
                    const int at[3] = {x, y, z};
                    memcpy(ret_cell[count++], at, sizeof at);
                }
    return count;
}

static void add_grids(struct grid *sum, const cells *p, const cells *q) {
    static int a[729][3], b[729][3];
    memset(sum, 0, sizeof *sum);
    const int count_a = list_inside(p, a), count_b = list_inside(q, b);
    for (int i = 0; i < count_a; i++)
        for (int j = 0; j < count_b; j++)
            add_cells(sum, a[i], b[j]);
}

static bool is_in(const struct grid *sum, int x, int y, int z) {
    return x >= 0 && y >= 0 && z >= 0 && x < SPAN && y < SPAN && z < SPAN && sum->in[x][y][z];
}

/* Whether all cells that are one dimension more around a cell are in the sum, and it is not. */
static bool is_left_out(const struct grid *sum, int x, int y, int z) {
    if (is_in(sum, x, y, z))
        return false;
    for (int step = -1; step <= 1; step += 2)
        if ((x % 2 == 0 && !is_in(sum, x + step, y, z)) || (y % 2 == 0 && !is_in(sum, x, y + step, z)) ||
            (z % 2 == 0 && !is_in(sum, x, y, z + step)))
            return false;
    return true;
}

/* How much is left out, by dimension: points, length, area. And the sum of where the points are, in grid units. */
struct left_out {
    double measure[3], place;
};

static struct left_out count_left_out(const struct grid *sum) {
    struct left_out left = {{0}, 0};
    for (int x = 0; x < SPAN; x++)
        for (int y = 0; y < SPAN; y++)
            for (int z = 0; z < SPAN; z++) {
                const int dimension = x % 2 + y % 2 + z % 2;
                if (dimension == 3 || !is_left_out(sum, x, y, z))
                    continue;
                left.measure[dimension]++;
                left.place += dimension == 0 ? x + 100 * y + 10000 * z : 0;
            }
    left.place /= 2;
    return left;
}

/* --- the mesh --- */

static double area_of(const pir_mesh *mesh, uint32_t facet) {
    uint32_t count;
    const uint32_t *corner = pir_mesh_facet(mesh, facet, &count);
    const pir_vec3 *x = pir_mesh_vertices(mesh);
    double sum[3] = {0};
    for (uint32_t i = 0; i < count; i++) {
        const pir_vec3 a = x[corner[i]], b = x[corner[i + 1 < count ? i + 1 : 0]];
        sum[0] += a.y * b.z - a.z * b.y;
        sum[1] += a.z * b.x - a.x * b.z;
        sum[2] += a.x * b.y - a.y * b.x;
    }
    return sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / 2;
}

static struct left_out measure_left_out(const pir_mesh *mesh) {
    struct left_out left = {{0}, 0};
    const pir_vec3 *x = pir_mesh_vertices(mesh);
    uint32_t count;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++)
        if (pir_mesh_facet_kind(mesh, f) == PIR_FACET_TWO_SIDED)
            left.measure[2] += area_of(mesh, f) / 2;
    const uint32_t *segment = pir_mesh_segments(mesh, &count);
    for (uint32_t i = 0; i < count; i++) {
        const pir_vec3 a = x[segment[2 * i]], b = x[segment[2 * i + 1]];
        left.measure[1] += fabs(a.x - b.x) + fabs(a.y - b.y) + fabs(a.z - b.z);
    }
    const uint32_t *point = pir_mesh_points(mesh, &count);
    for (uint32_t i = 0; i < count; i++) {
        left.measure[0]++;
        left.place += x[point[i]].x + 100 * x[point[i]].y + 10000 * x[point[i]].z;
    }
    return left;
}

static bool same(const struct left_out *a, const struct left_out *b) {
    return memcmp(a->measure, b->measure, sizeof a->measure) == 0 && a->place == b->place;
}

/* --- the tests --- */

static void expect_counts(const cells *p, const uint32_t counts[6]) {
    cells cube = {0};
    cube.full[0][0][0] = true;
    pir_solid_sum_info info;
    pir_mesh *mesh = open_sum(p, &cube, &info);
    expect(info.vertices == counts[0] && info.edges == counts[1] && info.facets == counts[2] &&
               info.two_sided == counts[3] && info.segments == counts[4] && info.points == counts[5],
           "%u vertices, %u edges, %u facets, %u two-sided, %u segments, %u points", info.vertices, info.edges,
           info.facets, info.two_sided, info.segments, info.points);
    pir_mesh_destroy(mesh);
}

static void cube_through_a_frame_leaves_a_segment(void **state) {
    (void)state;
    cells frame = {0};
    for (int i = 0; i < 9; i++)
        frame.full[i % 3][i / 3][0] = i != 4;
    expect_counts(&frame, (const uint32_t[]){10, 13, 6, 0, 1, 0});
}

static void cube_in_a_cavity_leaves_a_point(void **state) {
    (void)state;
    cells block = {0};
    for (int i = 0; i < 27; i++)
        block.full[i % 3][i / 3 % 3][i / 9] = i != 13;
    expect_counts(&block, (const uint32_t[]){9, 12, 6, 0, 0, 1});
}

/* A block with a corridor as wide as the cube, from one side to the next, open above. */
static void cube_in_a_corridor_leaves_two_sided_facets(void **state) {
    (void)state;
    cells block = {0};
    for (int i = 0; i < 64; i++) {
        const int x = i % 4, y = i / 4 % 4, z = i / 16;
        block.full[x][y][z] = z == 0 || (z == 1 && !(x == 1 && y >= 1) && !(y == 1 && x >= 1));
    }
    struct grid *sum = malloc(sizeof *sum);
    cells cube = {0};
    cube.full[0][0][0] = true;
    pir_solid_sum_info info;
    pir_mesh *mesh = open_sum(&block, &cube, &info);
    assert_non_null(sum);
    add_grids(sum, &block, &cube);
    const struct left_out expected = count_left_out(sum), found = measure_left_out(mesh);
    assert_true(same(&expected, &found));
    assert_int_equal(info.two_sided, 2);
    assert_int_equal(pir_mesh_facet_count(mesh), info.facets + 2);
    free(sum);
    pir_mesh_destroy(mesh);
}

/* Turns a union of cubes inside out within a block, so that there is much to pass through: empty where it was full. */
static cells complement(const cells *of) {
    cells made = {0};
    for (int i = 0; i < CELLS * CELLS * CELLS; i++) {
        const int x = i % CELLS, y = i / CELLS % CELLS, z = i / CELLS / CELLS;
        made.full[x][y][z] = !of->full[x][y][z];
    }
    return made;
}

static void random_cells_leave_out_what_the_grid_says(void **state) {
    (void)state;
    struct grid *sum = malloc(sizeof *sum);
    double seen[3] = {0};
    assert_non_null(sum);
    for (uint64_t i = 0; i < solid_cases(40); i++) {
        test_random random = test_random_case("open", i);
        cells p = cells_random(&random, 2 + test_random_below(&random, i % 2 ? 24 : 50));
        const cells q = cells_random(&random, 1 + test_random_below(&random, 3));
        const cells other = complement(&p);
        p = i % 2 && cells_are_solid(&other) ? other : p;
        pir_solid_sum_info info;
        pir_mesh *mesh = open_sum(&p, &q, &info);
        add_grids(sum, &p, &q);
        const struct left_out expected = count_left_out(sum), found = measure_left_out(mesh);
        expect(same(&expected, &found), "case %llu: points %g, length %g, area %g, places %g, not %g, %g, %g, %g",
               (unsigned long long)i, found.measure[0], found.measure[1], found.measure[2], found.place,
               expected.measure[0], expected.measure[1], expected.measure[2], expected.place);
        for (int k = 0; k < 3; k++)
            seen[k] += expected.measure[k];
        pir_mesh_destroy(mesh);
    }
    printf("left out in all: %g points, length %g, area %g\n", seen[0], seen[1], seen[2]);
    free(sum);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_through_a_frame_leaves_a_segment),
        cmocka_unit_test(cube_in_a_cavity_leaves_a_point),
        cmocka_unit_test(cube_in_a_corridor_leaves_two_sided_facets),
        cmocka_unit_test(random_cells_leave_out_what_the_grid_says),
    };
    return cmocka_run_group_tests_name("sums of open solids", tests, NULL, NULL);
}

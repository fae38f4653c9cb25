/* SPDX-License-Identifier: MIT */
/*
 * Surfaces that touch themselves within facets and edges. Boxes on a grid, with maximal facets, touch each other
 * anywhere: volumes are counts of cells, sums with a box those of wider boxes, states those of cells.
 *
 * PIR_TEST_CASES sets how many cases there are.
 */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "support/solid_sums.h"

static solid_facets facets;

/* --- boxes on a grid --- */

#define GRID 16
#define MOST 128 /* corners of a facet */

/* Cells of a grid. */
typedef struct grid {
    bool full[GRID][GRID][GRID];
} grid;

typedef struct box {
    int low[3], high[3];
} box;

static void fill_box(grid *of, const box *b) {
    for (int x = b->low[0]; x < b->high[0]; x++)
        for (int y = b->low[1]; y < b->high[1]; y++)
            for (int z = b->low[2]; z < b->high[2]; z++)
                of->full[x][y][z] = true;
}

static bool is_full(const grid *of, int x, int y, int z) {
    return x >= 0 && y >= 0 && z >= 0 && x < GRID && y < GRID && z < GRID && of->full[x][y][z];
}

/* The cells of a sum with a box from the origin. */
static grid widen(const grid *of, const int by[3]) {
    grid wider = {0};
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        const int x = i % GRID, y = i / GRID % GRID, z = i / GRID / GRID;
        const box b = {{x, y, z}, {x + 1 + by[0], y + 1 + by[1], z + 1 + by[2]}};
        if (of->full[x][y][z])
            fill_box(&wider, &b);
    }
    return wider;
}

static unsigned long count_of(const grid *of) {
    unsigned long count = 0;
    for (int i = 0; i < GRID * GRID * GRID; i++)
        count += of->full[i % GRID][i / GRID % GRID][i / GRID / GRID];
    return count;
}

/* Whether two boxes share an inside, or an area of their sides. */
static bool share(const box *a, const box *b) {
    int touching = 0;
    for (int k = 0; k < 3; k++) {
        const int length =
            (a->high[k] < b->high[k] ? a->high[k] : b->high[k]) - (a->low[k] > b->low[k] ? a->low[k] : b->low[k]);
        if (length < 0)
            return false;
        touching += length == 0;
    }
    return touching < 2;
}

static void add_box(const box *b) {
    const uint32_t first = facets.points;
    const double x[2] = {b->low[0], b->high[0]}, y[2] = {b->low[1], b->high[1]};
    const double corner[4][2] = {{x[0], y[0]}, {x[1], y[0]}, {x[1], y[1]}, {x[0], y[1]}};
    solid_add_prism(&facets, corner, 4, b->high[2] - b->low[2]);
    for (uint32_t i = first; i < facets.points; i++)
        facets.point[i].z += b->low[2];
}

static pir_solid *made_solid(uint64_t number) {
    pir_solid *solid = NULL;
    pir_report report = {0};
    const pir_status status = solid_make(&facets, NULL, &report, &solid);
    expect(status == PIR_OK, "case %llu: %s", (unsigned long long)number, report.text);
    return solid;
}

static pir_solid *box_solid(const int by[3]) {
    const box b = {{0, 0, 0}, {by[0], by[1], by[2]}};
    facets = (solid_facets){0};
    add_box(&b);
    return made_solid(0);
}

/* Boxes that touch each other along edges and at corners, and anywhere on them, but share no area. */
static pir_solid *boxes_at_random(test_random *random, uint32_t count, grid *ret_cells, uint64_t number) {
    box b[8];
    uint32_t made = 0;
    *ret_cells = (grid){0};
    facets = (solid_facets){0};
    for (uint32_t tries = 0; tries < 400 && made < count; tries++) {
        bool fits = true;
        for (int k = 0; k < 3; k++) {
            b[made].low[k] = test_random_between(random, 0, 6);
            b[made].high[k] = b[made].low[k] + test_random_between(random, 1, 3);
        }
        for (uint32_t i = 0; i < made; i++)
            fits = fits && !share(&b[i], &b[made]);
        if (!fits)
            continue;
        add_box(&b[made]);
        fill_box(ret_cells, &b[made++]);
    }
    return made_solid(number);
}

/* Where a unit cube at each place of the grid is against a solid. */
static void check_states(const pir_solid *solid, const grid *of, uint64_t number) {
    const int unit[3] = {1, 1, 1};
    pir_solid *cube = box_solid(unit);
    pir_pieces *of_solid = NULL, *of_cube = NULL;
    pir_solid_query *query = NULL;
    pir_workspace *workspace = NULL;
    assert_int_equal(pir_solid_decompose(solid, NULL, NULL, &of_solid), PIR_OK);
    assert_int_equal(pir_solid_decompose(cube, NULL, NULL, &of_cube), PIR_OK);
    assert_int_equal(pir_solid_query_create(of_cube, of_solid, NULL, &query), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        const int x = i % GRID, y = i / GRID % GRID, z = i / GRID / GRID;
        pir_pair_input input = pir_pair_input_default();
        pir_state state, right = PIR_OUTSIDE;
        for (int k = 0; k < 27; k++)
            if (is_full(of, x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1))
                right = PIR_BOUNDARY;
        right = is_full(of, x, y, z) ? PIR_INSIDE : right;
        input.pose_p.translation = (pir_vec3){x, y, z};
        assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &state), PIR_OK);
        expect(state == right, "case %llu: at %d %d %d the state is %d, not %d", (unsigned long long)number, x, y, z,
               (int)state, (int)right);
    }
    pir_workspace_destroy(workspace);
    pir_solid_query_destroy(query);
    pir_pieces_destroy(of_cube);
    pir_pieces_destroy(of_solid);
    pir_solid_release(cube);
}

/* The facets of a mesh, with another corner in the middle of each side. */
static pir_solid *solid_with_middles(const pir_mesh *mesh, uint64_t number) {
    facets = (solid_facets){0};
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        pir_vec3 at[2 * MOST];
        assert_true(count <= MOST);
        for (uint32_t i = 0; i < count; i++) {
            const pir_vec3 a = pir_mesh_vertices(mesh)[corner[i]], b = pir_mesh_vertices(mesh)[corner[(i + 1) % count]];
            at[2 * i] = a;
            at[2 * i + 1] = (pir_vec3){(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
        }
        solid_add_facet(&facets, at, 2 * count);
    }
    return made_solid(number);
}

/* The sum with a box, written and read again; or its facets, with straight corners. */
static pir_solid *wider_solid(const pir_solid *solid, const int by[3], bool middles, uint64_t number) {
    pir_solid *other = box_solid(by), *again = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(solid_sum_mesh(solid, other, (pir_quat){0, 0, 0, 1}, NULL, NULL, &mesh), PIR_OK);
    again = middles ? solid_with_middles(mesh, number) : solid_read_again(mesh);
    pir_mesh_destroy(mesh);
    pir_solid_release(other);
    return again;
}

static void check_count(const pir_solid *solid, const grid *of, uint64_t number) {
    mpq_t right;
    mpq_init(right);
    mpq_set_ui(right, count_of(of), 1);
    solid_check_volume(solid, right, number);
    mpq_clear(right);
}

static void boxes_on_a_grid_touch_and_are_summed(void **state) {
    (void)state;
    for (uint64_t i = 0; i < solid_cases(30); i++) {
        test_random random = test_random_case("boxes that touch", i);
        grid covered;
        pir_solid *solid = boxes_at_random(&random, 2 + (uint32_t)(i % 6), &covered, i);
        check_count(solid, &covered, i);
        for (int round = 0; round < 2; round++) {
            int by[3];
            for (int k = 0; k < 3; k++)
                by[k] = test_random_between(&random, 1, 2);
            pir_solid *wider = wider_solid(solid, by, i % 3 == 0, i);
            covered = widen(&covered, by);
            check_count(wider, &covered, i);
            if (i % 8 == 0)
                check_states(wider, &covered, i);
            pir_solid_release(solid);
            solid = wider;
        }
        pir_solid_release(solid);
    }
}

/* --- situations --- */

static void expect_refused(const char *text) {
    pir_report report = {0};
    pir_solid *solid = NULL;
    assert_int_equal(solid_make(&facets, NULL, &report, &solid), PIR_ERR_FORMAT);
    expect(strstr(report.text, text), "'%s' in '%s'", text, report.text);
}

/* The point beyond the plane x + y + z = 3. */
static pir_vec3 mirrored(pir_vec3 v) {
    const double by = 2 * (v.x + v.y + v.z - 3) / 3;
    return (pir_vec3){v.x - by, v.y - by, v.z - by};
}

/* The sides of a cube as squares, or cut along the diagonals that do or do not end at its first corner and the last. */
static void add_cube(bool is_mirrored, int cut) {
    static const double square[4][2] = {{0, 0}, {3, 0}, {3, 3}, {0, 3}};
    static solid_facets cube;
    cube = (solid_facets){0};
    solid_add_prism(&cube, square, 4, 3);
    for (uint32_t f = 0; f < cube.facets; f++) {
        pir_vec3 at[4];
        uint32_t first = 0;
        for (uint32_t i = 0; i < 4; i++) {
            const pir_vec3 v = cube.point[cube.corner[cube.start[f] + (is_mirrored ? 3 - i : i)]];
            const double sum = v.x + v.y + v.z;
            at[i] = is_mirrored ? mirrored(v) : v;
            first = ((sum == 0 || sum == 9) == (cut == 1)) ? i : first;
        }
        if (cut > 0) {
            solid_add_facet(&facets, (const pir_vec3[]){at[first], at[(first + 1) % 4], at[(first + 2) % 4]}, 3);
            solid_add_facet(&facets, (const pir_vec3[]){at[first], at[(first + 2) % 4], at[(first + 3) % 4]}, 3);
        } else {
            solid_add_facet(&facets, at, 4);
        }
    }
}

/* A cube and its mirror image cross along the diagonals of three sides, and no edge meets a facet but at common
 * corners. */
static void cubes_that_cross_along_diagonals_are_refused(void **state) {
    (void)state;
    for (int cut = 0; cut < 9; cut++) {
        pir_report report = {0};
        pir_solid *solid = NULL;
        facets = (solid_facets){0};
        add_cube(false, cut % 3);
        add_cube(true, cut / 3);
        const pir_status status = solid_make(&facets, NULL, &report, &solid);
        expect(status != PIR_OK && (strstr(report.text, "meets itself") || strstr(report.text, "is on 4 facets")),
               "cut %d: '%s'", cut, report.text);
    }
}

/* A cavity in a block, of edges along and corners on its sides, whose top is cut into facets in other ways. */
static void cavity_touches_the_outside_from_within(void **state) {
    (void)state;
    static const double square[4][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    const pir_vec3 roof[2] = {{1, 2, 4}, {3, 2, 4}}, floor[4] = {{1, 1, 1}, {3, 1, 1}, {3, 3, 1}, {1, 3, 1}};
    facets = (solid_facets){0};
    solid_add_prism(&facets, square, 4, 4);
    solid_add_facet(&facets, floor, 4);
    solid_add_facet(&facets, (const pir_vec3[]){floor[0], roof[0], roof[1], floor[1]}, 4);
    solid_add_facet(&facets, (const pir_vec3[]){floor[2], roof[1], roof[0], floor[3]}, 4);
    solid_add_facet(&facets, (const pir_vec3[]){floor[0], floor[3], roof[0]}, 3);
    solid_add_facet(&facets, (const pir_vec3[]){floor[1], roof[1], floor[2]}, 3);
    pir_solid *solid = made_solid(0);
    pir_solid_info info;
    mpq_t right;
    pir_solid_describe(solid, &info);
    assert_int_equal(info.shells, 2);
    mpq_init(right);
    mpq_set_ui(right, 64 - 6, 1); // a roof over a square of 2 × 2, 3 high
    solid_check_volume(solid, right, 0);
    mpq_clear(right);
    pir_solid_release(solid);
    for (uint32_t i = 0; i < facets.points; i++)
        if (facets.point[i].z == 4 && facets.point[i].y == 2)
            facets.point[i].z = 5;
    expect_refused("meets itself");
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_on_a_grid_touch_and_are_summed),
        cmocka_unit_test(cubes_that_cross_along_diagonals_are_refused),
        cmocka_unit_test(cavity_touches_the_outside_from_within),
    };
    return cmocka_run_group_tests_name("solids that touch themselves", tests, NULL, NULL);
}

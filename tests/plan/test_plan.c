/* SPDX-License-Identifier: MIT */
/*
 * Plans of bodies of unit cubes, against a flood of the grid. A cell of the half grid is a corner, an edge, a side or
 * the inside of a cube of translations, each without its ends; all of its translations are free, or none is. So free
 * cells of which one bounds the other are connected, and that is all there is, whether bodies may touch or not.
 *
 * Obstacles are one solid or two; all is mapped by one integer matrix, and P is turned away and back by R.
 *
 * PIR_TEST_CASES sets how many cases there are.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "support/memory.h"

#define SIDE  5
#define SMALL 2
/* The half grid: translations from FIRST on, in halves. */
#define FIRST (-(SMALL + 1))
#define HALF  (2 * (SIDE + 1 - FIRST) + 1)

struct scene {
    uint8_t obstacle[SIDE][SIDE][SIDE]; /* 0, or which obstacle it is of */
    bool robot[SMALL][SMALL][SMALL];
    uint8_t grid[HALF][HALF][HALF]; /* 0 blocked, 1 free, 2 reached */
    int low[3], high[3];            /* bounds in halves, from FIRST on */
    int end[2][3];
    int matrix[3][3];
    bool open, bounded, turned;
    uint32_t obstacles;
};

/* --- solids --- */

static pir_vec3 mapped(const struct scene *s, double x, double y, double z, bool turned) {
    double to[3];
    for (int k = 0; k < 3; k++)
        to[k] = s->matrix[k][0] * x + s->matrix[k][1] * y + s->matrix[k][2] * z;
    const pir_vec3 v = {to[0], to[1], to[2]};
    // R turns by 90 degrees about z
    return turned ? (pir_vec3){v.y, -v.x, v.z} : v;
}

static bool has_cube(const struct scene *s, int body, int x, int y, int z) {
    if (x < 0 || y < 0 || z < 0)
        return false;
    if (body == 0)
        return x < SMALL && y < SMALL && z < SMALL && s->robot[x][y][z];
    return x < SIDE && y < SIDE && z < SIDE && s->obstacle[x][y][z] == body;
}

static void add_side(const struct scene *s, solid_facets *facets, const int at[3], int k, int up, bool turned) {
    pir_vec3 corner[4];
    for (int i = 0; i < 4; i++) {
        const int turn = up ? i : 3 - i;
        double c[3];
        c[k] = at[k] + up;
        c[(k + 1) % 3] = at[(k + 1) % 3] + (turn == 1 || turn == 2);
        c[(k + 2) % 3] = at[(k + 2) % 3] + (turn >= 2);
        corner[i] = mapped(s, c[0], c[1], c[2], turned);
    }
    solid_add_facet(facets, corner, 4);
}

/* The solid of a body's cubes; NULL where there are none. */
static pir_solid *solid_of(const struct scene *s, int body) {
    static solid_facets facets;
    facets = (solid_facets){0};
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        const int at[3] = {i / (SIDE * SIDE), i / SIDE % SIDE, i % SIDE};
        for (int side = 0; side < 6 && has_cube(s, body, at[0], at[1], at[2]); side++) {
            int beside[3] = {at[0], at[1], at[2]};
            beside[side / 2] += side % 2 ? 1 : -1;
            if (!has_cube(s, body, beside[0], beside[1], beside[2]))
                add_side(s, &facets, at, side / 2, side % 2, body == 0 && s->turned);
        }
    }
    return facets.facets > 0 ? solid_of_facets(&facets) : NULL;
}

/* --- the oracle --- */

static void block(struct scene *s, const int at[3]) {
    // the sum of two cubes is a cube of side 2 about `at`
    const int reach = s->open ? 1 : 2;
    for (int x = -reach; x <= reach; x++)
        for (int y = -reach; y <= reach; y++)
            for (int z = -reach; z <= reach; z++)
                s->grid[2 * (at[0] - FIRST) + x][2 * (at[1] - FIRST) + y][2 * (at[2] - FIRST) + z] = 0;
}

static void fill_grid(struct scene *s) {
    for (int x = 0; x < HALF; x++)
        for (int y = 0; y < HALF; y++)
            for (int z = 0; z < HALF; z++)
                s->grid[x][y][z] = x >= s->low[0] && y >= s->low[1] && z >= s->low[2] && x <= s->high[0] &&
                                   y <= s->high[1] && z <= s->high[2];
    for (int q = 0; q < SIDE * SIDE * SIDE; q++)
        for (int p = 0; p < SMALL * SMALL * SMALL; p++) {
            const int of_q[3] = {q / (SIDE * SIDE), q / SIDE % SIDE, q % SIDE};
            const int of_p[3] = {p / (SMALL * SMALL), p / SMALL % SMALL, p % SMALL};
            if (s->obstacle[of_q[0]][of_q[1]][of_q[2]] && s->robot[of_p[0]][of_p[1]][of_p[2]])
                block(s, (const int[3]){of_q[0] - of_p[0], of_q[1] - of_p[1], of_q[2] - of_p[2]});
        }
}

/* Marks all that is connected with a cell. */
static void flood(struct scene *s, const int from[3]) {
    static int queue[HALF * HALF * HALF][3];
    int count = 1;
    memcpy(queue[0], from, sizeof queue[0]);
    s->grid[from[0]][from[1]][from[2]] = 2;
    for (int done = 0; done < count; done++)
        for (int k = 0; k < 6; k++) {
            int at[3] = {queue[done][0], queue[done][1], queue[done][2]};
            at[k / 2] += k % 2 ? 1 : -1;
            if (at[k / 2] < 0 || at[k / 2] >= HALF || s->grid[at[0]][at[1]][at[2]] != 1)
                continue;
            s->grid[at[0]][at[1]][at[2]] = 2;
            memcpy(queue[count++], at, sizeof at);
        }
}

/* --- cases --- */

static void random_matrix(test_random *random, struct scene *s) {
    int det = 0;
    while (det <= 0) {
        for (int i = 0; i < 9; i++)
            s->matrix[i / 3][i % 3] = test_random_between(random, -3, 3);
        int(*m)[3] = s->matrix;
        det = 0;
        for (int k = 0; k < 3; k++)
            det += m[0][k] * (m[1][(k + 1) % 3] * m[2][(k + 2) % 3] - m[1][(k + 2) % 3] * m[2][(k + 1) % 3]);
    }
}

static bool is_outer(int i) {
    return i == 0 || i == SIDE - 1;
}

/* Cubes at random, or a box with few holes and few cubes within. */
static void random_bodies(test_random *random, struct scene *s) {
    const bool is_box = test_random_below(random, 4) > 0;
    const uint32_t percent = is_box ? test_random_below(random, 50) : 30 + test_random_below(random, 60);
    const uint32_t wall = 85 + test_random_below(random, 16);
    s->obstacles = 1 + test_random_below(random, 2);
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        const bool outer = is_outer(i / (SIDE * SIDE)) || is_outer(i / SIDE % SIDE) || is_outer(i % SIDE);
        const bool full = test_random_below(random, 100) < (is_box && outer ? wall : percent);
        ((uint8_t *)s->obstacle)[i] = full ? (uint8_t)(1 + test_random_below(random, s->obstacles)) : 0;
    }
    s->obstacle[0][0][0] = 1;
    s->obstacle[SIDE - 1][0][0] = (uint8_t)s->obstacles;
    const uint32_t robot = test_random_below(random, 4);
    s->robot[0][0][0] = true;
    s->robot[1][0][0] = robot >= 1;
    s->robot[0][1][0] = robot >= 2;
    s->robot[0][1][1] = robot >= 3;
}

/* A free cell at random; those far within come more often than they would. */
static bool random_free(test_random *random, const struct scene *s, int ret_at[3]) {
    for (int tries = 0; tries < 200; tries++) {
        for (int k = 0; k < 3; k++)
            ret_at[k] = tries < 100 ? test_random_between(random, 2 - 2 * FIRST, 2 * (SIDE - FIRST) - 4)
                                    : test_random_between(random, 0, HALF - 1);
        if (s->grid[ret_at[0]][ret_at[1]][ret_at[2]])
            return true;
    }
    return false;
}

static bool make_scene(uint64_t number, struct scene *s) {
    test_random random = test_random_case("plan", number);
    *s = (struct scene){.matrix = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    s->open = test_random_below(&random, 2);
    s->bounded = test_random_below(&random, 3) == 0;
    s->turned = test_random_below(&random, 2);
    random_bodies(&random, s);
    for (int k = 0; k < 3; k++) {
        s->low[k] = s->bounded ? 2 * test_random_between(&random, 0, 4) : 0;
        s->high[k] =
            s->bounded ? s->low[k] + 2 * test_random_between(&random, 1, (HALF - 1 - s->low[k]) / 2) : HALF - 1;
    }
    if (!s->bounded && test_random_below(&random, 2))
        random_matrix(&random, s);
    fill_grid(s);
    if (!random_free(&random, s, s->end[0]))
        return false;
    flood(s, s->end[0]);
    // where a part is cut off, half of the cases go there
    for (int tries = test_random_below(&random, 2) ? 20 : 1; tries > 0; tries--) {
        if (!random_free(&random, s, s->end[1]))
            return false;
        if (s->grid[s->end[1][0]][s->end[1][1]][s->end[1][2]] == 1)
            break;
    }
    return true;
}

static pir_vec3 place_of(const struct scene *s, const int half[3]) {
    return mapped(s, half[0] / 2.0 + FIRST, half[1] / 2.0 + FIRST, half[2] / 2.0 + FIRST, false);
}

static pir_status ask(const struct scene *s, const pir_allocator *allocator, pir_path_plan **ret_plan) {
    pir_path_plan_options options = pir_path_plan_options_default();
    pir_report report = {0};
    const pir_solid *obstacle[2], *robot[] = {solid_of(s, 0)};
    for (uint32_t i = 0; i < s->obstacles; i++)
        obstacle[i] = solid_of(s, (int)i + 1);
    options.allocator = allocator;
    options.report = &report;
    options.open = s->open;
    options.bounded = s->bounded;
    options.low = place_of(s, s->low);
    options.high = place_of(s, s->high);
    const pir_path_plan_input input = {
        robot, 1, obstacle, s->obstacles, {0, 0, s->turned ? 3 : 0, 3}, place_of(s, s->end[0]), place_of(s, s->end[1])};
    const pir_status status = pir_path_plan_translate(&input, &options, ret_plan);
    if (status != PIR_OK && !allocator)
        print_error("%s\n", report.text);
    assert_int_equal(report.status, status);
    for (uint32_t i = 0; i < s->obstacles; i++)
        pir_solid_release((pir_solid *)obstacle[i]);
    pir_solid_release((pir_solid *)robot[0]);
    return status;
}

/* How deep a translation of the grid is within a sum of cubes. */
static double depth_at(const struct scene *s, const double t[3]) {
    double depth = -1;
    for (int q = 0; q < SIDE * SIDE * SIDE; q++)
        for (int p = 0; p < SMALL * SMALL * SMALL; p++) {
            const int of_q[3] = {q / (SIDE * SIDE), q / SIDE % SIDE, q % SIDE};
            const int of_p[3] = {p / (SMALL * SMALL), p / SMALL % SMALL, p % SMALL};
            if (!s->obstacle[of_q[0]][of_q[1]][of_q[2]] || !s->robot[of_p[0]][of_p[1]][of_p[2]])
                continue;
            double own = 1;
            for (int k = 0; k < 3; k++) {
                const double off = t[k] - (of_q[k] - of_p[k]), slack = 1 - (off < 0 ? -off : off);
                own = slack < own ? slack : own;
            }
            depth = own > depth ? own : depth;
        }
    return depth;
}

/* Every sample of the path is free, but for rounding; scenes that are not mapped alone. */
static void check_path(const struct scene *s, const pir_path_plan *plan, uint64_t number) {
    pir_path_plan_info info;
    pir_path_plan_describe(plan, &info);
    pir_vec3 last = {0, 0, 0};
    mpq_t x[3];
    mpq_inits(x[0], x[1], x[2], NULL);
    for (uint32_t i = 0; i < info.points; i++) {
        pir_vec3 now;
        bool exact;
        assert_int_equal(pir_path_plan_waypoint(plan, i, &now, &exact), PIR_OK);
        assert_int_equal(pir_path_plan_waypoint_exact(plan, i, x), PIR_OK);
        const double rounded[3] = {mpq_get_d(x[0]), mpq_get_d(x[1]), mpq_get_d(x[2])};
        assert_true(!exact || (now.x == rounded[0] && now.y == rounded[1] && now.z == rounded[2]));
        for (int k = 0; k <= 32 && i > 0; k++) {
            const double u = k / 32.0, t[3] = {last.x + u * (now.x - last.x), last.y + u * (now.y - last.y),
                                               last.z + u * (now.z - last.z)};
            const double depth = depth_at(s, t);
            expect(depth < 1e-9, "case %llu: motion %u is %g deep", (unsigned long long)number, i, depth);
        }
        last = now;
    }
    mpq_clears(x[0], x[1], x[2], NULL);
}

static void plans_are_those_of_the_grid(void **state) {
    (void)state;
    static struct scene s;
    unsigned seen[2][2] = {{0}};
    for (uint64_t i = 0; i < solid_cases(100); i++) {
        if (!make_scene(i, &s))
            continue;
        pir_path_plan *plan = NULL;
        pir_path_plan_info info;
        const bool reached = s.grid[s.end[1][0]][s.end[1][1]][s.end[1][2]] == 2;
        const pir_status status = ask(&s, NULL, &plan);
        expect(status == PIR_OK, "case %llu: %s", (unsigned long long)i, pir_status_text(status));
        pir_path_plan_describe(plan, &info);
        expect((info.answer == PIR_PLAN_PATH) == reached, "case %llu: %d, not %d, open %d bounded %d",
               (unsigned long long)i, (int)info.answer, reached, s.open, s.bounded);
        seen[s.open][reached]++;
        if (reached && s.matrix[0][0] == 1 && s.matrix[1][1] == 1 && s.matrix[2][2] == 1 && s.matrix[0][1] == 0)
            check_path(&s, plan, i);
        pir_path_plan_destroy(plan);
    }
    print_message("closed: %u without, %u with a path; open: %u, %u\n", seen[0][0], seen[0][1], seen[1][0], seen[1][1]);
    for (int k = 0; k < 4; k++)
        assert_true(seen[k / 2][k % 2] > 0);
}

static pir_status write_to_nowhere(const pir_path_plan *plan) {
    FILE *file = fopen("/dev/null", "w");
    assert_non_null(file);
    const pir_status status = pir_path_plan_write(plan, file);
    fclose(file);
    return status;
}

/* Steps from request to request grow, so that not every request fails once. */
static void memory_that_runs_out_is_told(void **state) {
    (void)state;
    static struct scene s;
    for (uint64_t number = 0; number < 2; number++) {
        assert_true(make_scene(number, &s));
        for (uint64_t at = 1, step = 1;; at += step, step += step / 8 + (at > 300)) {
            test_memory memory = {.fail_at = at};
            const pir_allocator allocator = test_allocator(&memory);
            pir_path_plan *plan = NULL;
            const pir_status status = ask(&s, &allocator, &plan);
            assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && !plan));
            if (status == PIR_OK)
                memory.fail_at = memory.requests + 1;
            assert_int_equal(plan ? write_to_nowhere(plan) : PIR_ERR_MEMORY, PIR_ERR_MEMORY);
            pir_path_plan_destroy(plan);
            assert_true(memory.blocks == 0 && !memory.wrong_size);
            if (status == PIR_OK)
                break;
        }
    }
}

static void bad_questions_are_refused(void **state) {
    (void)state;
    static struct scene s;
    assert_true(make_scene(0, &s));
    pir_solid *solid = solid_of(&s, 1);
    const pir_solid *const some[] = {solid}, *const none[] = {NULL};
    pir_path_plan *plan = NULL;
    const pir_path_plan_input good = {some, 1, some, 1, {0, 0, 0, 1}, {-200, 0, 0}, {200, 0, 0}};
    pir_path_plan_input bad = good;
    assert_int_equal(pir_path_plan_translate(NULL, NULL, &plan), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_path_plan_translate(&good, NULL, NULL), PIR_ERR_ARGUMENT);
    bad.robot = none;
    assert_int_equal(pir_path_plan_translate(&bad, NULL, &plan), PIR_ERR_ARGUMENT);
    bad = good, bad.obstacle_count = 0;
    assert_int_equal(pir_path_plan_translate(&bad, NULL, &plan), PIR_ERR_EMPTY);
    bad = good, bad.rotation.w = 0;
    assert_int_equal(pir_path_plan_translate(&bad, NULL, &plan), PIR_ERR_ZERO_QUATERNION);
    bad = good, bad.rotation.w = INFINITY;
    assert_int_equal(pir_path_plan_translate(&bad, NULL, &plan), PIR_ERR_NOT_FINITE);
    bad = good, bad.to.y = NAN;
    assert_int_equal(pir_path_plan_translate(&bad, NULL, &plan), PIR_ERR_NOT_FINITE);
    bad = good, bad.to.x = 1.7e308;
    assert_int_equal(pir_path_plan_translate(&bad, NULL, &plan), PIR_ERR_LIMIT);
    bad = good, bad.to.x = 0;
    assert_int_equal(pir_path_plan_translate(&bad, NULL, &plan), PIR_ERR_ARGUMENT);
    pir_path_plan_options options = pir_path_plan_options_default();
    options.memory = 10000;
    assert_int_equal(pir_path_plan_translate(&good, &options, &plan), PIR_ERR_LIMIT);
    assert_null(plan);
    assert_int_equal(pir_path_plan_translate(&good, NULL, &plan), PIR_OK);
    pir_vec3 at;
    pir_path_plan_info info;
    pir_path_plan_describe(plan, &info);
    assert_int_equal(pir_path_plan_waypoint(plan, info.points, &at, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_path_plan_write(plan, NULL), PIR_ERR_ARGUMENT);
    pir_path_plan_destroy(plan);
    pir_path_plan_destroy(NULL);
    pir_solid_release(solid);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plans_are_those_of_the_grid),
        cmocka_unit_test(memory_that_runs_out_is_told),
        cmocka_unit_test(bad_questions_are_refused),
    };
    return cmocka_run_group_tests_name("plans", tests, NULL, NULL);
}

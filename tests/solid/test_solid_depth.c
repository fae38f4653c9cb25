/* SPDX-License-Identifier: MIT */
/*
 * Depths of solids in pieces, against what shares nothing with their search.
 *
 * Unions of unit cubes: the nearest corner, edge, side or cell of the lattice that no cube of the difference holds
 * inside, found by looking at all of them, in exact numbers. Bodies at any rotations and at aligned ones: the boundary
 * of the exact difference of the open bodies, looked at facet by facet. Every answer's place is where it says, on a
 * facet of the pieces that it names, and the bodies touch there at the points that it gives. A query that goes
 * through a motion, or through any history of poses, has the bits of new ones.
 *
 * PIR_TEST_CASES sets how many pairs of unions, or rotations, there are.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "solid/models.h"
#include "support/memory.h"
#include "support/solid_sums.h"
#include "support/vectors.h"

enum { PLACES = 40 };

/* Two bodies and their pieces. */
struct scene {
    pir_pieces *pieces[2];
    pir_solid_query *query;
    pir_workspace *workspace;
    double size;
};

static struct scene scene_of(const pir_solid *p, const pir_solid *q) {
    struct scene scene = {0};
    pir_solid_info info[2];
    assert_int_equal(pir_solid_decompose(p, NULL, NULL, &scene.pieces[0]), PIR_OK);
    assert_int_equal(pir_solid_decompose(q, NULL, NULL, &scene.pieces[1]), PIR_OK);
    assert_int_equal(pir_solid_query_create(scene.pieces[0], scene.pieces[1], NULL, &scene.query), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &scene.workspace), PIR_OK);
    pir_solid_describe(p, &info[0]);
    pir_solid_describe(q, &info[1]);
    for (int k = 0; k < 2; k++)
        scene.size += test_length(test_add(info[k].high, info[k].low, -1));
    return scene;
}

static void scene_finish(struct scene *scene) {
    pir_workspace_destroy(scene->workspace);
    pir_solid_query_destroy(scene->query);
    pir_pieces_destroy(scene->pieces[0]);
    pir_pieces_destroy(scene->pieces[1]);
}

/* --- what an answer says of itself --- */

/* How far a point of the frame of a piece is from it at most. */
static double outside_of(const pir_polytope *piece, pir_vec3 x) {
    double most = -HUGE_VAL;
    for (uint32_t f = 0; f < pir_polytope_facet_count(piece); f++) {
        double height = -HUGE_VAL;
        for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++)
            height = fmax(height, test_dot(pir_polytope_normal(piece, f), pir_polytope_vertex(piece, v)));
        most = fmax(most, test_dot(pir_polytope_normal(piece, f), x) - height);
    }
    return most;
}

/* The farthest a piece goes along a direction of the world. */
static double reach_along(const pir_polytope *piece, pir_pose pose, pir_vec3 n) {
    double most = -HUGE_VAL;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++)
        most = fmax(most, test_dot(n, test_add(test_turn(pose.rotation, pir_polytope_vertex(piece, v), 1),
                                               pose.translation, 1)));
    return most;
}

static pir_vec3 edge_along(const pir_polytope *piece, uint32_t edge) {
    uint32_t ends[2];
    pir_polytope_edge(piece, edge, ends);
    return test_add(pir_polytope_vertex(piece, ends[1]), pir_polytope_vertex(piece, ends[0]), -1);
}

/* The normal, from Q to P, of a facet of the obstacle, in the world; its sign is that along `normal`. */
static pir_vec3 normal_of_facet(const pir_polytope *const piece[2], const pir_pair_input *input,
                                const pir_witness *witness, pir_vec3 normal) {
    pir_vec3 n;
    if (witness->p.kind == PIR_FEATURE_FACET) {
        n = test_turn(input->pose_p.rotation, pir_polytope_normal(piece[0], witness->p.index), 1);
        n = (pir_vec3){-n.x, -n.y, -n.z};
    } else if (witness->q.kind == PIR_FEATURE_FACET) {
        n = test_turn(input->pose_q.rotation, pir_polytope_normal(piece[1], witness->q.index), 1);
    } else {
        n = test_cross(test_turn(input->pose_p.rotation, edge_along(piece[0], witness->p.index), 1),
                       test_turn(input->pose_q.rotation, edge_along(piece[1], witness->q.index), 1));
        const double length = test_length(n) * (test_dot(n, normal) < 0 ? -1 : 1);
        n = (pir_vec3){n.x / length, n.y / length, n.z / length};
    }
    return n;
}

/* Holds the facets and the points of an answer against the pieces; `way` is what P is moved by. */
static void check_answer(const struct scene *scene, const pir_pair_input *input, const pir_solid_depth *answer,
                         pir_vec3 way) {
    const double room = 1e-12 * scene->size;
    assert_in_range(answer->facets, 1, 3);
    assert_true(fabs(test_length(answer->normal) - 1) < 1e-14);
    pir_pose moved = input->pose_p;
    moved.translation = test_add(moved.translation, way, 1);
    for (uint32_t i = 0; i < answer->facets; i++) {
        const pir_solid_facet *facet = &answer->facet[i];
        pir_polytope *piece[2];
        assert_int_equal(pir_pieces_polytope(scene->pieces[0], facet->piece_p, &piece[0]), PIR_OK);
        assert_int_equal(pir_pieces_polytope(scene->pieces[1], facet->piece_q, &piece[1]), PIR_OK);
        const pir_vec3 n =
            normal_of_facet((const pir_polytope *const[]){piece[0], piece[1]}, input, &facet->witness, answer->normal);
        const pir_vec3 back = {-n.x, -n.y, -n.z};
        double apart = fabs(reach_along(piece[0], moved, back) + reach_along(piece[1], input->pose_q, n));
        // further facets may face any way: those of edges have the sign that fits
        if (i > 0 && facet->witness.p.kind == PIR_FEATURE_EDGE)
            apart = fmin(apart, fabs(reach_along(piece[0], moved, n) + reach_along(piece[1], input->pose_q, back)));
        expect(apart <= room, "facet %u: %g apart at the place", i, apart);
        // P, moved, and Q touch at the points
        const pir_vec3 at = answer->point_q;
        const pir_vec3 of_q = test_turn(input->pose_q.rotation, test_add(at, input->pose_q.translation, -1), -1);
        const pir_vec3 of_p = test_turn(moved.rotation, test_add(at, moved.translation, -1), -1);
        if (i == 0) {
            expect(outside_of(piece[0], of_p) <= room && outside_of(piece[1], of_q) <= room,
                   "the points are %g and %g outside", outside_of(piece[0], of_p), outside_of(piece[1], of_q));
            expect(test_length(test_add(test_add(answer->point_p, way, 1), at, -1)) <= room, "the points differ");
        }
        pir_polytope_release(piece[0]);
        pir_polytope_release(piece[1]);
    }
}

static pir_vec3 scaled(pir_vec3 v, double s) {
    return (pir_vec3){s * v.x, s * v.y, s * v.z};
}

/* --- unions of cubes --- */

/* The middles of the cubes of the difference, whose sides are 2. */
struct lattice {
    bool middle[2 * CELLS + 1][2 * CELLS + 1][2 * CELLS + 1];
};

static struct lattice lattice_of(const cells *p, const cells *q) {
    struct lattice made = {0};
    const int all = CELLS * CELLS * CELLS;
    for (int i = 0; i < all; i++)
        for (int j = 0; j < all; j++)
            if (p->full[i % CELLS][i / CELLS % CELLS][i / CELLS / CELLS] &&
                q->full[j % CELLS][j / CELLS % CELLS][j / CELLS / CELLS])
                made.middle[CELLS + j % CELLS - i % CELLS][CELLS + j / CELLS % CELLS - i / CELLS % CELLS]
                           [CELLS + j / CELLS / CELLS - i / CELLS / CELLS] = true;
    return made;
}

static bool has_middle(const struct lattice *of, int x, int y, int z) {
    const int most = 2 * CELLS;
    return x >= 0 && y >= 0 && z >= 0 && x <= most && y <= most && z <= most && of->middle[x][y][z];
}

/* Whether a point, in units with CELLS added, is inside of a cube. */
static bool is_within(const struct lattice *of, const double x[3]) {
    const int low[3] = {(int)floor(x[0]), (int)floor(x[1]), (int)floor(x[2])};
    for (int k = 0; k < 8; k++) {
        const int c[3] = {low[0] + (k & 1), low[1] + (k >> 1 & 1), low[2] + (k >> 2)};
        if (fabs(x[0] - c[0]) < 1 && fabs(x[1] - c[1]) < 1 && fabs(x[2] - c[2]) < 1 && has_middle(of, c[0], c[1], c[2]))
            return true;
    }
    return false;
}

/* The square of the distance from a point to what no cube holds inside: by all cells of twice the lattice, a cell being
 * a corner, an edge, a side or the inside of a cube; exact for short numbers. */
static double square_to_free(const struct lattice *of, const double x[3]) {
    double least = HUGE_VAL;
    for (int i = -4; i <= 4 * CELLS + 4; i++)
        for (int j = -4; j <= 4 * CELLS + 4; j++)
            for (int k = -4; k <= 4 * CELLS + 4; k++) {
                const int cell[3] = {i, j, k};
                double middle[3], square = 0;
                for (int a = 0; a < 3; a++) {
                    // even: the point cell/2; odd: what is between the points beside it
                    const double half = cell[a] % 2 ? 0.5 : 0, away = fabs(x[a] - cell[a] / 2.0) - half;
                    middle[a] = cell[a] / 2.0;
                    square += away > 0 ? away * away : 0;
                }
                if (square < least && !is_within(of, middle))
                    least = square;
            }
    return least;
}

static void depths_of_cubes_are_those_of_the_lattice(void **state) {
    (void)state;
    unsigned seen[4] = {0}, inside = 0;
    for (uint64_t i = 0; i < solid_cases(6); i++) {
        test_random random = test_random_case("depths of cubes", i);
        const cells p = cells_random(&random, 1 + test_random_below(&random, 12));
        const cells q = cells_random(&random, 2 + test_random_below(&random, 30));
        pir_solid *of_p = solid_of_cells(&p), *of_q = solid_of_cells(&q);
        struct scene scene = scene_of(of_p, of_q);
        const struct lattice lattice = lattice_of(&p, &q);
        for (int n = 0; n < PLACES; n++) {
            // multiples of 1/2 and of 1/8: many ties
            const int step = n % 2 ? 2 : 8;
            pir_pair_input input = pir_pair_input_default();
            pir_solid_depth depth;
            double x[3];
            for (int k = 0; k < 3; k++)
                x[k] = test_random_between(&random, -3 * step, 3 * step) / (double)step;
            input.pose_p.translation = (pir_vec3){x[0], x[1], x[2]};
            for (int k = 0; k < 3; k++)
                x[k] += CELLS;
            assert_int_equal(pir_solid_query_depth(scene.query, scene.workspace, &input, &depth), PIR_OK);
            const bool within = is_within(&lattice, x);
            expect((depth.state == PIR_INSIDE) == within, "case %llu, place %d: state %d", (unsigned long long)i, n,
                   (int)depth.state);
            if (!within) {
                assert_true(depth.depth == 0 && depth.facets == 0);
                continue;
            }
            const double right = sqrt(square_to_free(&lattice, x));
            expect(fabs(depth.depth - right) <= 1e-15 * scene.size, "case %llu, place %d: depth %.17g, not %.17g",
                   (unsigned long long)i, n, depth.depth, right);
            check_answer(&scene, &input, &depth, scaled(depth.normal, depth.depth));
            const double end[3] = {x[0] + depth.depth * depth.normal.x, x[1] + depth.depth * depth.normal.y,
                                   x[2] + depth.depth * depth.normal.z};
            // the place is free, as far as doubles can say
            assert_true(depth.facets > 1 || !is_within(&lattice, end));
            seen[depth.facets]++;
            inside++;
        }
        scene_finish(&scene);
        pir_solid_release(of_q);
        pir_solid_release(of_p);
    }
    printf("%u inside: %u on one facet, %u on edges, %u at corners\n", inside, seen[1], seen[2], seen[3]);
    assert_true(seen[1] > 0 && seen[2] > 0);
}

static void ways_out_of_cubes_are_those_of_the_lattice(void **state) {
    (void)state;
    unsigned inside = 0;
    for (uint64_t i = 0; i < solid_cases(6); i++) {
        test_random random = test_random_case("ways out of cubes", i);
        const cells p = cells_random(&random, 1 + test_random_below(&random, 12));
        const cells q = cells_random(&random, 2 + test_random_below(&random, 30));
        pir_solid *of_p = solid_of_cells(&p), *of_q = solid_of_cells(&q);
        struct scene scene = scene_of(of_p, of_q);
        const struct lattice lattice = lattice_of(&p, &q);
        for (int n = 0; n < PLACES; n++) {
            pir_pair_input input = pir_pair_input_default();
            pir_solid_depth depth;
            double x[3], way[3] = {0}, far = 0;
            const int axis = n % 3, sign = n % 2 ? 1 : -1;
            for (int k = 0; k < 3; k++)
                x[k] = test_random_between(&random, -6, 6) / 2.0;
            input.pose_p.translation = (pir_vec3){x[0], x[1], x[2]};
            for (int k = 0; k < 3; k++)
                x[k] += CELLS;
            way[axis] = sign * 0.75;
            assert_int_equal(pir_solid_query_directional_depth(scene.query, scene.workspace, &input,
                                                               (pir_vec3){way[0], way[1], way[2]}, &depth),
                             PIR_OK);
            const bool within = is_within(&lattice, x);
            assert_true((depth.state == PIR_INSIDE) == within);
            if (!within)
                continue;
            const double from = x[axis];
            for (; is_within(&lattice, x); far += 0.5)
                x[axis] = from + sign * (far + 0.5);
            expect(fabs(depth.depth - far) <= 1e-15 * scene.size, "case %llu, place %d: %.17g, not %.17g",
                   (unsigned long long)i, n, depth.depth, far);
            assert_true(depth.facets == 1);
            way[axis] = sign * depth.depth;
            check_answer(&scene, &input, &depth, (pir_vec3){way[0], way[1], way[2]});
            inside++;
        }
        scene_finish(&scene);
        pir_solid_release(of_q);
        pir_solid_release(of_p);
    }
    printf("%u ways\n", inside);
    assert_true(inside > 0);
}

/* --- the exact difference --- */

static double square_to_segment(pir_vec3 a, pir_vec3 b, pir_vec3 t) {
    const pir_vec3 way = test_add(b, a, -1), to = test_add(t, a, -1);
    const double s = fmin(1, fmax(0, test_dot(to, way) / test_dot(way, way)));
    return test_dot(test_add(to, way, -s), test_add(to, way, -s));
}

/* The normal of a facet, twice as long as its area. */
static pir_vec3 normal_of(const pir_vec3 *x, const uint32_t *corner, uint32_t count) {
    pir_vec3 sum = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < count; i++)
        sum = test_add(
            sum, test_cross(test_add(x[corner[i]], x[corner[0]], -1), test_add(x[corner[i + 1]], x[corner[0]], -1)), 1);
    return sum;
}

/* How often a facet goes round a point of its plane, times 2π. */
static double turns_of(const pir_vec3 *x, const uint32_t *corner, uint32_t count, pir_vec3 n, pir_vec3 at) {
    double turns = 0;
    for (uint32_t i = 0; i < count; i++) {
        const pir_vec3 a = test_add(x[corner[i]], at, -1), b = test_add(x[corner[i + 1 < count ? i + 1 : 0]], at, -1);
        turns += atan2(test_dot(n, test_cross(a, b)) / test_length(n), test_dot(a, b));
    }
    return turns;
}

/* The distance from t to what bounds the difference of the open bodies, and the first of it along a direction. */
static double look(const pir_mesh *mesh, pir_vec3 t, pir_vec3 way, double *ret_first) {
    const pir_vec3 *x = pir_mesh_vertices(mesh);
    double least = HUGE_VAL;
    *ret_first = HUGE_VAL;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        const pir_vec3 n = normal_of(x, corner, count);
        const double away = test_dot(n, test_add(t, x[corner[0]], -1)), size = test_dot(n, n);
        for (uint32_t i = 0; i < count; i++)
            least = fmin(least, square_to_segment(x[corner[i]], x[corner[i + 1 < count ? i + 1 : 0]], t));
        if (away * away / size < least && turns_of(x, corner, count, n, test_add(t, n, -away / size)) > acos(-1))
            least = away * away / size;
        const double s = -away / test_dot(n, way);
        if (s > 0 && s < *ret_first && turns_of(x, corner, count, n, test_add(t, way, s)) > acos(-1))
            *ret_first = s;
    }
    uint32_t segments, points;
    const uint32_t *segment = pir_mesh_segments(mesh, &segments), *point = pir_mesh_points(mesh, &points);
    for (uint32_t i = 0; i < segments; i++)
        least = fmin(least, square_to_segment(x[segment[2 * i]], x[segment[2 * i + 1]], t));
    for (uint32_t i = 0; i < points; i++)
        least = fmin(least, test_dot(test_add(x[point[i]], t, -1), test_add(x[point[i]], t, -1)));
    return sqrt(least);
}

struct tally {
    uint64_t inside, facets[4];
    double worst;
};

/* A place about the origin, near a vertex of the difference, or between two of them. */
static pir_vec3 place_of(const pir_mesh *mesh, test_random *random, int n) {
    const pir_vec3 *x = pir_mesh_vertices(mesh);
    const uint32_t count = pir_mesh_vertex_count(mesh);
    const pir_vec3 a = x[test_random_below(random, count)], b = x[test_random_below(random, count)];
    const pir_vec3 c = x[test_random_below(random, count)];
    if (n % 3 == 0)
        return scaled(test_add(a, b, 1), 0.5);
    if (n % 3 == 1)
        return test_add(scaled(a, 0.875), c, 0.125);
    return scaled(test_add(test_add(a, b, 1), c, 1), 1.0 / 3);
}

static void compare(struct scene *scene, const pir_mesh *mesh, pir_quat rotation, test_random *random,
                    struct tally *tally) {
    for (int n = 0; n < PLACES; n++) {
        pir_pair_input input = pir_pair_input_default();
        pir_solid_depth depth, along;
        const pir_vec3 t = place_of(mesh, random, n), way = test_random_direction(random);
        pir_vec3 turned = way;
        double first;
        input.pose_p = (pir_pose){rotation, t};
        if (n % 2) {
            // the same place, seen from a world in which Q is turned by a right angle
            const pir_pose world = {{0, 0, 1, 1}, {0, 0, 0}};
            input.pose_p = pir_pose_compose(world, input.pose_p);
            input.pose_q = world;
            turned = test_turn(world.rotation, way, 1);
        }
        assert_int_equal(pir_solid_query_depth(scene->query, scene->workspace, &input, &depth), PIR_OK);
        if (depth.state != PIR_INSIDE)
            continue;
        const double right = look(mesh, t, way, &first), off = fabs(depth.depth - right) / scene->size;
        expect(off <= 1e-12, "place %d: depth %.17g, not %.17g", n, depth.depth, right);
        check_answer(scene, &input, &depth, scaled(depth.normal, depth.depth));
        assert_int_equal(pir_solid_query_directional_depth(scene->query, scene->workspace, &input, turned, &along),
                         PIR_OK);
        // at the boundary the oracle does not tell which way is out
        expect(right < 1e-9 * scene->size || fabs(along.depth - first) <= 1e-9 * scene->size,
               "place %d: %.17g along a direction, not %.17g", n, along.depth, first);
        check_answer(scene, &input, &along, scaled(turned, along.depth));
        tally->worst = fmax(tally->worst, off);
        tally->facets[depth.facets]++;
        tally->inside++;
    }
}

static void compare_all(const pir_solid *p, const pir_solid *q, const char *name, uint64_t rotations) {
    static const pir_quat aligned[] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}, {0, 0, 1, 2}};
    struct scene scene = scene_of(p, q);
    struct tally tally = {0};
    for (uint64_t i = 0; i < rotations; i++) {
        test_random random = test_random_case(name, i);
        pir_solid_sum_options options = pir_solid_sum_options_default();
        pir_mesh *mesh = NULL;
        const pir_vec3 axis = test_random_direction(&random);
        const pir_quat any = {axis.x, axis.y, axis.z, test_random_unit(&random)};
        const pir_quat rotation = i % 3 == 2 ? aligned[test_random_below(&random, 4)] : any;
        options.difference = options.open = true;
        assert_int_equal(solid_sum_mesh(p, q, rotation, &options, NULL, &mesh), PIR_OK);
        compare(&scene, mesh, rotation, &random, &tally);
        pir_mesh_destroy(mesh);
    }
    printf("%s: %llu inside, %llu on a facet, %llu on edges, %llu at corners, off by %.2g of the size at most\n", name,
           (unsigned long long)tally.inside, (unsigned long long)tally.facets[1], (unsigned long long)tally.facets[2],
           (unsigned long long)tally.facets[3], tally.worst);
    scene_finish(&scene);
}

static void depths_are_those_of_the_exact_difference(void **state) {
    (void)state;
    cells ell = {0};
    ell.full[0][0][0] = ell.full[1][0][0] = ell.full[2][0][0] = ell.full[0][1][0] = true;
    pir_solid *l = solid_of_cells(&ell);
    compare_all(l, l, "two Ls", solid_cases(6));
    pir_solid_release(l);
    static const char *const names[][2] = {
        {"clamp", "frame"}, {"cube", "case"}, {"gear8", "star5"}, {"mushroom6", "cup"}};
    // the last takes minutes
    for (size_t i = 0; i < sizeof names / sizeof *names - !getenv("PIR_TEST_CASES"); i++) {
        pir_solid *p = solid_model_new(names[i][0], 1), *q = solid_model_new(names[i][1], 1);
        assert_true(p && q);
        compare_all(p, q, names[i][0], solid_cases(i < 2 ? 6 : 2));
        pir_solid_release(q);
        pir_solid_release(p);
    }
}

/* --- a motion --- */

enum { FRAMES = 60 };

/* Two bodies of a motion at 1/500 of a turn a frame; the depths of all frames. */
static void follow(pir_solid_query *query, pir_workspace *workspace, pir_solid_depth ret_depths[FRAMES]) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = (pir_pose){{0.25, -0.5, 0.125, 1}, {1.25, 0.75, 0.5}};
    for (int i = 0; i < FRAMES; i++) {
        input.pose_p =
            pir_pose_integrate(input.pose_p, (pir_vec3){0.003, 0.001, -0.002}, (pir_vec3){0.009, 0.007, -0.005}, 1);
        assert_int_equal(pir_solid_query_depth(query, workspace, &input, &ret_depths[i]), PIR_OK);
        assert_true(ret_depths[i].state == PIR_INSIDE);
    }
}

static bool are_same(const pir_solid_depth *a, const pir_solid_depth *b) {
    return memcmp(&a->depth, &b->depth, sizeof a->depth) == 0 &&
           memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 &&
           memcmp(&a->point_p, &b->point_p, sizeof a->point_p) == 0 &&
           memcmp(&a->point_q, &b->point_q, sizeof a->point_q) == 0 && a->facets == b->facets &&
           memcmp(a->facet, b->facet, a->facets * sizeof *a->facet) == 0;
}

/* A query that is kept allocates nothing when it goes through a motion again, and the way back has the same bits. */
static void a_kept_query_allocates_nothing_and_has_the_bits_of_a_new_one(void **state) {
    (void)state;
    cells ell = {0};
    ell.full[0][0][0] = ell.full[1][0][0] = ell.full[2][0][0] = ell.full[0][1][0] = true;
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    pir_solid *l = solid_of_cells(&ell);
    pir_pieces *pieces = NULL;
    pir_solid_query *query = NULL;
    pir_workspace *workspace = NULL;
    static pir_solid_depth first[FRAMES], again[FRAMES], single;
    assert_int_equal(pir_solid_decompose(l, NULL, NULL, &pieces), PIR_OK);
    assert_int_equal(pir_workspace_create(&allocator, &workspace), PIR_OK);
    assert_int_equal(pir_solid_query_create(pieces, pieces, &allocator, &query), PIR_OK);
    follow(query, workspace, first);
    const uint64_t requests = memory.requests;
    follow(query, workspace, again);
    assert_int_equal(memory.requests, requests);
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = (pir_pose){{0.25, -0.5, 0.125, 1}, {1.25, 0.75, 0.5}};
    for (int i = 0; i < FRAMES; i++) {
        pir_solid_query *fresh = NULL;
        input.pose_p =
            pir_pose_integrate(input.pose_p, (pir_vec3){0.003, 0.001, -0.002}, (pir_vec3){0.009, 0.007, -0.005}, 1);
        assert_int_equal(pir_solid_query_create(pieces, pieces, NULL, &fresh), PIR_OK);
        assert_int_equal(pir_solid_query_depth(fresh, workspace, &input, &single), PIR_OK);
        assert_true(are_same(&first[i], &single) && are_same(&again[i], &single));
        pir_solid_query_destroy(fresh);
    }
    pir_solid_query_destroy(query);
    pir_workspace_destroy(workspace);
    pir_pieces_destroy(pieces);
    pir_solid_release(l);
    assert_true(memory.blocks == 0 && !memory.wrong_size);
}

/* --- histories --- */

/* The next pose of a history: the body rests, slides, turns by a little about its middle or back again, or is
 * elsewhere; by aligned rotations and multiples of 1/8 at times. */
static pir_pose moved(test_random *random, pir_pose pose, pir_pose before) {
    const double step = ldexp(1, test_random_between(random, -40, -3));
    const pir_vec3 way = test_random_direction(random), axis = test_random_direction(random);
    const pir_vec3 slide = {step * way.x, step * way.y, step * way.z},
                   turn = {step * axis.x, step * axis.y, step * axis.z};
    const pir_vec3 none = {0, 0, 0};
    switch (test_random_below(random, 16)) {
    case 0:
        return pose;
    case 1:
        return before;
    case 2:
        pose.rotation = (pir_quat){0, 0, test_random_below(random, 2) == 0, 1};
        pose.translation = (pir_vec3){rint(8 * pose.translation.x) / 8, rint(8 * pose.translation.y) / 8,
                                      rint(8 * pose.translation.z) / 8};
        return pose;
    case 3:
        pose.rotation = (pir_quat){axis.x, axis.y, axis.z, test_random_unit(random)};
        return pose;
    case 4:
    case 5:
        return pir_pose_integrate(pose, slide, none, 1);
    case 6:
    case 7:
        return pir_pose_integrate(pose, none, turn, 1);
    default:
        return pir_pose_integrate(pose, slide, (pir_vec3){0.01 * axis.x, 0.01 * axis.y, 0.01 * axis.z}, 1);
    }
}

/* Whatever a query was asked before, its answers have the bits of a new one. */
static void histories_leave_no_trace(void **state) {
    (void)state;
    static const char *const names[][2] = {{"ell", "ell"}, {"clamp", "frame"}, {"star5", "ell"}, {"gear8", "star5"}};
    for (uint64_t i = 0; i < solid_cases(4); i++) {
        test_random random = test_random_case("histories", i);
        pir_solid *p = solid_model_new(names[i % 4][0], i % 4 == 2 ? 2 : 1), *q = solid_model_new(names[i % 4][1], 1);
        struct scene kept = scene_of(p, q), fresh = scene_of(p, q);
        const pir_vec3 at = test_random_direction(&random);
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = (pir_pose){{0, 0, 0, 1}, {at.x / 4 * kept.size, at.y / 8 * kept.size, at.z / 8 * kept.size}};
        pir_pose before = input.pose_p;
        for (int frame = 0; frame < 60; frame++) {
            const pir_pose next = moved(&random, input.pose_p, before);
            pir_solid_depth one = {0}, other = {0};
            before = input.pose_p;
            input.pose_p = next;
            pir_solid_query_destroy(fresh.query);
            assert_int_equal(pir_solid_query_create(fresh.pieces[0], fresh.pieces[1], NULL, &fresh.query), PIR_OK);
            assert_int_equal(pir_solid_query_depth(kept.query, kept.workspace, &input, &one), PIR_OK);
            assert_int_equal(pir_solid_query_depth(fresh.query, fresh.workspace, &input, &other), PIR_OK);
            if (one.state != other.state || !are_same(&one, &other))
                fail_msg("case %llu, %s and %s, frame %d", (unsigned long long)i, names[i % 4][0], names[i % 4][1],
                         frame);
            if (test_random_below(&random, 8) == 0 && one.state == PIR_INSIDE)
                assert_int_equal(pir_solid_query_directional_depth(kept.query, kept.workspace, &input, at, &one),
                                 PIR_OK);
            if (one.state != PIR_INSIDE)
                input.pose_p.translation = (pir_vec3){0.125, 0.25, 0.0625};
        }
        scene_finish(&kept);
        scene_finish(&fresh);
        pir_solid_release(p);
        pir_solid_release(q);
    }
}

static void directions_that_are_none_are_refused(void **state) {
    (void)state;
    cells cube = {0};
    cube.full[0][0][0] = true;
    pir_solid *p = solid_of_cells(&cube);
    struct scene scene = scene_of(p, p);
    pir_pair_input input = pir_pair_input_default();
    pir_solid_depth depth = {.depth = 7};
    const pir_vec3 zero = {0, 0, 0}, none = {0, NAN, 1}, far = {HUGE_VAL, 0, 0}, tiny = {0, 0, -5e-324};
    input.pose_p.translation.z = 0.25;
    pir_solid_query *query = scene.query;
    pir_workspace *workspace = scene.workspace;
    assert_int_equal(pir_solid_query_directional_depth(query, workspace, &input, zero, &depth), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_query_directional_depth(query, workspace, &input, none, &depth), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_solid_query_directional_depth(query, workspace, &input, far, &depth), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_solid_query_depth(NULL, workspace, &input, &depth), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_query_depth(query, workspace, &input, NULL), PIR_ERR_ARGUMENT);
    assert_true(depth.depth == 7);
    // the direction may be as short as a double is
    assert_int_equal(pir_solid_query_directional_depth(query, workspace, &input, tiny, &depth), PIR_OK);
    assert_true(depth.depth == 1.25 && depth.normal.z == -1);
    scene_finish(&scene);
    pir_solid_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depths_of_cubes_are_those_of_the_lattice),
        cmocka_unit_test(ways_out_of_cubes_are_those_of_the_lattice),
        cmocka_unit_test(depths_are_those_of_the_exact_difference),
        cmocka_unit_test(a_kept_query_allocates_nothing_and_has_the_bits_of_a_new_one),
        cmocka_unit_test(histories_leave_no_trace),
        cmocka_unit_test(directions_that_are_none_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

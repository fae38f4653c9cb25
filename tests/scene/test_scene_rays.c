/* SPDX-License-Identifier: MIT */
/*
 * Rays in scenes of boxes, flat pieces, segments, points, balls, capsules and compounds against an oracle that asks
 * every piece: what is met, when, and that nothing is met before. Half of the scenes stand on a grid, where rays lie in
 * planes, along edges and through corners. PIR_TEST_RAYS is how many.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include <pirouette/scene_query.h>

#include "scene/ray_oracle.h"
#include "support/bodies.h"
#include "support/vectors.h"

#define BODIES 10
#define PIECES 2
#define RAYS   16
/* Times that differ by less are taken for the same one. */
#define SAME 1e-11

struct room {
    test_random random;
    bool grid;
    pir_scene *scene;
    pir_polytope *piece[BODIES][PIECES];
    ray_oracle *oracle[BODIES][PIECES];
    double radius[BODIES];
    uint32_t pieces[BODIES];
};

static pir_vec3 place(struct room *room) {
    double x = 3 * test_random_unit(&room->random), y = 3 * test_random_unit(&room->random),
           z = 3 * test_random_unit(&room->random);
    return room->grid ? (pir_vec3){rint(x), rint(y), rint(z)} : (pir_vec3){x, y, z};
}

static pir_polytope *random_piece(struct room *room) {
    static const test_body kinds[8] = {TEST_BOX,     TEST_OCTAHEDRON, TEST_GRID,  TEST_POLYGON,
                                       TEST_POLYGON, TEST_SEGMENT,    TEST_POINT, TEST_SPHERE};
    test_points points;
    test_body_points(&room->random, kinds[test_random_below(&room->random, 8)], 10, &points);
    double most = 0;
    for (size_t i = 0; i < points.count; i++)
        most = fmax(most, test_length(points.at[i]));
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = test_add(test_zero, points.at[i], most > 2 ? ldexp(1, -ilogb(most)) : 1);
    return test_polytope(&points);
}

static void room_init(struct room *room, uint64_t number) {
    *room = (struct room){.random = test_random_case("rays", number), .grid = number % 2 == 0};
    assert_int_equal(pir_scene_create(NULL, &room->scene), PIR_OK);
    for (uint32_t b = 0; b < BODIES; b++) {
        pir_body_options body = pir_body_options_default();
        uint32_t id;
        bool turned = test_random_below(&room->random, 2);
        body.pose.rotation = !turned      ? (pir_quat){0, 0, 0, 1}
                             : room->grid ? test_integer_rotation(&room->random)
                                          : test_general_rotation(&room->random);
        body.pose.translation = place(room);
        room->radius[b] = test_random_below(&room->random, 3) ? 0
                          : room->grid                        ? 0.5
                                                              : 0.01 + fabs(test_random_unit(&room->random));
        body.radius = room->radius[b];
        room->pieces[b] = body.piece_count = 1 + (test_random_below(&room->random, 3) == 0);
        for (uint32_t k = 0; k < body.piece_count; k++) {
            room->piece[b][k] = random_piece(room);
            room->oracle[b][k] = ray_oracle_new(room->piece[b][k], body.pose, body.radius);
        }
        body.pieces = room->piece[b];
        assert_int_equal(pir_scene_add(room->scene, &body, &id), PIR_OK);
        assert_int_equal(id, b);
    }
}

static void room_finish(struct room *room) {
    pir_scene_destroy(room->scene);
    for (uint32_t b = 0; b < BODIES; b++)
        for (uint32_t k = 0; k < room->pieces[b]; k++) {
            ray_oracle_free(room->oracle[b][k]);
            pir_polytope_release(room->piece[b][k]);
        }
}

/* A point of the plane of a flat piece, in small multiples of its sides: on a grid it is in the plane exactly. */
static pir_vec3 in_plane(struct room *room, const pir_polytope *flat, pir_vec3 at) {
    double i = test_random_between(&room->random, -3, 3), j = test_random_between(&room->random, -3, 3);
    pir_vec3 a = pir_polytope_vertex(flat, 0), b = pir_polytope_vertex(flat, 1), c = pir_polytope_vertex(flat, 2);
    pir_vec3 along = test_add(test_add(a, test_add(b, a, -1), i), test_add(c, a, -1), j);
    return test_add(along, at, 1);
}

/* A ray in the plane of a flat piece, if one stands upright. */
static bool ray_in_plane(struct room *room, pir_vec3 *origin, pir_vec3 *way) {
    uint32_t from = test_random_below(&room->random, BODIES);
    for (uint32_t i = 0; i < BODIES; i++) {
        uint32_t b = (from + i) % BODIES;
        pir_pose pose;
        assert_int_equal(pir_scene_pose(room->scene, b, &pose), PIR_OK);
        if (pose.rotation.w != 1 || pir_polytope_dimension(room->piece[b][0]) != 2)
            continue;
        *origin = in_plane(room, room->piece[b][0], pose.translation);
        *way = test_add(in_plane(room, room->piece[b][0], pose.translation), *origin, -1);
        return test_length(*way) > 0;
    }
    return false;
}

/* Along lines of the grid, between points of it, in planes, or anywhere. */
static void random_ray(struct room *room, pir_vec3 *origin, pir_vec3 *way) {
    if (test_random_below(&room->random, 3) == 0 && ray_in_plane(room, origin, way))
        return;
    *origin = test_add(test_zero, place(room), 2);
    pir_vec3 to = place(room);
    *way = test_add(to, *origin, -1);
    if (test_random_below(&room->random, 3) == 0) {
        double *c[3] = {&way->x, &way->y, &way->z};
        uint32_t keep = test_random_below(&room->random, 3);
        for (uint32_t k = 0; k < 3; k++)
            *c[k] = k == keep ? *c[k] * 3 : 0;
    }
    if (test_length(*way) == 0)
        way->x = 1;
}

struct counts {
    uint64_t rays, hits, flat, rounded;
};

/* The first of all pieces by the oracle; where it cannot tell, `unsure` is set. */
static double first_of(const struct room *room, pir_vec3 origin, pir_vec3 way, bool *unsure) {
    double first = HUGE_VAL;
    for (uint32_t b = 0; b < BODIES; b++)
        for (uint32_t k = 0; k < room->pieces[b]; k++) {
            ray_verdict verdict = ray_oracle_ask(room->oracle[b][k], origin, way);
            *unsure |= verdict.hits < 0;
            first = fmin(first, verdict.hits == 1 ? verdict.time : HUGE_VAL);
        }
    return first;
}

static void check_ray(struct room *room, uint64_t number, struct counts *counts) {
    unsigned long long n = number;
    pir_vec3 origin, way;
    pir_impact impact;
    bool unsure = false;
    random_ray(room, &origin, &way);
    assert_int_equal(pir_scene_ray(room->scene, origin, way, UINT32_MAX, &impact), PIR_OK);
    double first = first_of(room, origin, way, &unsure);
    counts->rays++;
    if (impact.body == PIR_SCENE_NONE) {
        expect(unsure || first == HUGE_VAL, "ray %llu misses what is met at %.17g", n, first);
        expect(impact.outcome == PIR_CAST_MISS && impact.time == 1, "ray %llu", n);
        return;
    }
    const ray_oracle *met = room->oracle[impact.body][impact.piece_q];
    ray_verdict verdict = ray_oracle_ask(met, origin, way);
    counts->hits++;
    expect(verdict.hits != 0, "ray %llu meets body %u, which it does not", n, impact.body);
    expect(fabs(test_length(impact.normal) - 1) < 1e-12, "ray %llu: the normal is %g long", n,
           test_length(impact.normal));
    expect(impact.time == 0 || test_dot(impact.normal, way) < 1e-9, "ray %llu leaves by the normal", n);
    if (room->radius[impact.body] > 0) {
        // times on a rounded body that is grazed have few bits: the place has all of them
        double height = ray_oracle_height(met, impact.point);
        expect(height < 1e-11 && (impact.time == 0 || height > -1e-11), "ray %llu ends at height %g", n, height);
        expect(unsure || (impact.time < first + 1e-7 && impact.time > first - 1e-7), "ray %llu at %g, first at %g", n,
               impact.time, first);
        counts->rounded++;
        return;
    }
    expect(fabs(impact.time - verdict.time) < SAME, "ray %llu meets body %u at %.17g, not at %.17g", n, impact.body,
           impact.time, verdict.time);
    expect(unsure || impact.time < first + SAME, "ray %llu is met at %.17g, before %.17g", n, first, impact.time);
    counts->flat += pir_polytope_dimension(room->piece[impact.body][impact.piece_q]) == 2;
}

static void rays_meet_what_the_oracle_says_first(void **state) {
    (void)state;
    const char *text = getenv("PIR_TEST_RAYS");
    uint64_t rays = text ? strtoull(text, NULL, 10) : 4000;
    struct counts counts = {0};
    for (uint64_t number = 0; counts.rays < rays; number++) {
        struct room room;
        room_init(&room, number);
        for (uint64_t i = 0; i < RAYS; i++)
            check_ray(&room, number * RAYS + i, &counts);
        room_finish(&room);
    }
    print_message("%llu rays, %llu hits, %llu of flat pieces, %llu of rounded bodies\n",
                  (unsigned long long)counts.rays, (unsigned long long)counts.hits, (unsigned long long)counts.flat,
                  (unsigned long long)counts.rounded);
    assert_true(counts.hits > rays / 8 && counts.flat > rays / 200 && counts.rounded > rays / 16);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_meet_what_the_oracle_says_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

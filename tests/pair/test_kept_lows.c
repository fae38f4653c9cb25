/* SPDX-License-Identifier: MIT */
/*
 * Distances that a surface keeps from placement to placement: where they say that all triangles but some are farther
 * from x than a facet, the nearest points of these triangles are, and the surface goes around x. Both are found here
 * from the corners alone: by a triangle's vertices, sides and foot, and by the solid angles that triangles fill.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/processor.h"
#include "pair/surface/kept_lows.h"
#include "support/bodies.h"
#include "support/vectors.h"

enum { POINTS = 30, STEPS = 60, CASES = 200 };

/* Points near a sphere, as a body P about a body Q that is a point, and x. */
struct scene {
    pir_vec3 vertex[POINTS];
    pir_frame frame;
    pir_placement placement;
    pir_quat rotation;
    pir_surface surface;
    pir_surface_room room;
};

static void set_rotation(struct scene *scene, pir_quat q) {
    const double by = 1 / sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    scene->frame.unit = scene->rotation = (pir_quat){q.x * by, q.y * by, q.z * by, q.w * by};
    for (int k = 0; k < 3; k++) {
        pir_vec3 e = test_turn(q, (pir_vec3){k == 0, k == 1, k == 2}, 1);
        scene->frame.r.m[0][k] = e.x;
        scene->frame.r.m[1][k] = e.y;
        scene->frame.r.m[2][k] = e.z;
    }
}

static bool place(struct scene *scene) {
    const pir_placement *at = &scene->placement;
    return pir_surface_place(&scene->surface, &scene->frame, at->x, at->error, at->reach, &scene->room);
}

static void set_x(struct scene *scene, pir_vec3 x) {
    scene->placement = (pir_placement){.x = x, .reach = 1.25 + test_length(x)};
    scene->placement.error = PIR_SLACK_BOUND * scene->placement.reach;
}

/* A surface about x, of most of the points. */
static void make_scene(test_random *random, struct scene *scene, pir_surface_room *room) {
    static pir_vec3 of_q[2]; // one more: loops read past the last
    static const pir_vec3 first[4] = {{.7, .7, .7}, {-.7, -.7, .7}, {.7, -.7, -.7}, {-.7, .7, -.7}};
    memset(&scene->surface, 0, sizeof scene->surface);
    scene->frame.p.vertex = scene->vertex;
    scene->frame.q.vertex = of_q;
    scene->frame.p.size = 1.25;
    for (int k = 0; k < POINTS; k++)
        scene->vertex[k] = k < 4 ? first[k] : test_random_direction(random);
    set_x(scene, (pir_vec3){0, 0, 0});
    set_rotation(scene, (pir_quat){0, 0, 0, 1});
    pir_surface_begin(&scene->surface, (const uint32_t[4]){0, 1, 2, 3}, (const uint32_t[4]){0, 0, 0, 0});
    assert_true(place(scene));
    for (uint32_t k = 4; k < POINTS && pir_surface_has_room(&scene->surface); k++)
        for (uint32_t t = 0; t < scene->surface.count; t++)
            if (pir_vec_dot(pir_surface_normal(room, t), scene->vertex[k]) > room->plane.det[t]) {
                pir_surface_add(&scene->surface, t, &(pir_surface_vertex){k, 0, scene->vertex[k]}, room);
                break;
            }
}

/* --- what is so, from the corners --- */

static void corners_of(const struct scene *scene, uint32_t t, pir_vec3 at[3]) {
    for (int k = 0; k < 3; k++) {
        const pir_vec3 v = scene->vertex[scene->surface.a[scene->surface.corner[k][t]]];
        at[k] = test_add(test_turn(scene->rotation, v, 1), scene->placement.x, -1);
    }
}

/* The distance of the origin from a triangle. */
static double distance_of(const pir_vec3 at[3]) {
    const pir_vec3 n = test_cross(test_add(at[1], at[0], -1), test_add(at[2], at[0], -1));
    bool within = true;
    double least = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const pir_vec3 a = at[k], way = test_add(at[(k + 1) % 3], a, -1);
        const double part = fmin(1, fmax(0, -test_dot(a, way) / test_dot(way, way)));
        least = fmin(least, test_length(test_add(a, way, part)));
        // the foot is on the inner side of each side's plane along n
        within = within && test_dot(test_cross(n, way), a) <= 0;
    }
    return within ? fmin(least, fabs(test_dot(n, at[0])) / test_length(n)) : least;
}

/* The solid angle of a triangle as the origin sees it (Van Oosterom and Strackee, 1983). */
static double angle_of(const pir_vec3 at[3]) {
    const double a = test_length(at[0]), b = test_length(at[1]), c = test_length(at[2]);
    const double whole =
        a * b * c + test_dot(at[0], at[1]) * c + test_dot(at[1], at[2]) * a + test_dot(at[2], at[0]) * b;
    return 2 * atan2(test_dot(at[0], test_cross(at[1], at[2])), whole);
}

static void check_stays(const struct scene *scene, double slack, uint64_t of_facet, unsigned long long number) {
    double around = 0;
    for (uint32_t t = 0; t < scene->surface.count; t++) {
        pir_vec3 at[3];
        corners_of(scene, t, at);
        around += angle_of(at);
        expect(of_facet >> t & 1 || distance_of(at) > slack, "case %llu: triangle %u is %.17g away, not %.17g", number,
               t, distance_of(at), slack);
    }
    expect(fabs(around / (4 * acos(-1.0)) - 1) < 1e-9, "case %llu: around by %g", number, around);
}

/* --- motions --- */

/* Moves by a 16th to a 16384th. */
static void move(test_random *random, struct scene *scene) {
    const double step = ldexp(1, -test_random_between(random, 4, 14));
    const pir_vec3 d = test_random_direction(random), e = test_random_direction(random);
    const pir_quat q = scene->rotation;
    set_rotation(scene, (pir_quat){q.x + step * d.x, q.y + step * d.y, q.z + step * d.z, q.w});
    set_x(scene, test_add(scene->placement.x, e, step));
    if (test_length(scene->placement.x) > 0.6)
        set_x(scene, (pir_vec3){0, 0, 0});
}

static void a_surface_that_stays_is_farther_than_the_facet_all_around(void **state) {
    (void)state;
    static struct scene scene;
    uint32_t stayed = 0, left = 0;
    for (uint64_t i = 0; i < CASES; i++) {
        test_random random = test_random_case("kept distances", i);
        const unsigned version = i % 2 && pir_processor_version(1) ? 1 : 0;
        scene.room.loops = pir_processor_version(version)->surface;
        make_scene(&random, &scene, &scene.room);
        for (int k = 0; k < STEPS; k++) {
            uint32_t nearest = 0;
            pir_vec3 at[3];
            double least = HUGE_VAL;
            for (uint32_t t = 0; t < scene.surface.count; t++) {
                corners_of(&scene, t, at);
                if (distance_of(at) < least)
                    least = distance_of(at), nearest = t;
            }
            // a facet as far as the nearest triangle, which lies in it, or as far as any lesser number
            const bool in_it = k % 2;
            const double slack = in_it ? least : least * test_random_unit(&random) * 0.999;
            const double error = scene.placement.error;
            pir_surface_step step = {&scene.frame, &scene.placement, slack - error, slack + error, 0, 0};
            uint64_t near;
            const uint64_t of_facet = in_it ? 1ull << nearest : 0;
            if (scene.surface.lows.is_known && slack > 0 &&
                pir_surface_approach(&scene.surface, &scene.room, &step, &near) &&
                pir_surface_stays(&scene.surface, &step, near & ~of_facet, &scene.room)) {
                check_stays(&scene, slack, of_facet, (unsigned long long)i);
                stayed++;
            } else {
                scene.surface.lows.is_known = false;
                scene.surface.lows.rest = 0;
                left++;
                if (place(&scene))
                    pir_surface_keep(&scene.surface, &scene.frame, &scene.placement, &scene.room);
            }
            move(&random, &scene);
        }
    }
    print_message("# %u placements that stay, %u made anew\n", stayed, left);
    assert_true(stayed > CASES * STEPS / 4 && left > CASES);
}

/* The distances of triangles placed by themselves, in any order, are those of the whole surface placed. */
static void check_lows(test_random *random, const struct scene *scene) {
    uint8_t triangle[PIR_SURFACE_TRIANGLES + PIR_SURFACE_LANES] = {0};
    double low[PIR_SURFACE_TRIANGLES + PIR_SURFACE_LANES];
    const uint32_t count = 1 + test_random_below(random, PIR_SURFACE_TRIANGLES);
    for (uint32_t i = 0; i < count; i++)
        triangle[i] = (uint8_t)test_random_below(random, scene->surface.count);
    for (unsigned version = 0; pir_processor_version(version); version++) {
        const pir_surface_loops *loops = pir_processor_version(version)->surface;
        loops->lows(&scene->surface, triangle, count, &scene->frame, &scene->room, low);
        for (uint32_t i = 0; i < count; i++)
            assert_true(low[i] == scene->room.plane.low[triangle[i]]);
    }
}

/* All loops find the same triangles near, and the same distances. */
static void every_version_finds_the_triangles_that_are_near(void **state) {
    (void)state;
    static struct scene scene;
    for (uint64_t i = 0; i < 50; i++) {
        test_random random = test_random_case("near triangles", i);
        scene.room.loops = pir_processor_version(0)->surface;
        make_scene(&random, &scene, &scene.room);
        const pir_surface_lows *lows = &scene.surface.lows;
        move(&random, &scene);
        place(&scene);
        check_lows(&random, &scene);
        scene.surface.lows.rest = 0;
        pir_surface_keep(&scene.surface, &scene.frame, &scene.placement, &scene.room);
        for (uint32_t k = 0; k <= scene.surface.count; k++) {
            const float limit = k < scene.surface.count ? lows->low[k] : 0;
            uint64_t right = 0;
            for (uint32_t t = 0; t < PIR_SURFACE_TRIANGLES; t++)
                right |= (uint64_t)(t < scene.surface.count && lows->low[t] <= limit) << t;
            for (unsigned version = 0; pir_processor_version(version); version++)
                assert_true(pir_processor_version(version)->surface->near(&scene.surface, limit) == right);
        }
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_surface_that_stays_is_farther_than_the_facet_all_around),
        cmocka_unit_test(every_version_finds_the_triangles_that_are_near),
    };
    return cmocka_run_group_tests_name("kept distances", tests, NULL, NULL);
}

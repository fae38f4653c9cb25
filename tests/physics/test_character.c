/* SPDX-License-Identifier: MIT */
/*
 * The character of examples/character among hulls at random, on a floor or on hills: it never shares a point with
 * anything, and where it comes no farther it stays where it is. It jumps, and rides what turns.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <character.h>
#include <vec.h>

#include "support/random.h"

#define HULLS  120
#define SIDE   25
#define FRAMES 240
#define WATCH  100 /* frames at the end, in which it goes on or stays */

static void add(pir_scene *scene, pir_body_shape *shape, pir_vec3 at) {
    pir_body_options body = pir_body_shape_options(shape);
    uint32_t id;
    body.kind = PIR_BODY_STATIC;
    body.pose.translation = at;
    assert_int_equal(pir_scene_add(scene, &body, &id), PIR_OK);
    pir_body_shape_release(shape);
}

static void add_hills(pir_scene *scene, test_random *random) {
    float height[SIDE * SIDE];
    pir_height_field *field;
    pir_body_shape *shape;
    for (int i = 0; i < SIDE * SIDE; i++)
        height[i] = (float)(0.4 * test_random_unit(random));
    const pir_height_samples samples = {height, PIR_NUMBERS_FLOAT, SIDE, SIDE, 1, 1, NULL, NULL};
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &field), PIR_OK);
    assert_int_equal(pir_body_shape_field(field, 0, NULL, NULL, &shape), PIR_OK);
    add(scene, shape, (pir_vec3){-12, -12, 0});
    pir_height_field_release(field);
}

static void fill(pir_scene *scene, test_random *random, bool hills) {
    pir_body_shape *shape;
    if (hills) {
        add_hills(scene, random);
    } else {
        assert_int_equal(pir_body_shape_box((pir_vec3){40, 40, 1}, 0, NULL, NULL, &shape), PIR_OK);
        add(scene, shape, (pir_vec3){0, 0, -1});
    }
    for (int i = 0; i < HULLS; i++) {
        const double size = 0.7 + 0.5 * test_random_unit(random);
        pir_vec3 point[14];
        for (int k = 0; k < 14; k++)
            point[k] = vec_times(size, test_random_direction(random));
        assert_int_equal(pir_body_shape_hull(point, 14, 0, NULL, NULL, &shape), PIR_OK);
        const double x = 11 * test_random_unit(random), y = 11 * test_random_unit(random);
        add(scene, shape, (pir_vec3){x, y, 1 + test_random_unit(random)});
    }
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
}

/* Whether a walk in one direction ends at rest; where it does not, it goes on. */
static bool walk(pir_scene *scene, struct character *c, pir_vec3 velocity, int world, int number) {
    double path = 0;
    pir_vec3 from = c->at;
    for (int frame = 0; frame < FRAMES; frame++) {
        const pir_vec3 before = c->at;
        size_t count;
        character_move(c, scene, velocity, 1. / 60);
        assert_int_equal(c->status, PIR_OK);
        const pir_scene_shape shape = character_shape(c);
        pir_scene_hit hit;
        assert_int_equal(pir_scene_overlap(scene, &shape, 1, &hit, &count), PIR_OK);
        expect(count == 0, "world %d, walk %d, frame %d: in body %u", world, number, frame, hit.body);
        if (frame == FRAMES - WATCH)
            from = before;
        path += frame >= FRAMES - WATCH ? vec_length(vec_less(c->at, before)) : 0;
    }
    const double far = vec_length(vec_less(c->at, from));
    expect(path < 1e-6 || far > 0.02 * path, "world %d, walk %d: %g m for a way of %g m", world, number, path, far);
    return path < 1e-6;
}

static void a_character_in_clutter(void **state) {
    (void)state;
    const char *asked = getenv("PIR_TEST_WORLDS");
    const int worlds = asked ? atoi(asked) : 8;
    const pir_vec3 end[2] = {{0, 0, -0.6}, {0, 0, 0.6}};
    pir_polytope *spine;
    int rests = 0, walks = 0;
    assert_int_equal(pir_polytope_create(end, 2, NULL, &spine), PIR_OK);
    for (int world = 0; world < worlds; world++) {
        test_random random = test_random_case("character", (uint64_t)world);
        pir_scene *scene;
        assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
        fill(scene, &random, world % 2 == 1);
        struct character c = {.spine = spine, .radius = 0.3, .body = PIR_SCENE_NONE, .at = {0, 0, 6}};
        for (int i = 0; i < 20; i++, walks++) {
            const pir_vec3 way = test_random_direction(&random);
            rests += walk(scene, &c, vec_times(3, (pir_vec3){way.x, way.y, 0}), world, i);
            if (fabs(c.at.x) > 9 || fabs(c.at.y) > 9)
                c = (struct character){.spine = spine, .radius = 0.3, .body = PIR_SCENE_NONE, .at = {0, 0, 6}};
        }
        pir_scene_destroy(scene);
    }
    expect(rests > walks / 4, "%d of %d walks ended at rest", rests, walks);
    pir_polytope_release(spine);
}

/* Up as high as the speed of a jump leads, or to a ceiling, and down again to where it stood. */
static void a_jump(void **state) {
    (void)state;
    const pir_vec3 end[2] = {{0, 0, -0.6}, {0, 0, 0.6}};
    pir_polytope *spine;
    pir_body_shape *shape;
    pir_scene *scene;
    assert_int_equal(pir_polytope_create(end, 2, NULL, &spine), PIR_OK);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    assert_int_equal(pir_body_shape_box((pir_vec3){9, 9, 1}, 0, NULL, NULL, &shape), PIR_OK);
    add(scene, pir_body_shape_retain(shape), (pir_vec3){0, 0, -1});
    add(scene, shape, (pir_vec3){10, 0, 3.2}); // its lower side is at 2.2, where x is above 1
    for (int under = 0; under < 2; under++) {
        struct character c = {.spine = spine, .radius = 0.3, .body = PIR_SCENE_NONE, .at = {4. * under, 0, 1}};
        double top = 0, low = 9;
        int stood = 0;
        for (int frame = 0; frame < 180; frame++) {
            c.rise = frame == 60 ? 4 : c.rise;
            character_move(&c, scene, (pir_vec3){0, 0, 0}, 1. / 60);
            assert_int_equal(c.status, PIR_OK);
            top = frame >= 60 ? fmax(top, c.at.z) : 0;
            low = fmin(low, c.at.z);
            stood += frame >= 60 && c.stands;
        }
        assert_true(c.stands && low > 0.9 && c.at.z < 0.911 && stood < 110 && c.at.x == 4. * under);
        assert_true(under ? top > 1.285 && top < 1.3 : top > 1.6 && top < 0.911 + 4 * 4 / (2 * 9.81));
    }
    pir_scene_destroy(scene);
    pir_polytope_release(spine);
}

/* On a table that turns and rises it stays where it stood on the table, and walks on it as on a floor at rest. */
static void a_ride(void **state) {
    (void)state;
    const pir_vec3 end[2] = {{0, 0, -0.6}, {0, 0, 0.6}}, up = {0.25, 0, 0.5}, spin = {0, 0, 1};
    pir_polytope *spine;
    pir_body_shape *shape;
    pir_scene *scene;
    uint32_t table;
    assert_int_equal(pir_polytope_create(end, 2, NULL, &spine), PIR_OK);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    assert_int_equal(pir_body_shape_box((pir_vec3){4, 4, 0.25}, 0, NULL, NULL, &shape), PIR_OK);
    pir_body_options body = pir_body_shape_options(shape);
    body.kind = PIR_BODY_KINEMATIC;
    assert_int_equal(pir_scene_add(scene, &body, &table), PIR_OK);
    pir_body_shape_release(shape);
    struct character c = {.spine = spine, .radius = 0.3, .body = PIR_SCENE_NONE, .at = {2, 1, 1.25}};
    for (int frame = 0; frame < 30; frame++)
        character_move(&c, scene, (pir_vec3){0, 0, 0}, 1. / 60);
    assert_true(c.stands && c.ground == table);
    pir_vec3 on = c.at;
    pir_pose pose = pir_pose_identity();
    for (int frame = 0; frame < 240; frame++) {
        const pir_vec3 velocity = frame < 120 ? (pir_vec3){0, 0, 0} : (pir_vec3){0.5, -0.25, 0};
        pose = pir_pose_integrate(pose, up, spin, 1. / 60);
        assert_int_equal(pir_scene_update(scene, &(pir_scene_move){table, pose}, 1), PIR_OK);
        character_move(&c, scene, velocity, 1. / 60);
        assert_int_equal(c.status, PIR_OK);
        on = vec_add(on, pir_pose_rotate_inverse(pose, vec_times(1. / 60, velocity)));
        const double off = vec_length(vec_less(pir_pose_apply_inverse(pose, c.at), on));
        expect(c.stands && off < 1e-9, "frame %d: %g m off its place", frame, off);
    }
    pir_scene_destroy(scene);
    pir_polytope_release(spine);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_jump), cmocka_unit_test(a_ride),
                                       cmocka_unit_test(a_character_in_clutter)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

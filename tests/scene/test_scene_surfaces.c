/* SPDX-License-Identifier: MIT */
/*
 * Surfaces as bodies of scenes, against the same scenes with each triangle as a flat piece: events bit for bit, rays,
 * shapes, casts; with kinematic surfaces, threads, snapshots, memory that fails, and none asked for after warm-up.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/scene_file.h>
#include <pirouette/trimesh_contact.h>

#include "mesh/mesh_models.h"
#include "scene/scene_bodies.h"
#include "scene/twin_scenes.h"
#include "support/memory.h"
#include "support/vectors.h"

#define MOST 512

static uint64_t cases(uint64_t usual) {
    const char *given = getenv("PIR_TEST_SURFACES");
    return given ? strtoull(given, NULL, 10) : usual;
}

static twin_options options_of(uint64_t number) {
    static const uint32_t threads[3] = {1, 2, 4};
    twin_options options = {.scene = pir_scene_options_default()};
    options.scene.margin = number % 3 == 0 ? 0.125 : 0;
    // contacts with a surface are without ghosts, so only what they are made of is the same
    options.scene.detail = PIR_SCENE_DEPTHS;
    options.ground = (twin_ground)(number % TWIN_GROUNDS);
    options.kind = number / 4 % 2 ? PIR_BODY_KINEMATIC : PIR_BODY_STATIC;
    options.radius = number % 5 == 4 ? 0.125 : 0;
    options.ground_first = number / 8 % 2 == 0;
    options.threads = threads[number % 3];
    return options;
}

static void events_are_those_of_flat_pieces(void **state) {
    (void)state;
    static twin_scenes t;
    uint64_t events = 0;
    for (uint64_t n = 0; n < cases(32); n++) {
        const twin_options options = options_of(n);
        twin_init(&t, n, &options);
        twin_update_and_compare(&t, n);
        for (int frame = 0; frame < 24; frame++) {
            twin_move(&t, frame % 4 ? 0.5 : 1);
            twin_update_and_compare(&t, n);
        }
        events += t.events;
        twin_finish(&t);
    }
    print_message("%llu events\n", (unsigned long long)events);
    assert_true(events > 100 * cases(32));
}

/* --- queries --- */

static void overlaps_of(twin_scenes *t, const pir_scene_shape *shape, uint64_t number) {
    static pir_scene_hit a[MOST], b[MOST];
    size_t with, without;
    assert_int_equal(pir_scene_overlap(t->with, shape, MOST, a, &with), PIR_OK);
    assert_int_equal(pir_scene_overlap(t->without, shape, MOST, b, &without), PIR_OK);
    expect(with == without, "case %llu: %zu overlaps, not %zu", (unsigned long long)number, with, without);
    for (size_t i = 0; i < with; i++)
        expect(a[i].body == b[i].body && a[i].piece == b[i].piece && a[i].state == b[i].state, "case %llu, hit %zu",
               (unsigned long long)number, i);
}

static bool same_near(const pir_scene_near *a, const pir_scene_near *b) {
    return a->body_p == b->body_p && a->body_q == b->body_q && a->piece_p == b->piece_p && a->piece_q == b->piece_q &&
           a->result.distance == b->result.distance && a->result.state == b->result.state &&
           memcmp(&a->result.normal, &b->result.normal, sizeof a->result.normal) == 0;
}

static void compare_near(const pir_scene_near *a, size_t with, const pir_scene_near *b, size_t without,
                         uint64_t number) {
    expect(with == without, "case %llu: %zu near, not %zu", (unsigned long long)number, with, without);
    for (size_t i = 0; i < with; i++)
        expect(same_near(&a[i], &b[i]), "case %llu, near %zu: %u %u at %a, not %u %u at %a", (unsigned long long)number,
               i, a[i].body_q, a[i].piece_q, a[i].result.distance, b[i].body_q, b[i].piece_q, b[i].result.distance);
}

static void nearest_of(twin_scenes *t, const pir_scene_shape *shape, uint64_t number) {
    static pir_scene_near a[MOST], b[MOST];
    const size_t capacity = 1 + test_random_below(&t->random, 12);
    const double cutoff = test_random_below(&t->random, 2) ? HUGE_VAL : 1;
    size_t with, without;
    assert_int_equal(pir_scene_nearest(t->with, shape, cutoff, capacity, a, &with), PIR_OK);
    assert_int_equal(pir_scene_nearest(t->without, shape, cutoff, capacity, b, &without), PIR_OK);
    compare_near(a, with, b, without, number);
    assert_int_equal(pir_scene_closest_pairs(t->with, cutoff, capacity, a, &with), PIR_OK);
    assert_int_equal(pir_scene_closest_pairs(t->without, cutoff, capacity, b, &without), PIR_OK);
    compare_near(a, with, b, without, number);
}

static void distances_of(twin_scenes *t, const pir_scene_shape *shape, uint64_t number) {
    static pir_scene_distance a[MOST], b[MOST];
    const pir_accuracy accuracy = {0.01, 0.1};
    size_t with, without;
    assert_int_equal(pir_scene_distances(t->with, shape, 2, accuracy, MOST, a, &with), PIR_OK);
    assert_int_equal(pir_scene_distances(t->without, shape, 2, accuracy, MOST, b, &without), PIR_OK);
    expect(with == without, "case %llu: %zu distances, not %zu", (unsigned long long)number, with, without);
    for (size_t i = 0; i < with && i < MOST; i++)
        expect(a[i].body == b[i].body && a[i].piece == b[i].piece && a[i].state == b[i].state &&
                   a[i].least == b[i].least && a[i].most == b[i].most,
               "case %llu, distance %zu", (unsigned long long)number, i);
}

static void shapes_meet_what_they_meet_of_flat_pieces(void **state) {
    (void)state;
    static twin_scenes t;
    for (uint64_t n = 0; n < cases(24); n++) {
        const twin_options options = options_of(n);
        twin_init(&t, 1000 + n, &options);
        for (int k = 0; k < 12; k++) {
            pir_scene_shape shape = twin_shape(&t);
            overlaps_of(&t, &shape, n);
            nearest_of(&t, &shape, n);
            distances_of(&t, &shape, n);
            pir_polytope_release(shape.polytope);
        }
        twin_finish(&t);
    }
}

static pir_vec3 random_way(twin_scenes *t) {
    pir_vec3 way = {0, 0, 0};
    const double length = 2 * t->size * fabs(test_random_unit(&t->random));
    if (test_random_below(&t->random, 3) == 0)
        return (pir_vec3){0, 0, -test_random_between(&t->random, 0, (int)(2 * t->size))};
    way = test_random_direction(&t->random);
    return (pir_vec3){length * way.x, length * way.y, length * way.z};
}

/* Whether two impacts are one, or tie: where a way is nearly along a facet, as long as it is within the tolerance. */
static bool same_impact(const pir_impact *a, const pir_impact *b, double way, double tolerance) {
    const double room = way > 0 ? 1000 * tolerance / way : 1;
    if (a->body == b->body && a->piece_q == b->piece_q && a->piece_p == b->piece_p)
        return a->outcome == b->outcome && fabs(a->time - b->time) <= room;
    return a->body != PIR_SCENE_NONE && b->body != PIR_SCENE_NONE && fabs(a->time - b->time) <= room;
}

/* A shape on its way: before the impact it meets nothing, exactly; then it is within the tolerance of what it met. */
static void expect_proven(twin_scenes *t, const pir_scene_shape *shape, const pir_motion *motion, double tolerance,
                          const pir_impact *impact, uint64_t number) {
    static pir_scene_near near[MOST];
    pir_scene_shape at = *shape;
    pir_scene_hit hit;
    size_t count;
    for (int i = 0; i < 8 && impact->time > 0; i++) {
        at.pose = pir_pose_integrate(shape->pose, motion->way, motion->turn, impact->time * i / 8);
        assert_int_equal(pir_scene_overlap(t->without, &at, 1, &hit, &count), PIR_OK);
        expect(count == 0, "case %llu: in body %u piece %u at %d/8 of %a", (unsigned long long)number, hit.body,
               hit.piece, i, impact->time);
    }
    if (impact->outcome != PIR_CAST_HIT || impact->time == 0)
        return;
    at.pose = pir_pose_integrate(shape->pose, motion->way, motion->turn, impact->time);
    assert_int_equal(pir_scene_nearest(t->without, &at, tolerance * (1 + 1e-6), MOST, near, &count), PIR_OK);
    bool is_near = false;
    for (size_t i = 0; i < count; i++)
        is_near |= near[i].body_q == impact->body && near[i].piece_q == impact->piece_q &&
                   near[i].result.distance > 0.49 * tolerance;
    expect(is_near, "case %llu: %zu are near at %a", (unsigned long long)number, count, impact->time);
}

static bool comes_before(const pir_impact *a, const pir_impact *b) {
    return a->body != b->body ? a->body < b->body : a->piece_q < b->piece_q;
}

static int by_number(const void *a, const void *b) {
    return comes_before(a, b) ? -1 : comes_before(b, a);
}

/*
 * All that both tell is the same but for the order of equal times; what one alone tells comes hardly nearer than the
 * tolerance.
 */
static void expect_same_of_all(twin_scenes *t, const pir_scene_shape *shape, const pir_motion *motion, double tolerance,
                               uint64_t number) {
    static pir_impact a[MOST], b[MOST];
    static pir_scene_near near[MOST];
    size_t of_a, of_b, count;
    assert_int_equal(pir_scene_cast_all(t->with, shape, motion, tolerance, MOST, a, &of_a), PIR_OK);
    assert_int_equal(pir_scene_cast_all(t->without, shape, motion, tolerance, MOST, b, &of_b), PIR_OK);
    assert_true(of_a <= MOST && of_b <= MOST);
    qsort(a, of_a, sizeof *a, by_number);
    qsort(b, of_b, sizeof *b, by_number);
    for (size_t i = 0, k = 0; i < of_a || k < of_b;) {
        const bool only_a = k == of_b || (i < of_a && comes_before(&a[i], &b[k])),
                   only_b = i == of_a || (k < of_b && comes_before(&b[k], &a[i]));
        const pir_impact *one = only_b ? &b[k] : &a[i];
        pir_scene_shape at = *shape;
        bool is_near = false;
        at.pose = pir_pose_integrate(shape->pose, motion->way, motion->turn, one->time);
        assert_int_equal(pir_scene_nearest(t->without, &at, 2 * tolerance, MOST, near, &count), PIR_OK);
        for (size_t n = 0; n < count; n++)
            is_near |= near[n].body_q == one->body && near[n].piece_q == one->piece_q &&
                       (near[n].result.distance > 0.4 * tolerance || (!only_a && !only_b) || one->time == 0);
        expect(is_near, "case %llu: body %u piece %u at %a: %s", (unsigned long long)number, one->body, one->piece_q,
               one->time,
               only_a   ? "with surfaces alone"
               : only_b ? "without surfaces alone"
                        : "both");
        expect(only_a || only_b || fabs(a[i].time - b[k].time) <= 0x1p-12, "case %llu: body %u piece %u at %a, not %a",
               (unsigned long long)number, a[i].body, a[i].piece_q, a[i].time, b[k].time);
        i += !only_b;
        k += !only_a;
    }
}

static void casts_of(twin_scenes *t, const pir_scene_shape *shape, uint64_t number) {
    const double tolerance = 1e-6;
    pir_motion motion = {.way = random_way(t)};
    if (test_random_below(&t->random, 3) == 0)
        motion.turn = test_random_direction(&t->random);
    const double way = sqrt(motion.way.x * motion.way.x + motion.way.y * motion.way.y + motion.way.z * motion.way.z);
    pir_impact a, b;
    assert_int_equal(pir_scene_cast(t->with, shape, &motion, tolerance, &a), PIR_OK);
    assert_int_equal(pir_scene_cast(t->without, shape, &motion, tolerance, &b), PIR_OK);
    const double room = motion.turn.x != 0 ? 10 * tolerance : tolerance;
    expect(same_impact(&a, &b, way, room), "case %llu: body %u piece %u at %a, not %u %u at %a",
           (unsigned long long)number, a.body, a.piece_q, a.time, b.body, b.piece_q, b.time);
    expect_proven(t, shape, &motion, tolerance, &a, number);
    expect_same_of_all(t, shape, &motion, tolerance, number);
    const uint32_t body = test_random_below(&t->random, 2) ? t->ground : t->body[number % TWIN_BODIES];
    pir_status with = pir_scene_time_of_impact(t->with, body, &motion, tolerance, &a);
    assert_int_equal(pir_scene_time_of_impact(t->without, body, &motion, tolerance, &b), with);
    expect(with != PIR_OK || same_impact(&a, &b, way, room), "case %llu, body %u: %u %u at %a, not %u %u at %a",
           (unsigned long long)number, body, a.body, a.piece_q, a.time, b.body, b.piece_q, b.time);
}

static void casts_meet_what_they_meet_of_flat_pieces(void **state) {
    (void)state;
    static twin_scenes t;
    for (uint64_t n = 0; n < cases(24); n++) {
        const twin_options options = options_of(n);
        twin_init(&t, 2000 + n, &options);
        for (int k = 0; k < 16; k++) {
            pir_scene_shape shape = twin_shape(&t);
            casts_of(&t, &shape, n);
            pir_polytope_release(shape.polytope);
        }
        twin_finish(&t);
    }
}

/* --- rays --- */

static size_t all_of(pir_scene *scene, pir_vec3 origin, pir_vec3 way, pir_ray_sides sides, pir_impact *hits) {
    size_t count;
    pir_scene_ray_options options = pir_scene_ray_options_default();
    options.sides = sides;
    assert_int_equal(pir_scene_ray_all(scene, origin, way, &options, MOST, hits, &count), PIR_OK);
    assert_true(count <= MOST);
    bool any;
    assert_int_equal(pir_scene_ray_any(scene, origin, way, &options, &any), PIR_OK);
    assert_int_equal(any, count > 0);
    for (size_t i = 1; i < count; i++)
        assert_true(hits[i - 1].time <= hits[i].time);
    return count;
}

/* Both sides are those of flat pieces; a side is part of them, and what is of no side is in the plane. */
static void rays_of(twin_scenes *t, pir_vec3 origin, pir_vec3 way, bool rounded, uint64_t number) {
    static pir_impact a[MOST], b[MOST];
    const size_t both = all_of(t->with, origin, way, PIR_RAY_BOTH, a),
                 flat = all_of(t->without, origin, way, PIR_RAY_AS_SURFACE, b);
    pir_impact first;
    assert_int_equal(pir_scene_ray(t->with, origin, way, UINT32_MAX, &first), PIR_OK);
    expect(both == flat, "case %llu: %zu hits, not %zu", (unsigned long long)number, both, flat);
    if (t->two_sided || rounded)
        expect(both > 0 ? first.time == a[0].time && first.piece_q == a[0].piece_q : first.body == PIR_SCENE_NONE,
               "case %llu: the first", (unsigned long long)number);
    qsort(a, both, sizeof *a, by_number);
    qsort(b, flat, sizeof *b, by_number);
    for (size_t i = 0; i < both; i++)
        expect(a[i].body == b[i].body && a[i].piece_q == b[i].piece_q && fabs(a[i].time - b[i].time) <= 0x1p-36,
               "case %llu: hit %zu", (unsigned long long)number, i);
    size_t others = 0;
    for (size_t i = 0; i < both; i++)
        others += a[i].body != t->ground;
    const size_t front = all_of(t->with, origin, way, PIR_RAY_FRONT, b) - others,
                 back = all_of(t->with, origin, way, PIR_RAY_BACK, a) - others,
                 usual = all_of(t->with, origin, way, PIR_RAY_AS_SURFACE, a) - others;
    expect(rounded || front + back <= both - others, "case %llu", (unsigned long long)number);
    expect(rounded || usual == (t->two_sided ? both - others : front), "case %llu", (unsigned long long)number);
}

static void rays_meet_what_they_meet_of_flat_pieces(void **state) {
    (void)state;
    static twin_scenes t;
    for (uint64_t n = 0; n < cases(24); n++) {
        const twin_options options = options_of(n);
        twin_init(&t, 3000 + n, &options);
        for (int k = 0; k < 60; k++) {
            const int most = 2 * (int)t.size;
            pir_vec3 origin = {0.5 * test_random_between(&t.random, -most, most),
                               0.5 * test_random_between(&t.random, -most, most), 0};
            origin.z = k % 3 ? t.size : 0.5 * test_random_between(&t.random, -4, 4);
            rays_of(&t, origin, random_way(&t), options.radius > 0, n);
        }
        twin_finish(&t);
    }
}

/* --- sides, as told by hand --- */

static void a_side_is_that_of_the_triangle(void **state) {
    (void)state;
    const float heights[4] = {0, 0, 0, 0};
    const pir_height_samples samples = {
        .heights = heights, .type = PIR_NUMBERS_FLOAT, .columns = 2, .rows = 2, .step_x = 1, .step_y = 1};
    pir_scene *scene;
    pir_impact hit;
    pir_body_options body = pir_body_options_default();
    uint32_t ground;
    body.kind = PIR_BODY_STATIC;
    body.pose.translation = (pir_vec3){5, 0, 1};
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &body.field), PIR_OK);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    assert_int_equal(pir_scene_add(scene, &body, &ground), PIR_OK);
    pir_height_field_release(body.field);
    assert_int_equal(pir_scene_ray(scene, (pir_vec3){5.75, 0.25, 3}, (pir_vec3){0, 0, -4}, 1, &hit), PIR_OK);
    assert_true(hit.body == ground && hit.piece_q == 0 && hit.time == 0.5 && hit.normal.z == 1 && hit.point.z == 1);
    assert_int_equal(pir_scene_ray(scene, (pir_vec3){5.25, 0.75, 3}, (pir_vec3){0, 0, -4}, 1, &hit), PIR_OK);
    assert_true(hit.piece_q == 1);
    // along the diagonal both are met, and the lower number is told
    assert_int_equal(pir_scene_ray(scene, (pir_vec3){5.5, 0.5, 3}, (pir_vec3){0, 0, -4}, 1, &hit), PIR_OK);
    assert_true(hit.piece_q == 0 && hit.time == 0.5);
    assert_int_equal(pir_scene_ray(scene, (pir_vec3){5.75, 0.25, -1}, (pir_vec3){0, 0, 4}, 1, &hit), PIR_OK);
    assert_int_equal(hit.outcome, PIR_CAST_MISS);
    assert_int_equal(pir_scene_ray(scene, (pir_vec3){4, 0.25, 1}, (pir_vec3){4, 0, 0}, 1, &hit), PIR_OK);
    assert_int_equal(hit.outcome, PIR_CAST_MISS);
    pir_scene_destroy(scene);
}

/* --- contacts --- */

/* Slides a cube a little above a floor; every contact points up, and there are the four of a slab. */
static void slide(pir_scene *scene, uint32_t body, bool body_is_p, pir_quat turned, uint32_t frames) {
    for (uint32_t frame = 0; frame < frames; frame++) {
        const pir_scene_move move = {body, {turned, {3 + 0.0371 * frame, 10 + 0.0113 * frame, 0.5625}}};
        size_t count, contacts = 0;
        assert_int_equal(pir_scene_update(scene, &move, 1), PIR_OK);
        const pir_scene_event *event = pir_scene_events(scene, &count);
        for (size_t i = 0; i < count; i++) {
            contacts += event[i].contact_count;
            for (uint32_t k = 0; k < event[i].contact_count; k++)
                expect(fabs(fabs(event[i].normal.z) - 1) <= 1e-12 && (event[i].normal.z > 0) == body_is_p &&
                           fabs(event[i].contacts[k].distance - 0.0625) <= 1e-12,
                       "frame %u: normal %g %g %g, distance %g", frame, event[i].normal.x, event[i].normal.y,
                       event[i].normal.z, event[i].contacts[k].distance);
        }
        expect(contacts == 4, "frame %u: %zu contacts", frame, contacts);
    }
}

static void a_flat_floor_has_no_inner_edges(void **state) {
    (void)state;
    static const uint32_t threads[3] = {1, 2, 4};
    mesh_arrays arrays = mesh_plane(24);
    pir_polytope *cube = scene_cube(0.5);
    for (int n = 0; n < 6; n++) {
        pir_scene_options options = pir_scene_options_default();
        options.margin = 0.125;
        options.threads = threads[n / 2];
        pir_scene *scene;
        pir_body_options ground = pir_body_options_default();
        uint32_t body, floor_body;
        ground.kind = PIR_BODY_STATIC;
        ground.mesh = mesh_of(&arrays, NULL);
        assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
        if (n % 2)
            assert_int_equal(pir_scene_add(scene, &ground, &floor_body), PIR_OK);
        body = scene_add(scene, cube, scene_at(0, 0, 50), PIR_BODY_MOVING);
        if (n % 2 == 0)
            assert_int_equal(pir_scene_add(scene, &ground, &floor_body), PIR_OK);
        slide(scene, body, n % 2 == 0, (pir_quat){0, 0, 0, 1}, 400);
        slide(scene, body, n % 2 == 0, (pir_quat){0, 0, 0.25, 1}, 400);
        pir_scene_destroy(scene);
        pir_trimesh_release(ground.mesh);
    }
    pir_polytope_release(cube);
    mesh_arrays_clear(&arrays);
}

/* With manifolds, what is in contact and its state are as with distances alone; contacts are the same with threads. */
static void contacts_change_no_states(void **state) {
    (void)state;
    static twin_scenes t, other, again;
    uint64_t contacts = 0;
    for (uint64_t n = 0; n < cases(12); n++) {
        twin_options options = options_of(n);
        twin_init(&t, 8000 + n, &options);
        options.scene.detail = PIR_SCENE_MANIFOLDS;
        options.threads = 1;
        twin_init(&other, 8000 + n, &options);
        options.threads = 4;
        twin_init(&again, 8000 + n, &options);
        for (int frame = 0; frame < 12; frame++) {
            size_t a, b, c;
            twin_move(&t, 0.75);
            twin_update_and_compare(&t, n);
            assert_int_equal(pir_scene_update(other.with, t.move, t.moves), PIR_OK);
            assert_int_equal(pir_scene_update(again.with, t.move, t.moves), PIR_OK);
            const pir_scene_event *x = pir_scene_events(t.with, &a), *y = pir_scene_events(other.with, &b),
                                  *z = pir_scene_events(again.with, &c);
            assert_int_equal(b, c);
            size_t k = 0;
            for (size_t i = 0; i < b; i++) {
                expect(twin_same_event(&y[i], &z[i]), "case %llu, event %zu", (unsigned long long)n, i);
                contacts += y[i].contact_count;
                // a pair has an event for each normal
                const bool anew = i > 0 && y[i].body_p == y[i - 1].body_p && y[i].body_q == y[i - 1].body_q &&
                                  y[i].piece_p == y[i - 1].piece_p && y[i].piece_q == y[i - 1].piece_q;
                k += !anew;
                expect(k <= a && x[k - 1].kind == y[i].kind && x[k - 1].state == y[i].state &&
                           x[k - 1].body_q == y[i].body_q && x[k - 1].piece_p == y[i].piece_p &&
                           x[k - 1].piece_q == y[i].piece_q,
                       "case %llu, event %zu", (unsigned long long)n, i);
            }
            assert_int_equal(k, a);
        }
        twin_finish(&t);
        twin_finish(&other);
        twin_finish(&again);
    }
    assert_true(contacts > 10 * cases(12));
}

/* The contacts of body `i` with the ground that the scene tells, in the order of their ids. */
static size_t told_contacts(const twin_scenes *t, uint32_t i, pir_surface_contact *ret_contacts) {
    size_t events, count = 0;
    const pir_scene_event *event = pir_scene_events(t->with, &events);
    for (size_t e = 0; e < events; e++) {
        const bool is_p = event[e].body_p == t->body[i] && event[e].body_q == t->ground;
        if (!is_p && !(event[e].body_q == t->body[i] && event[e].body_p == t->ground))
            continue;
        for (uint32_t k = 0; k < event[e].contact_count; k++) {
            const pir_contact *c = &event[e].contacts[k];
            assert_true(count < MOST);
            ret_contacts[count++] = (pir_surface_contact){.point_p = is_p ? c->point_p : c->point_q,
                                                          .normal = test_add(test_zero, event[e].normal, is_p ? 1 : -1),
                                                          .distance = c->distance,
                                                          .id = c->id};
        }
    }
    return count;
}

/* Whether a contact is one of many: a point that is at the rim of two triangles may be there once or twice, under
   numbers that follow one another. */
static bool is_among(const pir_surface_contact *contact, const pir_surface_contact *all, size_t count, double size) {
    for (size_t k = 0; k < count; k++)
        if (fabs(contact->distance - all[k].distance) <= 1e-12 * size && contact->id - all[k].id + 2 <= 4 &&
            test_length(test_add(contact->normal, all[k].normal, -1)) <= 1e-9 &&
            test_length(test_add(contact->point_p, all[k].point_p, -1)) <= 1e-9 * size)
            return true;
    return false;
}

/* The scene, which knows the triangles that are near, tells what a search of the whole surface finds. */
static size_t compare_with_search(const twin_scenes *t, pir_workspace *workspace, uint32_t i, double margin,
                                  uint64_t number) {
    static pir_surface_contact told[MOST], found[MOST];
    pir_body_state ground, body;
    pir_surface_contact_result result;
    assert_int_equal(pir_scene_get_body(t->with, t->ground, &ground), PIR_OK);
    assert_int_equal(pir_scene_get_body(t->with, t->body[i], &body), PIR_OK);
    const pir_posed_surface surface = {{ground.mesh, ground.field}, ground.pose};
    const pir_surface_contact_input input = {.pose = body.pose,
                                             .radius = body.radius + ground.radius,
                                             .margin = margin,
                                             .surfaces = &surface,
                                             .surface_count = 1};
    if (body.sensor)
        return 0;
    assert_int_equal(pir_surface_contacts(t->shape[i], workspace, &input, MOST, found, &result), PIR_OK);
    const size_t count = told_contacts(t, i, told);
    for (size_t k = 0; k < result.contacts; k++)
        found[k].point_p = test_add(found[k].point_p, found[k].normal, ground.radius);
    for (size_t k = 0; k < count; k++)
        expect(is_among(&told[k], found, result.contacts, t->size), "case %llu, body %u: contact %zu is not found",
               (unsigned long long)number, i, k);
    for (size_t k = 0; k < result.contacts; k++)
        expect(is_among(&found[k], told, count, t->size), "case %llu, body %u: contact %zu is not told",
               (unsigned long long)number, i, k);
    return count;
}

static void contacts_are_those_that_a_search_finds(void **state) {
    (void)state;
    static twin_scenes t;
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    uint64_t contacts = 0;
    for (uint64_t n = 0; n < cases(48); n++) {
        twin_options options = options_of(n);
        options.scene.detail = PIR_SCENE_MANIFOLDS;
        options.scene.margin = n % 4 == 0 ? 0 : 0.125;
        twin_init(&t, 9000 + n, &options);
        for (int frame = 0; frame < 12; frame++) {
            twin_move(&t, 1);
            assert_int_equal(pir_scene_update(t.with, t.move, t.moves), PIR_OK);
            for (uint32_t i = 0; i < TWIN_BODIES; i++)
                contacts += compare_with_search(&t, workspace, i, options.scene.margin, n);
        }
        twin_finish(&t);
    }
    print_message("%llu contacts\n", (unsigned long long)contacts);
    assert_true(contacts > 10 * cases(48));
    pir_workspace_destroy(workspace);
}

/* --- bodies --- */

static void what_is_no_body_is_refused(void **state) {
    (void)state;
    mesh_arrays arrays = mesh_plane(1);
    pir_trimesh *mesh = mesh_of(&arrays, NULL);
    pir_polytope *cube = scene_cube(1);
    pir_scene *scene;
    uint32_t body = 42;
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    pir_body_options options = pir_body_options_default();
    options.mesh = mesh;
    assert_int_equal(pir_scene_add(scene, &options, &body), PIR_ERR_ARGUMENT); // it would move
    options.kind = PIR_BODY_STATIC;
    options.pieces = &cube;
    options.piece_count = 1;
    assert_int_equal(pir_scene_add(scene, &options, &body), PIR_ERR_ARGUMENT);
    options.pieces = NULL;
    options.pose.translation.x = 0x1p60;
    assert_int_equal(pir_scene_add(scene, &options, &body), PIR_ERR_LIMIT);
    assert_int_equal(body, 42);
    options.pose.translation.x = 0;
    options.piece_count = 0;
    assert_int_equal(pir_scene_add(scene, &options, &body), PIR_OK);
    pir_trimesh_release(mesh);
    pir_scene_statistics statistics = pir_scene_get_statistics(scene);
    assert_int_equal(statistics.pieces, 1);
    assert_int_equal(statistics.triangles, 0);
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
    mesh_arrays_clear(&arrays);
}

/* Bodies go round above a plane and leave it; a triangle is a piece while something is near it. */
static void triangles_come_and_go(void **state) {
    (void)state;
    mesh_arrays arrays = mesh_plane(40);
    pir_body_options ground = pir_body_options_default();
    ground.mesh = mesh_of(&arrays, NULL);
    ground.kind = PIR_BODY_STATIC;
    pir_polytope *cube = scene_cube(0.5);
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_scene_options options = pir_scene_options_default();
    options.allocator = &allocator;
    pir_scene *scene;
    uint32_t body;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    assert_int_equal(pir_scene_add(scene, &ground, &body), PIR_OK);
    body = scene_add(scene, cube, scene_at(0, 0, 0.25), PIR_BODY_MOVING);
    uint64_t requests = 0;
    for (int frame = 0; frame < 1200; frame++) {
        const double angle = 0.01 * frame;
        pir_scene_move move = {body, scene_at(20 + 15 * cos(angle), 20 + 15 * sin(angle), 0.25)};
        size_t count;
        assert_int_equal(pir_scene_update(scene, &move, 1), PIR_OK);
        pir_scene_events(scene, &count);
        assert_true(count >= 2);
        const pir_scene_statistics statistics = pir_scene_get_statistics(scene);
        assert_in_range(statistics.triangles, 2, 30);
        if (frame == 700)
            requests = memory.requests;
    }
    assert_int_equal(memory.requests, requests);
    pir_scene_move move = {body, scene_at(0, 0, 100)};
    assert_int_equal(pir_scene_update(scene, &move, 1), PIR_OK);
    assert_int_equal(pir_scene_get_statistics(scene).triangles, 0);
    assert_true(pir_scene_is_valid(scene));
    pir_scene_destroy(scene);
    assert_int_equal(memory.blocks, 0);
    pir_polytope_release(cube);
    pir_trimesh_release(ground.mesh);
    mesh_arrays_clear(&arrays);
}

static void removed_surfaces_leave_nothing(void **state) {
    (void)state;
    static twin_scenes t;
    for (uint64_t n = 0; n < 12; n++) {
        const twin_options options = options_of(n);
        twin_init(&t, 4000 + n, &options);
        twin_update_and_compare(&t, n);
        assert_int_equal(pir_scene_remove(t.with, t.ground), PIR_OK);
        assert_int_equal(pir_scene_remove(t.without, t.ground), PIR_OK);
        assert_int_equal(pir_scene_get_statistics(t.with).triangles, 0);
        t.ground_moves = false;
        for (int frame = 0; frame < 4; frame++) {
            twin_move(&t, 0.5);
            twin_update_and_compare(&t, n);
        }
        twin_finish(&t);
    }
}

/* --- snapshots --- */

static void a_snapshot_goes_on_with_the_same_surface_only(void **state) {
    (void)state;
    static twin_scenes t, other;
    for (uint64_t n = 0; n < 16; n++) {
        const twin_options options = options_of(n);
        twin_init(&t, 5000 + n, &options);
        twin_init(&other, 5000 + n, &options);
        for (int frame = 0; frame < 6; frame++) {
            twin_move(&t, 1);
            twin_update_and_compare(&t, n);
        }
        size_t size = pir_scene_serialised_size(t.with);
        unsigned char *bytes = malloc(size), *again = malloc(size);
        assert_true(bytes && again);
        assert_int_equal(pir_scene_serialise(t.with, bytes, size), PIR_OK);
        assert_int_equal(pir_scene_restore(other.with, bytes, size, NULL), PIR_OK);
        assert_true(pir_scene_is_valid(other.with));
        assert_int_equal(pir_scene_serialised_size(other.with), size);
        assert_int_equal(pir_scene_serialise(other.with, again, size), PIR_OK);
        assert_memory_equal(bytes, again, size);
        // the scene without a surface goes on as it was, and the restored one with it
        pir_scene *before = t.with;
        t.with = other.with;
        for (int frame = 0; frame < 6; frame++) {
            twin_move(&t, 0.5);
            twin_update_and_compare(&t, n);
        }
        t.with = before;
        // another surface in the same place
        twin_finish(&other);
        twin_init(&other, 6000 + n, &options);
        pir_report report = {PIR_OK, ""};
        if (options.ground != TWIN_PLANE && options.ground != TWIN_SPHERE) {
            assert_int_equal(pir_scene_restore(other.with, bytes, size, &report), PIR_ERR_ARGUMENT);
            assert_non_null(strstr(report.text, "and its own shape is not kept"));
        }
        free(bytes);
        free(again);
        twin_finish(&other);
        twin_finish(&t);
    }
}

/* --- memory --- */

/* A life with every kind of call; the status of the first that failed. */
static pir_status live(twin_scenes *t, const pir_allocator *allocator) {
    pir_scene_options options = pir_scene_options_default();
    options.allocator = allocator;
    pir_scene *scene = NULL;
    pir_body_options ground = pir_body_options_default(), body = pir_body_options_default();
    pir_scene_hit hits[4];
    pir_scene_near near[4];
    pir_impact impact;
    size_t count;
    uint32_t number;
    ground.kind = PIR_BODY_KINEMATIC;
    ground.mesh = t->mesh;
    ground.field = t->field;
    body.pieces = &t->shape[0];
    body.piece_count = 1;
    pir_status status = pir_scene_create(&options, &scene);
    if (status == PIR_OK)
        status = pir_scene_add(scene, &ground, &number);
    if (status == PIR_OK)
        status = pir_scene_add(scene, &body, &number);
    if (status == PIR_OK)
        status = pir_scene_update(scene, NULL, 0);
    pir_scene_move moves[2] = {{0, scene_at(0.5, 0, 0)}, {1, scene_at(0, 0.25, 0)}};
    if (status == PIR_OK)
        status = pir_scene_update(scene, moves, 2);
    if (status != PIR_OK && scene)
        assert_true(pir_scene_is_valid(scene));
    const pir_scene_shape shape = pir_scene_shape_default(t->shape[0]);
    const pir_motion motion = {.way = {0, 0, -4}};
    if (status == PIR_OK)
        status = pir_scene_overlap(scene, &shape, 4, hits, &count);
    if (status == PIR_OK)
        status = pir_scene_nearest(scene, &shape, 4, 4, near, &count);
    if (status == PIR_OK)
        status = pir_scene_cast(scene, &shape, &motion, 1e-6, &impact);
    if (status == PIR_OK)
        status = pir_scene_ray(scene, (pir_vec3){0, 0, 4}, (pir_vec3){0, 0, -8}, 1, &impact);
    pir_scene_destroy(scene);
    return status;
}

static void memory_that_fails_leaves_no_leak(void **state) {
    (void)state;
    static twin_scenes t;
    for (uint32_t ground = 0; ground < TWIN_GROUNDS; ground++) {
        const twin_options options = {
            .scene = pir_scene_options_default(), .ground = (twin_ground)ground, .kind = PIR_BODY_STATIC, .threads = 1};
        twin_init(&t, 7000 + ground, &options);
        pir_status status = PIR_ERR_MEMORY;
        uint64_t failed = 0;
        for (uint64_t request = 1; status == PIR_ERR_MEMORY; request++) {
            test_memory memory = {.fail_at = request};
            pir_allocator allocator = test_allocator(&memory);
            status = live(&t, &allocator);
            assert_int_equal(memory.blocks, 0);
            assert_false(memory.wrong_size || memory.overrun);
            failed += status == PIR_ERR_MEMORY;
        }
        assert_int_equal(status, PIR_OK);
        // a shape that meets no triangle asks for less
        assert_true(failed > 15);
        twin_finish(&t);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_are_those_of_flat_pieces),
        cmocka_unit_test(shapes_meet_what_they_meet_of_flat_pieces),
        cmocka_unit_test(casts_meet_what_they_meet_of_flat_pieces),
        cmocka_unit_test(rays_meet_what_they_meet_of_flat_pieces),
        cmocka_unit_test(a_side_is_that_of_the_triangle),
        cmocka_unit_test(a_flat_floor_has_no_inner_edges),
        cmocka_unit_test(contacts_change_no_states),
        cmocka_unit_test(contacts_are_those_that_a_search_finds),
        cmocka_unit_test(what_is_no_body_is_refused),
        cmocka_unit_test(triangles_come_and_go),
        cmocka_unit_test(removed_surfaces_leave_nothing),
        cmocka_unit_test(a_snapshot_goes_on_with_the_same_surface_only),
        cmocka_unit_test(memory_that_fails_leaves_no_leak),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

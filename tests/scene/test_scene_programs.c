/* SPDX-License-Identifier: MIT */
/*
 * Programs of calls on a scene, as a game that has errors makes them: ids that are stale or were never given, bodies
 * that are removed while events are read, moves that come twice, snapshots of other times, queries in between. Each
 * call comes to what a list of the ids that are there says; the scene stays valid.
 *
 * PIR_TEST_CALLS sets how many calls are made.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/body_shape.h>
#include <pirouette/scene_draw.h>
#include <pirouette/scene_file.h>
#include <pirouette/scene_query.h>

#include "support/random.h"
#include "support/vectors.h"

#define SHAPES    6
#define KNOWN     64 /* ids that were given, the last ones */
#define SNAPSHOTS 4
#define BODIES    20

struct program {
    test_random random;
    pir_scene *scene;
    pir_body_shape *shape[SHAPES];
    pir_polytope *probe;
    uint32_t known[KNOWN], given;
    struct {
        unsigned char *bytes;
        size_t size;
    } snapshot[SNAPSHOTS];
    uint64_t calls, stale, removed_in_events, restored;
};

static uint32_t below(struct program *p, uint32_t count) {
    return test_random_below(&p->random, count);
}

/* An id: most are of bodies that are there or were, some of none. */
static uint32_t any_id(struct program *p) {
    const uint32_t how = below(p, 12);
    if (how == 0)
        return (uint32_t)test_random_below(&p->random, 1u << 30) * 4;
    if (how == 1)
        return PIR_SCENE_NONE;
    return p->given > 0 ? p->known[below(p, p->given < KNOWN ? p->given : KNOWN)] : below(p, BODIES);
}

/* What a call with an id comes to. */
static void expect_status(struct program *p, pir_status status, uint32_t id) {
    const bool has = pir_scene_has(p->scene, id);
    p->stale += !has;
    expect(status == (has ? PIR_OK : PIR_ERR_ARGUMENT), "call %llu: id %u, status %d", (unsigned long long)p->calls, id,
           (int)status);
}

static pir_pose any_pose(struct program *p) {
    const pir_vec3 at = test_random_direction(&p->random), axis = test_random_direction(&p->random);
    const pir_pose pose = {{axis.x, axis.y, axis.z, 1.5}, {2 * at.x, 2 * at.y, at.z}};
    return pose;
}

static void add(struct program *p) {
    const uint32_t which = below(p, SHAPES);
    pir_body_options body = pir_body_shape_options(p->shape[which]);
    uint32_t id;
    if (pir_scene_get_statistics(p->scene).bodies >= BODIES)
        return;
    body.kind = (pir_body_kind)(body.pieces ? below(p, 8) % 3 : 1 + below(p, 2));
    body.pose = any_pose(p);
    body.sensor = below(p, 6) == 0;
    body.disabled = below(p, 10) == 0;
    body.user = which;
    assert_int_equal(pir_scene_add(p->scene, &body, &id), PIR_OK);
    for (uint32_t i = 0; i < p->given && i < KNOWN; i++)
        assert_true(p->known[i] != id || p->restored > 0);
    p->known[p->given++ % KNOWN] = id;
}

static void change(struct program *p) {
    const uint32_t id = any_id(p);
    pir_body_state state;
    const bool has = pir_scene_has(p->scene, id);
    pir_status status = PIR_OK;
    switch (below(p, 6)) {
    case 0:
        status = pir_scene_remove(p->scene, id);
        break;
    case 1:
        status = pir_scene_set_filter(p->scene, id, 1u << below(p, 3), below(p, 8));
        break;
    case 2:
        status = pir_scene_set_sensor(p->scene, id, below(p, 3) == 0);
        break;
    case 3:
        status = pir_scene_set_disabled(p->scene, id, below(p, 3) == 0);
        break;
    case 4:
        status = pir_scene_set_user(p->scene, id, below(p, SHAPES));
        break;
    default:
        status = pir_scene_get_body(p->scene, id, &state);
        break;
    }
    p->stale += !has;
    expect(status == (has ? PIR_OK : PIR_ERR_ARGUMENT), "call %llu: id %u, status %d", (unsigned long long)p->calls, id,
           (int)status);
}

/* Reads the events, and removes bodies that they name, some of them twice. */
static void read_events(struct program *p) {
    size_t count;
    const pir_scene_event *event = pir_scene_events(p->scene, &count);
    for (size_t i = 0; i < count; i++) {
        if (event[i].kind != PIR_EVENT_ENDED)
            for (uint32_t k = 0; k < event[i].contact_count; k++)
                assert_true(isfinite(event[i].contacts[k].distance));
        if (below(p, 12) != 0)
            continue;
        const uint32_t id = below(p, 2) ? event[i].body_p : event[i].body_q;
        const bool has = pir_scene_has(p->scene, id);
        assert_int_equal(pir_scene_remove(p->scene, id), has ? PIR_OK : PIR_ERR_ARGUMENT);
        p->removed_in_events += has;
    }
}

static void update(struct program *p) {
    pir_scene_move move[8];
    const size_t count = below(p, 9);
    bool is_right = count <= pir_scene_get_statistics(p->scene).bodies;
    for (size_t i = 0; i < count; i++) {
        pir_body_state state;
        move[i] = (pir_scene_move){any_id(p), any_pose(p)};
        is_right =
            is_right && pir_scene_get_body(p->scene, move[i].body, &state) == PIR_OK && state.kind != PIR_BODY_STATIC;
        for (size_t k = 0; k < i; k++)
            is_right = is_right && move[k].body != move[i].body;
    }
    const pir_status status = pir_scene_update(p->scene, move, count);
    expect(status == (is_right ? PIR_OK : PIR_ERR_ARGUMENT), "call %llu: an update of status %d",
           (unsigned long long)p->calls, (int)status);
    read_events(p);
}

static void file(struct program *p) {
    const uint32_t at = below(p, SNAPSHOTS);
    const bool saves = !p->snapshot[at].bytes || below(p, 2);
    if (saves) {
        free(p->snapshot[at].bytes);
        p->snapshot[at].size = pir_scene_serialised_size(p->scene);
        p->snapshot[at].bytes = malloc(p->snapshot[at].size);
        assert_non_null(p->snapshot[at].bytes);
        assert_int_equal(pir_scene_serialise(p->scene, p->snapshot[at].bytes, p->snapshot[at].size), PIR_OK);
        return;
    }
    const pir_status status = pir_scene_restore(p->scene, p->snapshot[at].bytes, p->snapshot[at].size, NULL);
    // one surface in the place of another is refused
    expect(status == PIR_OK || status == PIR_ERR_ARGUMENT, "call %llu: a restore of status %d",
           (unsigned long long)p->calls, (int)status);
    p->restored += status == PIR_OK;
}

static void count_hull(void *context, const pir_draw_hull *hull) {
    *(size_t *)context += pir_polytope_vertex_count(hull->polytope);
}

static void ask(struct program *p) {
    pir_scene_shape shape = pir_scene_shape_default(p->probe);
    const pir_motion motion = {test_random_direction(&p->random), {0, 0, 0}, 0};
    const uint32_t id = any_id(p);
    pir_scene_hit hit[4];
    pir_scene_near near[3];
    pir_impact impact;
    size_t count;
    char text[256];
    shape.pose = any_pose(p);
    shape.except = any_id(p);
    pir_scene_ray_options options = pir_scene_ray_options_default();
    options.except = id;
    options.radius = below(p, 2) ? 0.25 : 0;
    pir_scene_drawing drawing = pir_scene_drawing_default();
    drawing.hull = count_hull;
    drawing.context = &count;
    switch (below(p, 7)) {
    case 0:
        assert_int_equal(pir_scene_overlap(p->scene, &shape, 4, hit, &count), PIR_OK);
        break;
    case 1:
        assert_int_equal(pir_scene_nearest(p->scene, &shape, 1, 3, near, &count), PIR_OK);
        break;
    case 2:
        assert_int_equal(pir_scene_cast(p->scene, &shape, &motion, 0.01, &impact), PIR_OK);
        break;
    case 3:
        assert_int_equal(pir_scene_ray_first(p->scene, shape.pose.translation, motion.way, &options, &impact), PIR_OK);
        assert_true(impact.body == PIR_SCENE_NONE || pir_scene_has(p->scene, impact.body));
        break;
    case 4:
        expect_status(p, pir_scene_body_text(p->scene, id, sizeof text, text), id);
        break;
    case 5:
        count = 0;
        assert_int_equal(pir_scene_draw(p->scene, &drawing), PIR_OK);
        break;
    default:
        count = 0;
        for (uint32_t at = pir_scene_next(p->scene, PIR_SCENE_NONE); at != PIR_SCENE_NONE;
             at = pir_scene_next(p->scene, at))
            count++;
        assert_int_equal(count, pir_scene_get_statistics(p->scene).bodies);
    }
}

static void make_shapes(struct program *p) {
    const double corner[12] = {-2, -2, 0, 2, -2, 0, 2, 2, 0, -2, 2, 0};
    const uint32_t triangle[6] = {0, 1, 2, 0, 2, 3};
    const float heights[9] = {0, 0.25f, 0, 0.5f, 0, 0.25f, 0, 0, 0};
    const pir_trimesh_arrays arrays = {
        .vertices = corner, .vertex_count = 4, .triangles = triangle, .triangle_count = 2};
    const pir_height_samples samples = {heights, PIR_NUMBERS_FLOAT, 3, 3, 1, 1, NULL, NULL};
    const pir_vec3 half = {0.5, 0.25, 0.375}, up = {0, 0, 0.5};
    pir_trimesh *mesh;
    pir_height_field *field;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &field), PIR_OK);
    assert_int_equal(pir_body_shape_ball(0.5, NULL, NULL, &p->shape[0]), PIR_OK);
    assert_int_equal(pir_body_shape_capsule(test_zero, up, 0.25, NULL, NULL, &p->shape[1]), PIR_OK);
    assert_int_equal(pir_body_shape_box(half, 0, NULL, NULL, &p->shape[2]), PIR_OK);
    const pir_body_part parts[2] = {{p->shape[2], {{0, 0, 0, 1}, {0, 0, 0}}}, {p->shape[2], {{0, 0, 1, 1}, {1, 0, 0}}}};
    assert_int_equal(pir_body_shape_compound(parts, 2, NULL, NULL, &p->shape[3]), PIR_OK);
    assert_int_equal(pir_body_shape_mesh(mesh, 0, NULL, NULL, &p->shape[4]), PIR_OK);
    assert_int_equal(pir_body_shape_field(field, 0, NULL, NULL, &p->shape[5]), PIR_OK);
    assert_int_equal(pir_polytope_create(&(pir_vec3[2]){{0, 0, 0}, {0, 0, 0.25}}[0], 2, NULL, &p->probe), PIR_OK);
    pir_trimesh_release(mesh);
    pir_height_field_release(field);
}

static void run(struct program *p, uint64_t number, uint64_t calls) {
    pir_scene_options options = pir_scene_options_default();
    p->random = test_random_case("programs", number);
    options.keep_shapes = true;
    options.margin = number % 2 ? 0.03125 : 0;
    options.unions = number % 4 == 3;
    options.threads = number % 5 == 4 ? 3 : 1;
    make_shapes(p);
    assert_int_equal(pir_scene_create(&options, &p->scene), PIR_OK);
    for (uint64_t i = 0; i < calls; i++, p->calls++) {
        const uint32_t what = below(p, 20);
        if (what < 4)
            add(p);
        else if (what < 10)
            change(p);
        else if (what < 13)
            update(p);
        else if (what < 14)
            file(p);
        else
            ask(p);
        if (i % 64 == 0)
            expect(pir_scene_is_valid(p->scene), "program %llu, call %llu", (unsigned long long)number,
                   (unsigned long long)i);
    }
    pir_scene_destroy(p->scene);
    for (int i = 0; i < SHAPES; i++)
        pir_body_shape_release(p->shape[i]);
    for (int i = 0; i < SNAPSHOTS; i++) {
        free(p->snapshot[i].bytes);
        p->snapshot[i].bytes = NULL;
    }
    pir_polytope_release(p->probe);
    p->given = 0;
    p->restored = 0;
}

static void programs_with_errors_harm_nothing(void **state) {
    (void)state;
    static struct program p;
    const char *asked = getenv("PIR_TEST_CALLS");
    const uint64_t calls = asked ? strtoull(asked, NULL, 10) : 20000, each = 2000;
    for (uint64_t n = 0; n * each < calls; n++)
        run(&p, n, each);
    print_message("%llu calls, %llu with ids of no body, %llu bodies removed while events were read\n",
                  (unsigned long long)p.calls, (unsigned long long)p.stale, (unsigned long long)p.removed_in_events);
    assert_true(p.stale > calls / 50 && p.removed_in_events > calls / 1000);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(programs_with_errors_harm_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/*
 * Calls that fill an array of the caller's, all by one rule: whatever its capacity they are PIR_OK with the count of
 * all there is, write as many as there is room for and nothing behind them. A call that fails writes nothing at all.
 * tests/headers/check_rules.py holds that the table here has every public function with a capacity.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "mesh/mesh_models.h"
#include "scene/scene_bodies.h"
#include "support/memory.h"

#define BODIES 5
#define ROOM   0x8000

/* One of everything that such calls are on, placed so that each has several things to tell. */
struct world {
    pir_polytope *cube;
    pir_sum *sum;
    pir_query *query;
    pir_workspace *workspace;
    pir_pair *pair;
    test_memory memory; /* of the scene */
    pir_scene *scene;
    pir_trimesh *mesh;
    pir_trimesh_pair *meshes;
    pir_clash_body *tetrahedron;
    pir_solid_contacts *contacts;
    double height; /* where what is asked about stands; not a number makes the call fail */
};

typedef pir_status asker(struct world *w, size_t capacity, void *array, size_t *count);

static pir_query_input query_input(const struct world *w) {
    pir_query_input input = pir_query_input_default();
    input.translation.z = w->height;
    input.margin = 0.5;
    return input;
}

static pir_pair_input pair_input(const struct world *w) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p.translation.z = w->height;
    input.margin = 0.5;
    return input;
}

static pir_scene_shape shape_of(const struct world *w) {
    pir_scene_shape shape = pir_scene_shape_default(w->cube);
    shape.pose.translation.z = w->height;
    return shape;
}

static pir_status ask_query_manifold(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_query_input input = query_input(w), right = input;
    pir_query_result answer;
    right.translation.z = 1.75;
    assert_int_equal(pir_query_signed_distance(w->query, &right, NULL, &answer), PIR_OK);
    return pir_query_manifold(w->query, &input, &answer, capacity, array, count);
}

static pir_status ask_query_escapes(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_query_input input = query_input(w);
    return pir_query_escapes(w->query, &input, 10, capacity, array, count);
}

static pir_status ask_pair_manifold(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_pair_input input = pair_input(w), right = input;
    pir_query_result answer;
    right.pose_p.translation.z = 1.75;
    assert_int_equal(pir_pair_signed_distance(w->pair, w->workspace, &right, &answer), PIR_OK);
    return pir_pair_manifold(w->pair, w->workspace, &input, &answer, capacity, array, count);
}

static pir_status ask_pair_escapes(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_pair_input input = pair_input(w);
    return pir_pair_escapes(w->pair, w->workspace, &input, 10, capacity, array, count);
}

static pir_status ask_query_active(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_query_input input = query_input(w);
    return pir_query_active(w->query, &input, 10, capacity, array, count);
}

static pir_status ask_pair_active(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_pair_input input = pair_input(w);
    return pir_pair_active(w->pair, w->workspace, &input, 10, capacity, array, count);
}

static pir_status ask_scene_overlap(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_scene_shape shape = shape_of(w);
    return pir_scene_overlap(w->scene, &shape, capacity, array, count);
}

static pir_status ask_scene_distances(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_scene_shape shape = shape_of(w);
    return pir_scene_distances(w->scene, &shape, HUGE_VAL, (pir_accuracy){0, 0}, capacity, array, count);
}

static pir_status ask_scene_ray_all(struct world *w, size_t capacity, void *array, size_t *count) {
    return pir_scene_ray_all(w->scene, (pir_vec3){0.1, 0.2, w->height - 8}, (pir_vec3){0, 0, 16}, NULL, capacity, array,
                             count);
}

static pir_status ask_scene_cast_all(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_scene_shape shape = shape_of(w);
    shape.pose.translation.z -= 8;
    const pir_motion motion = {{0, 0, 16}, {0, 0, 0}, 0};
    return pir_scene_cast_all(w->scene, &shape, &motion, 1e-3, capacity, array, count);
}

static pir_status ask_scene_in_box(struct world *w, size_t capacity, void *array, size_t *count) {
    const pir_scene_box box = pir_scene_box_default((pir_vec3){-1, -1, w->height - 9}, (pir_vec3){1, 1, 9});
    return pir_scene_in_box(w->scene, &box, capacity, array, count);
}

static pir_status ask_surface_ray_all(struct world *w, size_t capacity, void *array, size_t *count) {
    const pir_surface_ray ray = {{0.1, 0.2, w->height - 8}, {0, 0, 16}, PIR_RAY_BOTH};
    return pir_surface_ray_all((pir_surface_ref){w->mesh, NULL}, &ray, capacity, array, count);
}

static pir_status ask_surface_box(struct world *w, size_t capacity, void *array, size_t *count) {
    return pir_surface_box((pir_surface_ref){w->mesh, NULL}, (pir_vec3){-1, -1, w->height - 9}, (pir_vec3){1, 1, 9},
                           capacity, array, count);
}

static pir_status ask_trimesh_pair_within(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_within_input input = pir_within_input_default();
    input.pose_p.translation.z = w->height - 1.5;
    input.distance = 0.5;
    return pir_trimesh_pair_within(w->meshes, &input, capacity, array, count);
}

static pir_status ask_clash_pairs(struct world *w, size_t capacity, void *array, size_t *count) {
    pir_clash_body *const bodies[] = {w->tetrahedron, w->tetrahedron, w->tetrahedron};
    return pir_clash_pairs(bodies, 3, w->height, capacity, array, count);
}

static pir_status ask_solid_contacts(struct world *w, size_t capacity, void *array, size_t *count) {
    const pir_pair_input input = pair_input(w);
    return pir_solid_contacts_find(w->contacts, w->workspace, &input, capacity, array, count);
}

/* `in_part`: of fewer there are the first, not any; the others give any of them. */
static const struct {
    const char *name;
    asker *ask;
    size_t size;
    bool in_part;
} calls[] = {
    {"pir_query_manifold", ask_query_manifold, sizeof(pir_contact), true},
    {"pir_query_escapes", ask_query_escapes, sizeof(pir_escape), true},
    {"pir_pair_manifold", ask_pair_manifold, sizeof(pir_contact), true},
    {"pir_pair_escapes", ask_pair_escapes, sizeof(pir_escape), true},
    {"pir_query_active", ask_query_active, sizeof(pir_active), true},
    {"pir_pair_active", ask_pair_active, sizeof(pir_active), true},
    {"pir_scene_overlap", ask_scene_overlap, sizeof(pir_scene_hit), true},
    {"pir_scene_distances", ask_scene_distances, sizeof(pir_scene_distance), true},
    {"pir_scene_ray_all", ask_scene_ray_all, sizeof(pir_impact), true},
    {"pir_scene_cast_all", ask_scene_cast_all, sizeof(pir_impact), true},
    {"pir_scene_in_box", ask_scene_in_box, sizeof(pir_scene_part), true},
    {"pir_surface_ray_all", ask_surface_ray_all, sizeof(pir_ray_hit), false},
    {"pir_surface_box", ask_surface_box, sizeof(uint32_t), false},
    {"pir_trimesh_pair_within", ask_trimesh_pair_within, sizeof(pir_triangle_pair), false},
    {"pir_clash_pairs", ask_clash_pairs, sizeof(pir_clash_pair), true},
    {"pir_solid_contacts_find", ask_solid_contacts, sizeof(pir_solid_contact), true},
};
enum { CALLS = sizeof calls / sizeof *calls };

static void make_scene(struct world *w) {
    pir_scene_options options = pir_scene_options_default();
    const pir_allocator allocator = test_allocator(&w->memory);
    options.allocator = &allocator;
    assert_int_equal(pir_scene_create(&options, &w->scene), PIR_OK);
    for (int i = 0; i < BODIES; i++)
        scene_add(w->scene, w->cube, scene_at(0.1 * i, 0, 0.2 * (i - 2)), PIR_BODY_STATIC);
}

static pir_clash_body *make_tetrahedron(void) {
    static const pir_vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const uint32_t starts[] = {0, 3, 6, 9, 12}, corners[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const pir_solid_facets facets = {points, 4, starts, corners, 4};
    pir_solid *solid = NULL;
    pir_clash_body *body = NULL;
    assert_int_equal(pir_solid_create(&facets, NULL, NULL, &solid), PIR_OK);
    assert_int_equal(pir_clash_body_create(solid, NULL, &body), PIR_OK);
    pir_solid_release(solid);
    return body;
}

static pir_solid_contacts *make_contacts(const pir_polytope *cube) {
    pir_solid *solid = NULL;
    pir_pieces *pieces = NULL;
    pir_solid_contacts *contacts = NULL;
    assert_int_equal(pir_solid_from_polytope(cube, NULL, &solid), PIR_OK);
    assert_int_equal(pir_solid_decompose(solid, NULL, NULL, &pieces), PIR_OK);
    assert_int_equal(pir_solid_contacts_create(pieces, pieces, NULL, &contacts), PIR_OK);
    pir_pieces_destroy(pieces);
    pir_solid_release(solid);
    return contacts;
}

static void make(struct world *w) {
    mesh_arrays arrays = mesh_bumpy_sphere(1, 0);
    pir_sum_options options = pir_sum_options_default();
    memset(w, 0, sizeof *w);
    w->height = 1.75;
    w->cube = scene_cube(1);
    w->mesh = mesh_of(&arrays, NULL);
    mesh_arrays_clear(&arrays);
    options.difference = true;
    assert_int_equal(pir_sum_create(w->cube, w->cube, (pir_quat){0, 0, 0, 1}, &options, &w->sum), PIR_OK);
    assert_int_equal(pir_query_create(w->sum, &w->query), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &w->workspace), PIR_OK);
    assert_int_equal(pir_pair_create(w->cube, w->cube, NULL, &w->pair), PIR_OK);
    assert_int_equal(pir_trimesh_pair_create(w->mesh, w->mesh, NULL, &w->meshes), PIR_OK);
    w->tetrahedron = make_tetrahedron();
    w->contacts = make_contacts(w->cube);
    make_scene(w);
}

static void clear(struct world *w) {
    pir_solid_contacts_destroy(w->contacts);
    pir_clash_body_destroy(w->tetrahedron);
    pir_trimesh_pair_destroy(w->meshes);
    pir_trimesh_release(w->mesh);
    pir_scene_destroy(w->scene);
    pir_pair_destroy(w->pair);
    pir_workspace_destroy(w->workspace);
    pir_query_destroy(w->query);
    pir_sum_destroy(w->sum);
    pir_polytope_release(w->cube);
}

static void too_little_room_gets_the_count_of_all(void **state) {
    (void)state;
    static unsigned char all[ROOM], some[ROOM], untouched[ROOM];
    struct world w;
    make(&w);
    memset(untouched, 0x5a, sizeof untouched);
    for (int i = 0; i < CALLS; i++) {
        const size_t size = calls[i].size;
        size_t count = 12345, told;
        memcpy(all, untouched, sizeof all);
        assert_int_equal(calls[i].ask(&w, ROOM / size, all, &count), PIR_OK);
        expect(count >= 2 && count < ROOM / size, "%s: %zu of them", calls[i].name, count);
        assert_int_equal(calls[i].ask(&w, 0, NULL, &told), PIR_OK);
        expect(told == count, "%s without room: %zu of %zu", calls[i].name, told, count);
        for (size_t room = 0; room <= count; room++) {
            memcpy(some, untouched, sizeof some);
            told = 12345;
            assert_int_equal(calls[i].ask(&w, room, some, &told), PIR_OK);
            expect(told == count, "%s with room for %zu: %zu of %zu", calls[i].name, room, told, count);
            expect(memcmp(some + room * size, untouched, ROOM - room * size) == 0, "%s writes behind %zu",
                   calls[i].name, room);
            expect(!calls[i].in_part || memcmp(some, all, room * size) == 0, "%s: %zu of them are others",
                   calls[i].name, room);
        }
    }
    clear(&w);
}

static void no_room_and_no_place_for_the_count_are_refused(void **state) {
    (void)state;
    static unsigned char array[ROOM];
    struct world w;
    make(&w);
    for (int i = 0; i < CALLS; i++) {
        size_t count = 12345;
        assert_int_equal(calls[i].ask(&w, 1, NULL, &count), PIR_ERR_ARGUMENT);
        assert_int_equal(count, 12345);
        assert_int_equal(calls[i].ask(&w, 1, array, NULL), PIR_ERR_ARGUMENT);
    }
    clear(&w);
}

static void a_call_that_fails_writes_nothing(void **state) {
    (void)state;
    static unsigned char array[ROOM], untouched[ROOM];
    struct world w;
    make(&w);
    memset(untouched, 0x5a, sizeof untouched);
    w.height = NAN;
    for (int i = 0; i < CALLS; i++) {
        size_t count = 12345;
        memcpy(array, untouched, sizeof array);
        pir_status status = calls[i].ask(&w, ROOM / calls[i].size, array, &count);
        expect(status == PIR_ERR_NOT_FINITE, "%s: status %d", calls[i].name, (int)status);
        expect(count == 12345 && memcmp(array, untouched, sizeof array) == 0, "%s writes", calls[i].name);
    }
    clear(&w);
}

static void a_scene_without_memory_writes_nothing(void **state) {
    (void)state;
    static unsigned char array[ROOM], untouched[ROOM];
    memset(untouched, 0x5a, sizeof untouched);
    for (int i = 0; i < CALLS; i++) {
        if (calls[i].ask != ask_scene_overlap && calls[i].ask != ask_scene_distances)
            continue;
        uint64_t refused = 0;
        bool failed = true;
        for (uint64_t n = 1; failed; n++) {
            struct world w;
            size_t count = 12345;
            make(&w);
            w.memory.fail_at = w.memory.requests + n;
            memcpy(array, untouched, sizeof array);
            pir_status status = calls[i].ask(&w, ROOM / calls[i].size, array, &count);
            failed = w.memory.requests >= w.memory.fail_at;
            // some memory is only good to have
            expect(status == PIR_OK || (failed && status == PIR_ERR_MEMORY), "%s, request %u: status %d", calls[i].name,
                   (unsigned)n, (int)status);
            expect(status == PIR_OK || (count == 12345 && memcmp(array, untouched, sizeof array) == 0), "%s writes",
                   calls[i].name);
            refused += status != PIR_OK;
            clear(&w);
            assert_int_equal(w.memory.blocks, 0);
        }
        expect(refused >= 2, "%s: refused %u times", calls[i].name, (unsigned)refused);
    }
}

static void a_batch_with_a_wrong_translation_writes_nothing(void **state) {
    (void)state;
    enum { COUNT = 9 };
    pir_vec3 at[COUNT];
    pir_state states[COUNT], right[COUNT];
    double depths[COUNT], distances[COUNT], untouched[COUNT];
    struct world w;
    make(&w);
    memset(right, 0x5a, sizeof right);
    memset(untouched, 0x5a, sizeof untouched);
    for (int wrong = 0; wrong < COUNT; wrong++)
        for (int k = 0; k < 2; k++) {
            const pir_status should = k == 0 ? PIR_ERR_NOT_FINITE : PIR_ERR_LIMIT;
            for (int i = 0; i < COUNT; i++)
                at[i] = (pir_vec3){0.3 * i, 0, 1};
            at[wrong].y = k == 0 ? NAN : 1e300;
            memcpy(states, right, sizeof states);
            memcpy(depths, untouched, sizeof depths);
            memcpy(distances, untouched, sizeof distances);
            assert_int_equal(pir_query_batch_states(w.query, at, COUNT, states), should);
            assert_int_equal(pir_query_batch_depths(w.query, at, COUNT, depths, states), should);
            assert_int_equal(pir_query_batch_distances(w.query, at, COUNT, distances, states), should);
            assert_memory_equal(states, right, sizeof states);
            assert_memory_equal(depths, untouched, sizeof depths);
            assert_memory_equal(distances, untouched, sizeof distances);
        }
    clear(&w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(too_little_room_gets_the_count_of_all),
        cmocka_unit_test(no_room_and_no_place_for_the_count_are_refused),
        cmocka_unit_test(a_call_that_fails_writes_nothing),
        cmocka_unit_test(a_scene_without_memory_writes_nothing),
        cmocka_unit_test(a_batch_with_a_wrong_translation_writes_nothing),
    };
    return cmocka_run_group_tests_name("counts", tests, NULL, NULL);
}

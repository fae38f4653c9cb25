/* SPDX-License-Identifier: MIT */
/*
 * Contacts of polytopes with soups of triangles against integers (oracle/contacts.h): the state, which contacts are
 * there and which are ghosts, ways out; at poses in general, touching, and an ulp off. And hostile input, memory that
 * runs out, contacts that hold a body.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/contact_stage.h"
#include "mesh/mesh_models.h"
#include "support/memory.h"

#define CONTACTS 512

static uint64_t poses(void) {
    const char *text = getenv("PIR_TEST_POSES");
    return text ? strtoull(text, NULL, 10) : 300;
}

/* Whether a contact of a normal is told that is as deep as a gap. */
static bool is_told(const pir_surface_contact *contacts, size_t count, pir_vec3 normal, double gap) {
    for (size_t i = 0; i < count; i++)
        if (apart(contacts[i].normal, normal) < 1e-8 && contacts[i].distance < gap + 1e-9)
            return true;
    return false;
}

/*
 * Whether every contact of the union at t, which is apart, is told if its gap is well within `margin`, and each that is
 * told is one. Contacts beyond `most` are not expected.
 */
static void check_contacts(const stage *s, pir_vec3 t, const pir_surface_contact *contacts, size_t count, double margin,
                           uint64_t number) {
    pir_vec3 normal[SOUP_MOST];
    uint32_t found = 0;
    oracle_scene_move(s->truth, t);
    for (uint32_t i = 0; i < s->soup.count; i++) {
        double gap;
        if (!oracle_scene_counts(s->truth, i) || !oracle_scene_contact(s->truth, i, &normal[found], &gap))
            continue;
        expect(gap > margin * (1 - 1e-9) || is_told(contacts, count, normal[found], gap),
               "pose %llu (%s): the contact of triangle %u, gap %.17g, normal %.9g %.9g %.9g, is lost",
               (unsigned long long)number, s->soup.name, i, gap, normal[found].x, normal[found].y, normal[found].z);
        found++;
    }
    for (size_t i = 0; i < count; i++) {
        bool is = false;
        for (uint32_t k = 0; k < found && !is; k++)
            is = apart(contacts[i].normal, normal[k]) < 1e-8;
        for (uint32_t k = 0; k < s->soup.count && !is; k++)
            is = oracle_scene_exposed(s->truth, k, contacts[i].normal);
        expect(is, "pose %llu (%s): a ghost of triangle %u, normal %.9g %.9g %.9g", (unsigned long long)number,
               s->soup.name, contacts[i].triangle, contacts[i].normal.x, contacts[i].normal.y, contacts[i].normal.z);
    }
}

/* Counts of situations, so that none is missing unseen. */
typedef struct tally {
    uint64_t state[3], ghosts, contacts, out, shortest, exact;
} tally;

static void check_way_out(const stage *s, const pir_surface_contact_input *input,
                          const pir_surface_contact_result *result, const pir_surface_contact *contacts,
                          uint64_t number, tally *seen) {
    pir_vec3 t = input->pose.translation, way = result->way_out;
    seen->out += result->is_out;
    seen->shortest += result->is_shortest;
    if (!result->is_out)
        return;
    pir_vec3 there = {t.x + way.x, t.y + way.y, t.z + way.z};
    if (result->is_shortest && result->state == PIR_INSIDE) {
        oracle_scene_move(s->truth, t);
        double least = oracle_scene_way_out(s->truth, 0x1p-26);
        expect(-result->distance <= least + 1e-9, "pose %llu (%s): depth %.17g, but there is a way of %.17g",
               (unsigned long long)number, s->soup.name, -result->distance, least);
    }
    oracle_scene_move(s->truth, there);
    expect(oracle_scene_state(s->truth) == 0, "pose %llu (%s): the way out ends in a triangle",
           (unsigned long long)number, s->soup.name);
    // what is told is there; what lies beyond the margin where P is may be missing
    check_contacts(s, there, contacts, result->contacts, -HUGE_VAL, number);
}

static void check_pose(const stage *s, pir_workspace *workspace, pir_vec3 t, uint64_t number, tally *seen) {
    pir_surface_contact contacts[CONTACTS];
    pir_surface_contact_result result;
    double margin = number % 3 == 0 ? 2 : 0.3;
    const pir_surface_contact_input input = input_of(s, t, margin);
    assert_int_equal(pir_surface_contacts(s->body, workspace, &input, CONTACTS, contacts, &result), PIR_OK);
    oracle_scene_move(s->truth, t);
    int state = oracle_scene_state(s->truth);
    expect((int)result.state == state, "pose %llu (%s): state %d, not %d", (unsigned long long)number, s->soup.name,
           result.state, state);
    seen->state[state]++;
    seen->ghosts += result.counts.ghosts;
    seen->exact += result.counts.exact;
    seen->contacts += result.contacts;
    if (state == 0)
        check_contacts(s, t, contacts, result.contacts, margin, number);
    else
        check_way_out(s, &input, &result, contacts, number, seen);
}

static void no_ghost_is_told_and_no_contact_lost(void **state) {
    (void)state;
    tally seen = {{0, 0, 0}, 0, 0, 0, 0, 0};
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t number = 0; number < poses() / 6; number++) {
        test_random random = test_random_case("contacts of soups", number);
        stage s;
        stage_make(&s, &random, number);
        for (int i = 0; i < 6; i++)
            check_pose(&s, workspace, some_place(&random, &s), number, &seen);
        stage_clear(&s);
    }
    pir_workspace_destroy(workspace);
    print_message("states %llu %llu %llu, contacts %llu, ghosts %llu, out %llu, shortest %llu, exact %llu\n",
                  (unsigned long long)seen.state[0], (unsigned long long)seen.state[1],
                  (unsigned long long)seen.state[2], (unsigned long long)seen.contacts, (unsigned long long)seen.ghosts,
                  (unsigned long long)seen.out, (unsigned long long)seen.shortest, (unsigned long long)seen.exact);
    assert_true(seen.state[0] > 0 && seen.state[1] > 0 && seen.state[2] > 0 && seen.ghosts > 0 && seen.shortest > 0);
}

/* --- bad input, memory --- */

/*
 * Bodies with a radius: the points of a contact are over each other. Where they are judged, they stand on the grid that
 * integers know, which assertions in integers hold.
 */
static void contacts_of_rounded_bodies_are_over_each_other(void **state) {
    (void)state;
    uint64_t told = 0;
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t number = 0; number < poses() / 6; number++) {
        test_random random = test_random_case("rounded bodies", number);
        stage s;
        stage_make(&s, &random, number);
        for (int i = 0; i < 6; i++) {
            pir_surface_contact contacts[CONTACTS];
            pir_surface_contact_result rounded;
            pir_surface_contact_input input = input_of(&s, some_place(&random, &s), 0.5);
            input.radius = i % 2 ? 0.15 : 0x1p-4;
            assert_int_equal(pir_surface_contacts(s.body, workspace, &input, CONTACTS, contacts, &rounded), PIR_OK);
            for (size_t k = 0; k < rounded.contacts; k++, told++) {
                const pir_surface_contact *c = &contacts[k];
                const pir_vec3 over = {c->point_q.x + c->distance * c->normal.x,
                                       c->point_q.y + c->distance * c->normal.y,
                                       c->point_q.z + c->distance * c->normal.z};
                expect(apart(over, c->point_p) < 1e-12, "pose %llu: contact %zu", (unsigned long long)number, k);
            }
        }
        stage_clear(&s);
    }
    pir_workspace_destroy(workspace);
    assert_true(told > poses() / 10);
}

static void bad_input_is_refused_and_nothing_written(void **state) {
    (void)state;
    mesh_arrays plane = mesh_plane(4);
    pir_trimesh *mesh = mesh_of(&plane, NULL);
    pir_vec3 point = {0, 0, 0};
    pir_polytope *body;
    pir_workspace *workspace;
    assert_int_equal(pir_polytope_create(&point, 1, NULL, &body), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()}, none = {{NULL, NULL}, pir_pose_identity()};
    pir_surface_contact_input good = pir_surface_contact_input_default(), input;
    pir_surface_contact contact;
    pir_surface_contact_result result, before;
    memset(&before, 0x55, sizeof before);
    good.surfaces = &surface;
    good.surface_count = 1;
    struct {
        pir_status want;
        pir_surface_contact_input input;
    } bad[9];
    for (int i = 0; i < 9; i++)
        bad[i].input = good;
    bad[0].want = PIR_ERR_ARGUMENT, bad[0].input.surface_count = 0;
    bad[1].want = PIR_ERR_ARGUMENT, bad[1].input.surfaces = &none;
    bad[2].want = PIR_ERR_ARGUMENT, bad[2].input.radius = -1;
    bad[3].want = PIR_ERR_ARGUMENT, bad[3].input.margin = HUGE_VAL;
    bad[4].want = PIR_ERR_NOT_FINITE, bad[4].input.margin = NAN;
    bad[5].want = PIR_ERR_NOT_FINITE, bad[5].input.pose.translation.y = NAN;
    bad[6].want = PIR_ERR_ZERO_QUATERNION, bad[6].input.pose.rotation.w = 0;
    bad[7].want = PIR_ERR_LIMIT, bad[7].input.pose.translation.x = 0x1p61;
    bad[8].want = PIR_ERR_LIMIT, bad[8].input.radius = 0x1p61;
    for (int i = 0; i < 9; i++) {
        result = before;
        expect(pir_surface_contacts(body, workspace, &bad[i].input, 1, &contact, &result) == bad[i].want, "input %d",
               i);
        assert_memory_equal(&result, &before, sizeof result);
    }
    input = good;
    assert_int_equal(pir_surface_contacts(NULL, workspace, &input, 1, &contact, &result), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_surface_contacts(body, NULL, &input, 1, &contact, &result), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_surface_contacts(body, workspace, NULL, 1, &contact, &result), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_surface_contacts(body, workspace, &input, 1, NULL, &result), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_surface_contacts(body, workspace, &input, 0, NULL, &result), PIR_OK);
    pir_workspace_destroy(workspace);
    pir_polytope_release(body);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&plane);
}

/* A cube of side 1. */
static pir_polytope *cube(void) {
    pir_vec3 corner[8];
    pir_polytope *body;
    for (int i = 0; i < 8; i++)
        corner[i] = (pir_vec3){i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5};
    assert_int_equal(pir_polytope_create(corner, 8, NULL, &body), PIR_OK);
    return body;
}

static pir_status ask(pir_workspace *workspace, const pir_polytope *body, pir_trimesh *mesh, double height,
                      pir_surface_contact_result *ret_result) {
    const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
    pir_surface_contact_input input = pir_surface_contact_input_default();
    pir_surface_contact contacts[16];
    input.pose = (pir_pose){{0.001, 0, 0.2, 1}, {2.1, 2.2, height}};
    input.margin = 0.1;
    input.surfaces = &surface;
    input.surface_count = 1;
    return pir_surface_contacts(body, workspace, &input, 16, contacts, ret_result);
}

static void a_call_that_runs_out_of_memory_changes_nothing(void **state) {
    (void)state;
    mesh_arrays plane = mesh_plane(8);
    pir_trimesh *mesh = mesh_of(&plane, NULL);
    pir_polytope *body = cube();
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    pir_surface_contact_result want, got;
    bool failed = true;
    for (uint64_t at = 1; failed; at++) {
        pir_workspace *workspace = NULL;
        memory.requests = 0;
        memory.fail_at = at;
        pir_status status = pir_workspace_create(&allocator, &workspace);
        if (status == PIR_OK)
            status = ask(workspace, body, mesh, 0.49, &got);
        failed = status == PIR_ERR_MEMORY;
        assert_true(failed || status == PIR_OK);
        memory.fail_at = 0;
        if (workspace) {
            assert_int_equal(ask(workspace, body, mesh, 0.49, &want), PIR_OK);
            assert_true(failed || (got.distance == want.distance && got.contacts == want.contacts));
        }
        pir_workspace_destroy(workspace);
        assert_true(memory.blocks == 0 && !memory.wrong_size && !memory.overrun);
        assert_true(at < 100);
    }
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(&allocator, &workspace), PIR_OK);
    for (int round = 0; round < 2; round++) {
        memory.requests = 0;
        for (int i = 0; i < 100; i++)
            assert_int_equal(ask(workspace, body, mesh, 0.4 + 0.002 * i, &got), PIR_OK);
    }
    assert_int_equal(memory.requests, 0);
    pir_workspace_destroy(workspace);
    pir_polytope_release(body);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&plane);
}

/* --- sizes, crowds --- */

static pir_trimesh *square(double side) {
    const pir_vec3 corner[4] = {{-side, -side, 0}, {side, -side, 0}, {side, side, 0}, {-side, side, 0}};
    static const uint32_t triangle[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const pir_trimesh_arrays arrays = {
        .vertices = corner, .vertex_count = 4, .triangles = &triangle[0][0], .triangle_count = 2};
    pir_trimesh *mesh;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    return mesh;
}

/* A cube of side 1 over a floor, both scaled: four contacts, straight up, wherever doubles reach. */
static void floors_are_flat_at_any_size(void **state) {
    (void)state;
    static const int exponents[6] = {57, 40, 20, -20, -100, -200};
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (int i = 0; i < 6; i++) {
        double unit = ldexp(1, exponents[i]);
        pir_vec3 corner[8];
        pir_polytope *body;
        for (int k = 0; k < 8; k++)
            corner[k] = (pir_vec3){k & 1 ? unit : -unit, k & 2 ? unit : -unit, k & 4 ? unit : -unit};
        assert_int_equal(pir_polytope_create(corner, 8, NULL, &body), PIR_OK);
        pir_trimesh *mesh = square(4 * unit);
        const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
        pir_surface_contact_input input = pir_surface_contact_input_default();
        input.margin = 0.5 * unit;
        input.surfaces = &surface;
        input.surface_count = 1;
        for (int over = -1; over <= 1; over++) {
            pir_surface_contact contacts[8];
            pir_surface_contact_result result;
            input.pose.translation = (pir_vec3){0.25 * unit, 0.375 * unit, (1 + 0.125 * over) * unit};
            assert_int_equal(pir_surface_contacts(body, workspace, &input, 8, contacts, &result), PIR_OK);
            expect((int)result.state == 1 - over, "unit 2^%d, %d: state %d", exponents[i], over, result.state);
            expect(result.contacts == 4, "unit 2^%d, %d: %zu contacts", exponents[i], over, result.contacts);
            for (size_t k = 0; k < result.contacts; k++)
                expect(contacts[k].normal.z > 1 - 1e-12 && fabs(contacts[k].distance / unit - 0.125 * over) < 1e-9,
                       "unit 2^%d, %d: normal %.17g, distance %.17g", exponents[i], over, contacts[k].normal.z,
                       contacts[k].distance / unit);
        }
        pir_polytope_release(body);
        pir_trimesh_release(mesh);
    }
    pir_workspace_destroy(workspace);
}

/* Segments through the middle of a side, turned out of its line by an angle that doubles make nothing of. */
static void a_segment_nearly_along_a_side_touches(void **state) {
    (void)state;
    const pir_vec3 corner[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const uint32_t triangle[3] = {0, 1, 2};
    const pir_trimesh_arrays arrays = {
        .vertices = corner, .vertex_count = 3, .triangles = triangle, .triangle_count = 1};
    pir_trimesh_options options = pir_trimesh_options_default();
    options.two_sided = true;
    pir_trimesh *mesh;
    pir_workspace *workspace;
    assert_int_equal(pir_trimesh_create(&arrays, &options, NULL, &mesh), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
    pir_surface_contact_input input = pir_surface_contact_input_default();
    input.surfaces = &surface;
    input.surface_count = 1;
    for (int e = -60; e <= -4; e++) {
        const double off = ldexp(1, e);
        const pir_vec3 end[2] = {{-0.25, off, off}, {0.25, -off, -off}};
        pir_polytope *body;
        assert_int_equal(pir_polytope_create(end, 2, NULL, &body), PIR_OK);
        for (int k = -1; k <= 1; k++) {
            pir_surface_contact_result r;
            input.pose.translation = (pir_vec3){0.5, k * off * 0x1p-20, 0};
            assert_int_equal(pir_surface_contacts(body, workspace, &input, 0, NULL, &r), PIR_OK);
            const pir_state want = k < 0 ? PIR_OUTSIDE : k > 0 ? PIR_INSIDE : PIR_BOUNDARY;
            expect(r.state == want, "2^%d, %d: state %d", e, k, (int)r.state);
        }
        pir_polytope_release(body);
    }
    pir_workspace_destroy(workspace);
    pir_trimesh_release(mesh);
}

/* Contacts of a body with a soup of two-sided triangles, as they stand. */
static pir_surface_contact_result ask_soup(const pir_vec3 *vertex, uint32_t vertices, const pir_vec3 (*triangle)[3],
                                           uint32_t triangles, pir_vec3 at) {
    uint32_t corner[SOUP_MOST * 3];
    for (uint32_t i = 0; i < 3 * triangles; i++)
        corner[i] = i;
    const pir_trimesh_arrays arrays = {
        .vertices = triangle, .vertex_count = 3 * triangles, .triangles = corner, .triangle_count = triangles};
    pir_trimesh_options options = pir_trimesh_options_default();
    options.two_sided = true;
    pir_trimesh *mesh;
    pir_polytope *body;
    pir_workspace *workspace;
    pir_surface_contact_result result;
    pir_surface_contact_input input = pir_surface_contact_input_default();
    assert_int_equal(pir_trimesh_create(&arrays, &options, NULL, &mesh), PIR_OK);
    assert_int_equal(pir_polytope_create(vertex, vertices, NULL, &body), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
    input.surfaces = &surface;
    input.surface_count = 1;
    input.margin = 1;
    input.pose.translation = at;
    assert_int_equal(pir_surface_contacts(body, workspace, &input, 0, NULL, &result), PIR_OK);
    pir_workspace_destroy(workspace);
    pir_polytope_release(body);
    pir_trimesh_release(mesh);
    return result;
}

/* A point over the middle of a side: the nearer it is, the less doubles know of where it is seen from there. */
static void normals_are_true_however_near_a_point_is(void **state) {
    (void)state;
    const pir_vec3 triangle[1][3] = {{{2, -1.5, -0.25}, {0, 2, -0.5}, {-0.5, -2, 0.5}}}, point = {-0.25, 0, 0};
    const double length = sqrt(0.25 + 16 + 16.25 * 16.25);
    const pir_vec3 want = {0.5 / length, 4 / length, 16.25 / length};
    for (int e = -60; e <= 0; e++) {
        const pir_surface_contact_result r = ask_soup(&point, 1, triangle, 1, (pir_vec3){0, 0, ldexp(1, e - 1)});
        expect(r.state == PIR_OUTSIDE && apart(r.normal, want) < 1e-9, "2^%d: normal %.17g %.17g %.17g", e - 1,
               r.normal.x, r.normal.y, r.normal.z);
    }
}

/* A segment over the diagonal of a square of two triangles that an ulp parts: each has a contact of its own there. */
static void an_ulp_between_two_triangles_makes_two_normals(void **state) {
    (void)state;
    const double less = -0x1.fffffffffffffp+0, more = 0x1.0000000000001p+1, off = 0x1p-53;
    const pir_vec3 corner[6] = {{less, -2, off}, {more, less, 0},   {2, 2, 0},
                                {less, less, 0}, {more, more, off}, {-2, more, 0}};
    static const uint32_t triangle[6] = {0, 1, 2, 3, 4, 5};
    const pir_vec3 end[2] = {{-0.5, -0.5, 0}, {0.5, -0.5, 0}};
    const pir_trimesh_arrays arrays = {
        .vertices = corner, .vertex_count = 6, .triangles = triangle, .triangle_count = 2};
    pir_trimesh *mesh;
    pir_polytope *body;
    pir_workspace *workspace;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    assert_int_equal(pir_polytope_create(end, 2, NULL, &body), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
    pir_surface_contact_input input = pir_surface_contact_input_default();
    pir_surface_contact contacts[16];
    pir_surface_contact_result r;
    input.pose = (pir_pose){{1, 1, 1, 1}, {0.875, 1.375, 0.50000000100000008}};
    input.margin = 2;
    input.surfaces = &surface;
    input.surface_count = 1;
    assert_int_equal(pir_surface_contacts(body, workspace, &input, 16, contacts, &r), PIR_OK);
    bool level = false, tilted = false;
    for (size_t i = 0; i < r.contacts; i++) {
        level |= fabs(contacts[i].normal.x) < 1e-12;
        tilted |= fabs(contacts[i].normal.x + 3.12250209e-8) < 1e-12 && contacts[i].triangle == 0;
    }
    assert_true(r.state == PIR_OUTSIDE && level && tilted);
    pir_workspace_destroy(workspace);
    pir_polytope_release(body);
    pir_trimesh_release(mesh);
}

/* A cube flush with the wall of a step, and less than an ulp of its height deep in the uneven floor before it. */
static void what_is_told_as_the_shortest_way_is_no_longer(void **state) {
    (void)state;
    const pir_vec3 triangle[6][3] = {
        {{-2, -2, -4.7558878029239657e-13}, {0, -2, 8.3184525684677428e-13}, {0, 2, -1.4067213543162949e-13}},
        {{-2, -2, 1.2163923910622101e-13}, {0, 2, -2.3807465025239881e-13}, {-2, 2, 2.9691528147718186e-13}},
        {{0, 2, 0.49999999999921907}, {0, 2, 5.838517062290678e-13}, {0, -2, 7.1714463365748773e-14}},
        {{0, 2, 0.5000000000003102}, {0, -2, 3.6111053299485608e-13}, {0, -2, 0.4999999999994133}},
        {{0, -2, 0.49999999999951289}, {2, -2, 0.5000000000008501}, {2, 2, 0.49999999999997491}},
        {{0, -2, 0.50000000000079214}, {2, 2, 0.49999999999980849}, {0, 2, 0.49999999999975625}}};
    pir_vec3 corner[8];
    for (int i = 0; i < 8; i++)
        corner[i] = (pir_vec3){i & 1 ? 0.5 : -0.5, i & 2 ? 0.25 : -0.25, i & 4 ? 0.25 : -0.25};
    for (int i = 0; i < 40; i++) {
        const pir_vec3 at = {-0.5, 1.5 - 0.05 * i, 0.25};
        const pir_surface_contact_result r = ask_soup(corner, 8, triangle, 6, at);
        expect(r.state != PIR_INSIDE || !r.is_shortest || r.distance > -1e-9, "%d: depth %.17g", i, -r.distance);
    }
    // the floor that it is beside is higher than that under it by less than a step
    const pir_vec3 floors[2][3] = {{{0, -9, 0}, {0, 9, 0}, {-18, 0, 0}}, {{0, 9, 2e-9}, {0, -9, 2e-9}, {18, 0, 2e-9}}};
    const pir_surface_contact_result r = ask_soup(corner, 8, floors, 2, (pir_vec3){-0.5, 0, 0.25 - 0x1p-10});
    expect(!r.is_shortest || fabs(r.distance + 0x1p-10) < 1e-10, "depth %.17g", -r.distance);
}

static void triangles_all_through_one_point_end_in_bounded_time(void **state) {
    (void)state;
    pir_polytope *body = cube();
    pir_workspace *workspace;
    pir_surface_contact_result result;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    mesh_arrays fan = mesh_fan(3000), crowd = mesh_fan(70000);
    pir_trimesh *mesh = mesh_of(&fan, NULL), *many = mesh_of(&crowd, NULL);
    for (int i = 0; i < 4; i++) {
        const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
        pir_surface_contact_input input = pir_surface_contact_input_default();
        pir_surface_contact contacts[16];
        input.pose.rotation = (pir_quat){0.1, 0.2, 0.05, 1};
        input.pose.translation = (pir_vec3){0.1, 0.05, 0.3 + 0.2 * i};
        input.margin = 0.1;
        input.surfaces = &surface;
        input.surface_count = 1;
        assert_int_equal(pir_surface_contacts(body, workspace, &input, 16, contacts, &result), PIR_OK);
    }
    assert_int_equal(ask(workspace, body, many, 0, &result), PIR_OK);
    pir_vec3 point = {0, 0, 0};
    pir_polytope_release(body);
    assert_int_equal(pir_polytope_create(&point, 1, NULL, &body), PIR_OK);
    const pir_posed_surface surface = {{many, NULL}, pir_pose_identity()};
    pir_surface_contact_input input = pir_surface_contact_input_default();
    input.surfaces = &surface;
    input.surface_count = 1;
    assert_int_equal(pir_surface_contacts(body, workspace, &input, 0, NULL, &result), PIR_ERR_LIMIT);
    pir_workspace_destroy(workspace);
    pir_polytope_release(body);
    pir_trimesh_release(mesh);
    pir_trimesh_release(many);
    mesh_arrays_clear(&fan);
    mesh_arrays_clear(&crowd);
}

/* --- what a contact says --- */

/* A field of 4 × 4 cells of side 1, whose materials are the numbers of cells plus 100; cell 5 may be a hole. */
static pir_height_field *small_field(bool hole) {
    static const float heights[25];
    uint32_t materials[16];
    uint8_t holes[16] = {0};
    for (uint32_t i = 0; i < 16; i++)
        materials[i] = 100 + i;
    holes[5] = hole;
    const pir_height_samples samples = {.heights = heights,
                                        .type = PIR_NUMBERS_FLOAT,
                                        .columns = 5,
                                        .rows = 5,
                                        .step_x = 1,
                                        .step_y = 1,
                                        .materials = materials,
                                        .holes = holes};
    pir_height_field *field;
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &field), PIR_OK);
    return field;
}

static void contacts_carry_material_and_keep_their_ids(void **state) {
    (void)state;
    pir_height_field *field = small_field(false);
    pir_polytope *body = cube();
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    const pir_posed_surface surface = {{NULL, field}, {{0, 0, 0, 1}, {10, 0, 0}}};
    pir_surface_contact_input input = pir_surface_contact_input_default();
    pir_surface_contact before[8], after[8];
    pir_surface_contact_result result;
    input.margin = 0.01;
    input.surfaces = &surface;
    input.surface_count = 1;
    input.pose = (pir_pose){{1e-3, 2e-3, 0.3, 1}, {11.9, 2.1, 0.503}};
    assert_int_equal(pir_surface_contacts(body, workspace, &input, 8, before, &result), PIR_OK);
    assert_int_equal(result.contacts, 4);
    input.pose.translation.x += 1e-3;
    assert_int_equal(pir_surface_contacts(body, workspace, &input, 8, after, &result), PIR_OK);
    assert_int_equal(result.contacts, 4);
    for (size_t i = 0; i < 4; i++) {
        bool found = false;
        uint32_t column = (uint32_t)(before[i].point_q.x - 10), row = (uint32_t)before[i].point_q.y;
        assert_int_equal(before[i].material, 100 + 4 * row + column);
        assert_int_equal(before[i].triangle / 2, 4 * row + column);
        for (size_t k = 0; k < 4; k++) {
            found |= after[k].id == before[i].id;
            assert_true(k == i || before[k].id != before[i].id);
        }
        assert_true(found);
    }
    pir_workspace_destroy(workspace);
    pir_polytope_release(body);
    pir_height_field_release(field);
}

/* A small box over a hole falls through; one that is as wide as the hole rests on its rim. */
static void holes_are_open_and_their_rims_hold(void **state) {
    (void)state;
    pir_height_field *field = small_field(true);
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    const pir_posed_surface surface = {{NULL, field}, pir_pose_identity()};
    for (int wide = 0; wide < 2; wide++) {
        pir_vec3 corner[8];
        pir_polytope *body;
        double half = wide ? 0.6 : 0.4;
        for (int k = 0; k < 8; k++)
            corner[k] = (pir_vec3){k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? 0.5 : -0.5};
        assert_int_equal(pir_polytope_create(corner, 8, NULL, &body), PIR_OK);
        pir_surface_contact_input input = pir_surface_contact_input_default();
        pir_surface_contact contacts[8];
        pir_surface_contact_result result;
        input.margin = 0.01;
        input.surfaces = &surface;
        input.surface_count = 1;
        input.pose.translation = (pir_vec3){1.5, 1.5, 0.505};
        assert_int_equal(pir_surface_contacts(body, workspace, &input, 8, contacts, &result), PIR_OK);
        assert_int_equal(result.contacts, wide ? 4 : 0);
        for (size_t i = 0; i < result.contacts; i++)
            assert_true(contacts[i].normal.z > 1 - 1e-12 && fabs(contacts[i].distance - 0.005) < 1e-12);
        pir_polytope_release(body);
    }
    pir_workspace_destroy(workspace);
    pir_height_field_release(field);
}

/* --- bodies with a radius --- */

/* Triangles as one one-sided mesh at a pose, and in the world for brute force. */
typedef struct ground {
    pir_trimesh *mesh;
    pir_posed_surface surface;
    pir_vec3 corner[64][3];
    uint32_t count;
} ground;

static void ground_make(ground *g, pir_pose pose) {
    uint32_t number[64][3];
    for (uint32_t i = 0; i < g->count; i++)
        for (uint32_t k = 0; k < 3; k++)
            number[i][k] = 3 * i + k;
    const pir_trimesh_arrays arrays = {.vertices = g->corner,
                                       .vertex_count = 3 * (size_t)g->count,
                                       .triangles = &number[0][0],
                                       .triangle_count = g->count};
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &g->mesh), PIR_OK);
    g->surface = (pir_posed_surface){{g->mesh, NULL}, pose};
    for (uint32_t i = 0; i < g->count; i++)
        for (uint32_t k = 0; k < 3; k++)
            g->corner[i][k] = pir_pose_apply(pose, g->corner[i][k]);
}

/* Four by four cells of side 1 about the origin, each corner up to `rough` high. */
static ground floor_of(test_random *random, double rough, pir_pose pose) {
    ground g = {.count = 0};
    pir_vec3 at[5][5];
    for (int x = 0; x < 5; x++)
        for (int y = 0; y < 5; y++)
            at[x][y] = (pir_vec3){x - 2, y - 2, rough * fabs(test_random_unit(random))};
    for (int x = 0; x < 4; x++)
        for (int y = 0; y < 4; y++) {
            const pir_vec3 two[2][3] = {{at[x][y], at[x + 1][y], at[x + 1][y + 1]},
                                        {at[x][y], at[x + 1][y + 1], at[x][y + 1]}};
            memcpy(g.corner[g.count], two, sizeof two);
            g.count += 2;
        }
    ground_make(&g, pose);
    return g;
}

/* The surface of a cube of side 1, seen from outside. */
static ground cube_ground(void) {
    ground g = {.count = 0};
    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2) {
            pir_vec3 c[4];
            for (int k = 0; k < 4; k++) {
                double x[3], a = k == 1 || k == 2 ? 0.5 : -0.5, b = k >= 2 ? 0.5 : -0.5;
                x[axis] = 0.5 * side;
                x[(axis + 1) % 3] = side > 0 ? a : b;
                x[(axis + 2) % 3] = side > 0 ? b : a;
                c[k] = (pir_vec3){x[0], x[1], x[2]};
            }
            const pir_vec3 two[2][3] = {{c[0], c[1], c[2]}, {c[0], c[2], c[3]}};
            memcpy(g.corner[g.count], two, sizeof two);
            g.count += 2;
        }
    ground_make(&g, pir_pose_identity());
    return g;
}

static pir_vec3 minus(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static pir_vec3 plus(pir_vec3 a, pir_vec3 b, double part) {
    return (pir_vec3){a.x + part * b.x, a.y + part * b.y, a.z + part * b.z};
}

static double product(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double length_of(pir_vec3 a) {
    return sqrt(product(a, a));
}

static double from_segment(pir_vec3 p, pir_vec3 a, pir_vec3 b) {
    pir_vec3 e = minus(b, a);
    double part = fmin(1, fmax(0, product(minus(p, a), e) / product(e, e)));
    return length_of(minus(p, plus(a, e, part)));
}

/* From the plane, over the triangle; else from its sides. */
static double from_triangle(pir_vec3 p, const pir_vec3 c[3]) {
    pir_vec3 e = minus(c[1], c[0]), f = minus(c[2], c[0]);
    pir_vec3 n = {e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x};
    double least = HUGE_VAL;
    bool over = true;
    for (int k = 0; k < 3; k++) {
        pir_vec3 s = minus(c[(k + 1) % 3], c[k]), to = minus(p, c[k]);
        pir_vec3 in = {n.y * s.z - n.z * s.y, n.z * s.x - n.x * s.z, n.x * s.y - n.y * s.x};
        over &= product(in, to) >= 0;
        least = fmin(least, from_segment(p, c[k], c[(k + 1) % 3]));
    }
    return over ? fabs(product(n, minus(p, c[0]))) / length_of(n) : least;
}

/* The distance of a segment from all triangles: along it, that from one is convex. */
static double from_ground(const ground *g, pir_vec3 a, pir_vec3 b) {
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < g->count; i++) {
        double low = 0, high = 1;
        for (int step = 0; step < 80; step++) {
            double x = low + (high - low) / 3, y = high - (high - low) / 3;
            double at_x = from_triangle(plus(a, minus(b, a), x), g->corner[i]);
            if (at_x <= from_triangle(plus(a, minus(b, a), y), g->corner[i]))
                high = y;
            else
                low = x;
            least = fmin(least, at_x);
        }
    }
    return least;
}

/* A ball, or a capsule whose segment is `core` long from its origin. */
static pir_polytope *rounded(pir_vec3 core) {
    const pir_vec3 end[2] = {{0, 0, 0}, core};
    pir_polytope *body;
    assert_int_equal(pir_polytope_create(end, length_of(core) > 0 ? 2 : 1, NULL, &body), PIR_OK);
    return body;
}

static pir_surface_contact_input over_ground(const ground *g, pir_vec3 t, double radius) {
    pir_surface_contact_input input = pir_surface_contact_input_default();
    input.pose.translation = t;
    input.radius = radius;
    input.margin = 0.01;
    input.surfaces = &g->surface;
    input.surface_count = 1;
    return input;
}

/* From above to wholly below a floor, flat or turned, by small steps: held with a depth that grows as the steps do. */
static void balls_are_held_until_all_of_them_is_behind_a_floor(void **state) {
    (void)state;
    static const pir_vec3 cores[3] = {{0, 0, 0}, {0.3, 0.1, 0.4}, {0, 0.4, 0}};
    test_random random = test_random_case("balls through floors", 0);
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (int turn = 0; turn < 2; turn++)
        for (int shape = 0; shape < 3; shape++) {
            const pir_pose pose = {turn ? (pir_quat){0.2, -0.4, 0.1, 1} : (pir_quat){0, 0, 0, 1}, {0.1, 0.2, 0.3}};
            const pir_vec3 up = pir_pose_rotate(pose, (pir_vec3){0, 0, 1});
            ground g = floor_of(&random, 0, pose);
            pir_polytope *body = rounded(cores[shape]);
            double tall = product(up, cores[shape]), low = fmin(tall, 0), high = fmax(tall, 0);
            uint32_t held = 0;
            for (int step = 0; step < 1000; step++) {
                double z = 0.5 - low - 0.002 * (step - 2), depth = 0.5 - (z + low);
                pir_surface_contact contacts[8];
                pir_surface_contact_result result;
                const pir_surface_contact_input input =
                    over_ground(&g, pir_pose_apply(pose, (pir_vec3){0.3, 0.1, z}), 0.5);
                assert_int_equal(pir_surface_contacts(body, workspace, &input, 8, contacts, &result), PIR_OK);
                if (fabs(z + high + 0.5) < 1e-9 || fabs(depth) < 1e-9)
                    continue;
                if (z + high < -0.5 || depth < 0) {
                    expect(result.state == PIR_OUTSIDE, "shape %d at %g: state %d", shape, z, result.state);
                    continue;
                }
                held++;
                expect(result.state == PIR_INSIDE && result.contacts > 0 && result.is_out && result.is_shortest &&
                           fabs(result.distance + depth) < 1e-9,
                       "shape %d at %g: state %d, %zu contacts, distance %.17g, depth %.17g, out %d, shortest %d",
                       shape, z, result.state, result.contacts, result.distance, depth, result.is_out,
                       result.is_shortest);
                if (result.contacts > 0)
                    expect(fabs(contacts[0].distance + depth) < 1e-9 && apart(contacts[0].normal, up) < 1e-9,
                           "shape %d at %g: depth %.17g", shape, z, -contacts[0].distance);
                expect(apart(result.way_out, plus((pir_vec3){0, 0, 0}, up, depth)) < 1e-3, "shape %d at %g: way %g",
                       shape, z, result.way_out.z);
            }
            expect(held > 400, "shape %d is held at %u places", shape, held);
            pir_polytope_release(body);
            pir_trimesh_release(g.mesh);
        }
    pir_workspace_destroy(workspace);
}

/* The centre is below the top and beside the side: the side alone pushes, at its own depth. */
static void a_ball_beside_a_cube_is_not_pushed_over_its_top(void **state) {
    (void)state;
    ground g = cube_ground();
    pir_polytope *body = rounded((pir_vec3){0, 0, 0});
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (int i = 1; i < 30; i++) {
        pir_surface_contact contacts[8];
        pir_surface_contact_result result;
        const pir_surface_contact_input input = over_ground(&g, (pir_vec3){0.6, 0.1, 0.5 - 0.01 * i}, 0.3);
        assert_int_equal(pir_surface_contacts(body, workspace, &input, 8, contacts, &result), PIR_OK);
        expect(result.contacts == 1 && contacts[0].normal.x > 1 - 1e-9 && fabs(result.distance + 0.2) < 1e-9,
               "%d: %zu contacts, distance %g", i, result.contacts, result.distance);
        expect(fabs(result.way_out.x - 0.2) < 1e-3 && fabs(result.way_out.z) < 1e-3, "%d: way %g %g", i,
               result.way_out.x, result.way_out.z);
    }
    pir_workspace_destroy(workspace);
    pir_polytope_release(body);
    pir_trimesh_release(g.mesh);
}

static void ways_out_take_the_radius_out_too(void **state) {
    (void)state;
    pir_workspace *workspace;
    uint32_t inside = 0, out = 0, shortest = 0, deep = 0;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t number = 0; number < poses() / 2; number++) {
        test_random random = test_random_case("ways out of balls", number);
        ground g = number % 3 == 2 ? cube_ground() : floor_of(&random, 0.4, pir_pose_identity());
        pir_vec3 core = {0, 0, 0}, t = {test_random_unit(&random), test_random_unit(&random), 0};
        t.z = 0.2 + 0.5 * test_random_unit(&random);
        if (number % 2)
            core = (pir_vec3){0.4 * test_random_unit(&random), 0.4 * test_random_unit(&random), 0.3};
        pir_polytope *body = rounded(core);
        pir_surface_contact contacts[16];
        pir_surface_contact_result result;
        const pir_surface_contact_input input = over_ground(&g, t, 0.5);
        assert_int_equal(pir_surface_contacts(body, workspace, &input, 16, contacts, &result), PIR_OK);
        pir_vec3 there = plus(t, result.way_out, 1);
        double before = from_ground(&g, t, plus(t, core, 1)), after = from_ground(&g, there, plus(there, core, 1));
        if (result.state == PIR_INSIDE) {
            inside++;
            out += result.is_out;
            shortest += result.is_shortest;
            deep += result.distance < -0.5;
            expect(isfinite(result.distance), "pose %llu: inside, at no distance", (unsigned long long)number);
            expect(!result.is_out || after >= 0.5, "pose %llu: the way out ends %.17g from a triangle",
                   (unsigned long long)number, after);
            expect(result.distance < before - 0.5 + 1e-9, "pose %llu: distance %.17g, but the deepest is %.17g",
                   (unsigned long long)number, result.distance, before - 0.5);
            expect(!result.is_out || fabs(length_of(result.way_out) + result.distance) < 2e-3,
                   "pose %llu: a way of %.17g, distance %.17g", (unsigned long long)number, length_of(result.way_out),
                   result.distance);
            // a whole ball that is under a floor is at its back
            expect(!result.is_out || number % 3 == 2 || there.z > 0, "pose %llu: the way out leads under the floor",
                   (unsigned long long)number);
        } else
            expect(before > 0.5 - 1e-9 || g.count > 12, "pose %llu: %.17g from a triangle", (unsigned long long)number,
                   before);
        pir_polytope_release(body);
        pir_trimesh_release(g.mesh);
    }
    print_message("inside %u, out %u, shortest %u, core behind %u\n", inside, out, shortest, deep);
    assert_true(out > inside / 20 * 19 && shortest > inside / 4 && deep > inside / 20);
    pir_workspace_destroy(workspace);
}

/* --- order --- */

static void the_deepest_contacts_come_first_and_are_kept(void **state) {
    (void)state;
    pir_polytope *body = cube();
    pir_workspace *workspace;
    uint32_t many = 0;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t number = 0; number < 200; number++) {
        test_random random = test_random_case("order of contacts", number);
        ground g = floor_of(&random, number % 2 ? 0.2 : 0, pir_pose_identity());
        pir_surface_contact_input input = over_ground(&g, (pir_vec3){0.1, 0.2, 0.5}, 0);
        pir_surface_contact all[CONTACTS], some[4];
        pir_surface_contact_result result;
        input.pose.rotation =
            (pir_quat){0.1 * test_random_unit(&random), 0.1 * test_random_unit(&random), test_random_unit(&random), 1};
        input.margin = 0.2;
        assert_int_equal(pir_surface_contacts(body, workspace, &input, CONTACTS, all, &result), PIR_OK);
        size_t count = result.contacts;
        many += count > 2;
        for (size_t i = 1; i < count; i++)
            expect(all[i].distance >= all[i - 1].distance, "floor %llu: contact %zu is deeper than the one before",
                   (unsigned long long)number, i);
        for (size_t most = 0; most <= 4; most++) {
            assert_int_equal(pir_surface_contacts(body, workspace, &input, most, some, &result), PIR_OK);
            assert_int_equal(result.contacts, most < count ? most : count);
            for (size_t i = 0; i < result.contacts; i++)
                expect(some[i].id == all[i].id && some[i].distance == all[i].distance,
                       "floor %llu: of %zu, contact %zu is not the deepest", (unsigned long long)number, most, i);
        }
        pir_trimesh_release(g.mesh);
    }
    print_message("more than two contacts: %u\n", many);
    assert_true(many > 50);
    pir_workspace_destroy(workspace);
    pir_polytope_release(body);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_ghost_is_told_and_no_contact_lost),
        cmocka_unit_test(contacts_of_rounded_bodies_are_over_each_other),
        cmocka_unit_test(bad_input_is_refused_and_nothing_written),
        cmocka_unit_test(a_call_that_runs_out_of_memory_changes_nothing),
        cmocka_unit_test(floors_are_flat_at_any_size),
        cmocka_unit_test(contacts_carry_material_and_keep_their_ids),
        cmocka_unit_test(holes_are_open_and_their_rims_hold),
        cmocka_unit_test(balls_are_held_until_all_of_them_is_behind_a_floor),
        cmocka_unit_test(a_ball_beside_a_cube_is_not_pushed_over_its_top),
        cmocka_unit_test(ways_out_take_the_radius_out_too),
        cmocka_unit_test(the_deepest_contacts_come_first_and_are_kept),
        cmocka_unit_test(a_segment_nearly_along_a_side_touches),
        cmocka_unit_test(normals_are_true_however_near_a_point_is),
        cmocka_unit_test(an_ulp_between_two_triangles_makes_two_normals),
        cmocka_unit_test(what_is_told_as_the_shortest_way_is_no_longer),
        cmocka_unit_test(triangles_all_through_one_point_end_in_bounded_time),
    };
    return cmocka_run_group_tests_name("contacts of meshes", tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/*
 * Contacts of solids in pieces.
 *
 * Bodies of unit cubes, divided into pieces, on a floor that is divided as well: every contact is one with the floor's
 * top, wherever the body slides, turned about the vertical or not, and four at most stand for all. Convex bodies at any
 * pose near solids that they do not meet: the normals that are told are those that the boundary of the solid alone
 * gives, as one mesh, which has no inner walls. Bodies with walls, at any pose: the nearest contact is as far as they
 * are.
 *
 * PIR_TEST_CASES sets how many bodies and poses there are.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "solid/models.h"
#include "support/memory.h"
#include "support/vectors.h"

enum { MOST = 256 };

static pir_pieces *pieces_of(const pir_solid *solid) {
    pir_pieces *pieces = NULL;
    assert_int_equal(pir_solid_decompose(solid, NULL, NULL, &pieces), PIR_OK);
    return pieces;
}

/* A floor of 16 by 16, of height 1, with towers on its rim, whose walls divide it into pieces. */
static pir_solid *floor_of_pieces(void) {
    cells of = {0};
    solid_facets *facets = calloc(1, sizeof *facets);
    assert_non_null(facets);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            of.full[i][j][0] = true;
    of.full[0][0][1] = of.full[3][1][1] = of.full[1][3][1] = of.full[2][0][1] = of.full[0][2][1] = true;
    solid_add_cells(facets, &of);
    for (uint32_t i = 0; i < facets->points; i++) {
        facets->point[i].x *= 4;
        facets->point[i].y *= 4;
    }
    pir_solid *solid = solid_of_facets(facets);
    free(facets);
    return solid;
}

/* --- sliding --- */

/* A body stands over a floor by `gap`, above or in it: all contacts are with the top. */
static void check_standing(const pir_solid_contact *contact, size_t count, double gap) {
    assert_true(count > 0 && count <= 4);
    for (size_t i = 0; i < count; i++) {
        const pir_solid_contact *c = &contact[i];
        assert_true(fabs(c->normal.x) <= 1e-12 && fabs(c->normal.y) <= 1e-12 && c->normal.z >= 1 - 1e-12);
        assert_true(fabs(c->distance - gap) <= 1e-12);
        assert_true(fabs(c->point_q.z - 1) <= 1e-12 && fabs(c->point_p.z - 1 - gap) <= 1e-12);
    }
}

static void bodies_slide_over_inner_walls_without_ghosts(void **state) {
    (void)state;
    pir_solid *floor = floor_of_pieces();
    pir_pieces *q = pieces_of(floor);
    pir_workspace *workspace = NULL;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    uint64_t frames = 0, contacts = 0;
    for (uint64_t i = 0; i < solid_cases(8); i++) {
        test_random random = test_random_case("sliding solids", i);
        const cells of = cells_random(&random, 1 + test_random_below(&random, 6));
        pir_solid *body = solid_of_cells(&of);
        pir_pieces *p = pieces_of(body);
        pir_solid_contacts *object = NULL;
        pir_solid_info info;
        pir_solid_describe(body, &info);
        assert_int_equal(pir_solid_contacts_create(p, q, NULL, &object), PIR_OK);
        const double turn = i % 2 ? test_random_unit(&random) : 0;
        for (int frame = 0; frame < 20; frame++) {
            // clear of the towers
            const double gap = ldexp(test_random_unit(&random), -10), x = 8 + 1.5 * test_random_unit(&random),
                         y = 8 + 1.5 * test_random_unit(&random);
            pir_pair_input input = pir_pair_input_default();
            pir_solid_contact contact[MOST];
            size_t count = 0;
            input.pose_p.rotation.z = turn;
            const pir_vec3 middle = {(info.low.x + info.high.x) / 2, (info.low.y + info.high.y) / 2, 0};
            const pir_vec3 turned = pir_pose_rotate(input.pose_p, middle);
            input.pose_p.translation = (pir_vec3){x - turned.x, y - turned.y, 1 + gap - info.low.z};
            input.margin = 0.01;
            if (info.high.x - info.low.x > 3 || info.high.y - info.low.y > 3)
                continue;
            assert_int_equal(pir_solid_contacts_find(object, workspace, &input, MOST, contact, &count), PIR_OK);
            check_standing(contact, count, gap);
            frames++;
            contacts += count;
        }
        pir_solid_contacts_destroy(object);
        pir_pieces_destroy(p);
        pir_solid_release(body);
    }
    print_message("%llu frames, %llu contacts\n", (unsigned long long)frames, (unsigned long long)contacts);
    pir_workspace_destroy(workspace);
    pir_pieces_destroy(q);
    pir_solid_release(floor);
}

/* --- against the boundary alone --- */

/* Convex facets, cut into fans. */
static pir_trimesh *boundary_of(const pir_vec3 *point, uint32_t points, const uint32_t *start, const uint32_t *corner,
                                uint32_t facets) {
    uint32_t *cut = malloc(sizeof(uint32_t) * 3 * start[facets]);
    size_t triangles = 0;
    pir_trimesh *mesh = NULL;
    assert_non_null(cut);
    for (uint32_t f = 0; f < facets; f++)
        for (uint32_t i = start[f] + 1; i + 1 < start[f + 1]; i++) {
            cut[3 * triangles] = corner[start[f]];
            cut[3 * triangles + 1] = corner[i];
            cut[3 * triangles++ + 2] = corner[i + 1];
        }
    const pir_trimesh_arrays arrays = {
        .vertices = point, .vertex_count = points, .triangles = cut, .triangle_count = triangles};
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    free(cut);
    return mesh;
}

/* A solid, and its boundary. */
static pir_solid *solid_and_boundary(test_random *random, bool star, pir_trimesh **ret_boundary) {
    if (star) {
        solid_model *model = solid_model_facets("stella", 1);
        assert_non_null(model);
        *ret_boundary = boundary_of(model->point, model->points, model->start, model->corner, model->facets);
        free(model);
        return solid_model_new("stella", 1);
    }
    const cells of = cells_random(random, 2 + test_random_below(random, 20));
    solid_facets *facets = calloc(1, sizeof *facets);
    assert_non_null(facets);
    solid_add_cells(facets, &of);
    *ret_boundary = boundary_of(facets->point, facets->points, facets->start, facets->corner, facets->facets);
    free(facets);
    return solid_of_cells(&of);
}

static bool has_normal(const pir_vec3 *normal, size_t count, pir_vec3 n) {
    for (size_t i = 0; i < count; i++)
        if (test_length(test_add(normal[i], n, -1)) < 1e-9)
            return true;
    return false;
}

/* A random convex body of points, about as large as a cell. */
static pir_polytope *hull_of(test_random *random) {
    for (;;) {
        pir_vec3 v[12];
        const uint32_t count = 4 + test_random_below(random, 9);
        pir_polytope *p = NULL;
        for (uint32_t i = 0; i < count; i++)
            v[i] = (pir_vec3){0.7 * test_random_unit(random), 0.7 * test_random_unit(random),
                              0.7 * test_random_unit(random)};
        assert_int_equal(pir_polytope_create(v, count, NULL, &p), PIR_OK);
        if (pir_polytope_dimension(p) == 3)
            return p;
        pir_polytope_release(p);
    }
}

static pir_pieces *pieces_of_hull(const pir_polytope *p) {
    pir_solid *solid = NULL;
    assert_int_equal(pir_solid_from_polytope(p, NULL, &solid), PIR_OK);
    pir_pieces *pieces = pieces_of(solid);
    pir_solid_release(solid);
    return pieces;
}

/* Moves P along the normal of the distance to the other until it is `gap` apart, or overlaps by as much. */
static bool place(pir_solid_query *query, pir_workspace *workspace, double gap, pir_pair_input *input) {
    for (int i = 0; i < 3; i++) {
        pir_solid_distance told;
        assert_int_equal(pir_solid_query_distance(query, workspace, input, &told), PIR_OK);
        if (told.result.state != PIR_OUTSIDE)
            return false;
        const double by = (i < 2 ? 0.001 : gap) - told.result.distance;
        input->pose_p.translation = test_add(input->pose_p.translation, told.result.normal, by);
    }
    return true;
}

/* The normals of contacts with a solid in pieces are those of its boundary, which has no inner walls. */
static void check_normals(const pir_polytope *p, const pir_trimesh *boundary, pir_solid_contacts *object,
                          pir_workspace *workspace, const pir_pair_input *input, uint64_t number) {
    const pir_posed_surface surface = {{boundary, NULL}, input->pose_q};
    pir_surface_contact_input of = pir_surface_contact_input_default();
    of.pose = input->pose_p;
    of.margin = input->margin;
    of.surfaces = &surface;
    of.surface_count = 1;
    static pir_surface_contact right[MOST];
    static pir_solid_contact told[MOST];
    pir_vec3 right_normal[MOST], told_normal[MOST];
    pir_surface_contact_result result;
    size_t count = 0;
    assert_int_equal(pir_surface_contacts(p, workspace, &of, MOST, right, &result), PIR_OK);
    assert_int_equal(pir_solid_contacts_find(object, workspace, input, MOST, told, &count), PIR_OK);
    assert_true(count <= MOST);
    for (size_t i = 0; i < result.contacts; i++)
        right_normal[i] = right[i].normal;
    for (size_t i = 0; i < count; i++)
        told_normal[i] = told[i].normal;
    for (size_t i = 0; i < count; i++)
        if (!has_normal(right_normal, result.contacts, told_normal[i]))
            fail_msg("case %llu: a ghost along %g %g %g", (unsigned long long)number, told_normal[i].x,
                     told_normal[i].y, told_normal[i].z);
    for (size_t i = 0; i < result.contacts; i++)
        if (!has_normal(told_normal, count, right_normal[i]))
            fail_msg("case %llu: lost along %g %g %g", (unsigned long long)number, right_normal[i].x, right_normal[i].y,
                     right_normal[i].z);
}

/* One body at one pose; whether there was one. */
static bool check_pose(test_random *random, const pir_solid *solid, const pir_pieces *q, const pir_trimesh *boundary,
                       pir_workspace *workspace, uint64_t number) {
    pir_polytope *hull = hull_of(random);
    pir_pieces *p = pieces_of_hull(hull);
    pir_solid_query *query = NULL;
    pir_solid_contacts *object = NULL;
    pir_solid_info info;
    pir_solid_describe(solid, &info);
    assert_int_equal(pir_solid_query_create(p, q, NULL, &query), PIR_OK);
    assert_int_equal(pir_solid_contacts_create(p, q, NULL, &object), PIR_OK);
    pir_pair_input input = pir_pair_input_default();
    const pir_vec3 axis = test_random_direction(random), turn = test_random_direction(random);
    const pir_vec3 way = test_random_direction(random);
    input.pose_q.rotation = (pir_quat){turn.x, turn.y, turn.z, test_random_unit(random)};
    input.pose_p.rotation = (pir_quat){axis.x, axis.y, axis.z, test_random_unit(random)};
    input.pose_p.translation =
        test_add(pir_pose_apply(input.pose_q, info.low), way, 1 + test_length(test_add(info.high, info.low, -1)));
    input.margin = 0.05;
    // where they overlap at an edge or a corner more than one normal leads out, and triangles say which is told
    const double gap = 0.02 + 0.02 * test_random_unit(random);
    const bool placed = place(query, workspace, gap, &input);
    if (placed)
        check_normals(hull, boundary, object, workspace, &input, number);
    pir_solid_contacts_destroy(object);
    pir_solid_query_destroy(query);
    pir_pieces_destroy(p);
    pir_polytope_release(hull);
    return placed;
}

static void contacts_are_those_of_the_boundary(void **state) {
    (void)state;
    uint64_t poses = 0;
    pir_workspace *workspace = NULL;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < solid_cases(8); i++) {
        test_random random = test_random_case("contacts of solids", i);
        pir_trimesh *boundary = NULL;
        pir_solid *solid = solid_and_boundary(&random, i % 4 == 3, &boundary);
        pir_pieces *q = pieces_of(solid);
        for (int k = 0; k < 6; k++)
            poses += check_pose(&random, solid, q, boundary, workspace, i);
        pir_pieces_destroy(q);
        pir_trimesh_release(boundary);
        pir_solid_release(solid);
    }
    pir_workspace_destroy(workspace);
    print_message("%llu poses\n", (unsigned long long)poses);
}

/* --- against distances --- */

/* Bodies with walls within both, at any pose: the nearest contact is as far as the bodies, and none is nearer; where
 * they overlap there is one. */
static void the_nearest_contact_is_told(void **state) {
    (void)state;
    static const char *const names[][2] = {{"ell", "clamp"},     {"star5", "ell"},   {"clamp", "frame"},
                                           {"stella", "stella"}, {"star5", "gear8"}, {"mushroom", "stella"}};
    uint64_t apart = 0, inside = 0;
    pir_workspace *workspace = NULL;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < solid_cases(6); i++) {
        test_random random = test_random_case("nearest contacts of solids", i);
        pir_solid *solid[2] = {solid_model_new(names[i % 6][0], 1), solid_model_new(names[i % 6][1], 1)};
        pir_pieces *p = pieces_of(solid[0]), *q = pieces_of(solid[1]);
        pir_solid_query *query = NULL;
        pir_solid_contacts *object = NULL;
        assert_int_equal(pir_solid_query_create(p, q, NULL, &query), PIR_OK);
        assert_int_equal(pir_solid_contacts_create(p, q, NULL, &object), PIR_OK);
        for (int k = 0; k < 40; k++) {
            pir_pair_input input = pir_pair_input_default();
            pir_solid_contact contact[MOST];
            pir_solid_distance told;
            size_t count = 0;
            const pir_vec3 turn = test_random_direction(&random), axis = test_random_direction(&random);
            input.pose_q.rotation = (pir_quat){turn.x, turn.y, turn.z, test_random_unit(&random)};
            input.pose_p.rotation = (pir_quat){axis.x, axis.y, axis.z, test_random_unit(&random)};
            input.pose_p.translation = test_add((pir_vec3){0, 0, 0}, test_random_direction(&random), 16);
            input.margin = 0.05;
            if (!place(query, workspace, 0.04 * test_random_unit(&random), &input))
                continue;
            assert_int_equal(pir_solid_query_distance(query, workspace, &input, &told), PIR_OK);
            assert_int_equal(pir_solid_contacts_find(object, workspace, &input, MOST, contact, &count), PIR_OK);
            assert_true(count > 0);
            apart += told.result.state == PIR_OUTSIDE;
            inside += told.result.state == PIR_INSIDE;
            if (told.result.state == PIR_OUTSIDE)
                assert_true(fabs(contact[0].distance - told.result.distance) < 1e-9);
        }
        pir_solid_contacts_destroy(object);
        pir_solid_query_destroy(query);
        pir_pieces_destroy(p);
        pir_pieces_destroy(q);
        pir_solid_release(solid[0]);
        pir_solid_release(solid[1]);
    }
    print_message("%llu apart, %llu inside\n", (unsigned long long)apart, (unsigned long long)inside);
    assert_true(apart > 0 && inside > 0);
    pir_workspace_destroy(workspace);
}

/* --- use --- */

static void memory_may_run_out_and_inputs_are_refused(void **state) {
    (void)state;
    pir_solid *floor = floor_of_pieces();
    pir_pieces *q = pieces_of(floor);
    pir_workspace *workspace = NULL;
    pir_pair_input input = pir_pair_input_default();
    pir_solid_contact contact[MOST];
    size_t count = 77;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    input.pose_p.translation = (pir_vec3){4.125, 3.25, 1};
    input.margin = 0.125;
    bool whole = false;
    for (uint64_t n = 1; !whole; n++) {
        test_memory memory = {.fail_at = n};
        const pir_allocator allocator = test_allocator(&memory);
        pir_solid_contacts *object = NULL;
        pir_status status = pir_solid_contacts_create(q, q, &allocator, &object);
        if (status == PIR_OK)
            status = pir_solid_contacts_find(object, workspace, &input, MOST, contact, &count);
        assert_true(status == PIR_OK || status == PIR_ERR_MEMORY);
        whole = status == PIR_OK;
        pir_solid_contacts_destroy(object);
        assert_true(memory.blocks == 0 && !memory.wrong_size);
    }
    pir_solid_contacts *object = NULL;
    assert_int_equal(pir_solid_contacts_create(NULL, q, NULL, &object), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_contacts_create(q, NULL, NULL, &object), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_contacts_create(q, q, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_contacts_create(q, q, NULL, &object), PIR_OK);
    const size_t right = count;
    count = 77;
    input.pose_p.translation.x = NAN;
    assert_int_equal(pir_solid_contacts_find(object, workspace, &input, MOST, contact, &count), PIR_ERR_NOT_FINITE);
    input.pose_p.translation.x = 1.125;
    input.pose_q.rotation = (pir_quat){0, 0, 0, 0};
    assert_int_equal(pir_solid_contacts_find(object, workspace, &input, MOST, contact, &count),
                     PIR_ERR_ZERO_QUATERNION);
    input.pose_q.rotation.w = 1;
    assert_int_equal(pir_solid_contacts_find(object, workspace, &input, 1, NULL, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(count, 77);
    assert_int_equal(pir_solid_contacts_find(object, workspace, &input, 0, NULL, &count), PIR_OK);
    assert_int_equal(count, right);
    pir_solid_contacts_destroy(object);
    pir_solid_contacts_destroy(NULL);
    pir_workspace_destroy(workspace);
    pir_pieces_destroy(q);
    pir_solid_release(floor);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_slide_over_inner_walls_without_ghosts),
        cmocka_unit_test(contacts_are_those_of_the_boundary),
        cmocka_unit_test(the_nearest_contact_is_told),
        cmocka_unit_test(memory_may_run_out_and_inputs_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

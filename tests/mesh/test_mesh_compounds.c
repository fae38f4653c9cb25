/* SPDX-License-Identifier: MIT */
/*
 * Convex bodies cut into pieces, against the same bodies whole: walls between the pieces make no contact, and none of
 * the whole body's is lost. At poses in general, touching, and where edges of triangles lie in a wall. And bad input,
 * and memory that runs out. PIR_TEST_POSES is how many poses.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/contact_soups.h"
#include "mesh/mesh_models.h"
#include "support/memory.h"

#define CONTACTS 512
#define PIECES   8
#define CORNERS  64
#define NEAR     1e-9
/* Normals this near are one and the same: soups have steps of 2^-40, which tilt normals by more. */
#define SAME 1e-15

typedef struct corners {
    pir_vec3 at[CORNERS];
    uint32_t count;
} corners;

/* A body, whole and in pieces. */
typedef struct body {
    corners whole, part[PIECES];
    pir_polytope *piece[PIECES], *all;
    uint32_t pieces;
} body;

static uint64_t poses(void) {
    const char *text = getenv("PIR_TEST_POSES");
    return text ? strtoull(text, NULL, 10) : 4000;
}

static double *coordinate(pir_vec3 *v, int axis) {
    return axis == 0 ? &v->x : axis == 1 ? &v->y : &v->z;
}

static bool has(const corners *c, pir_vec3 x) {
    for (uint32_t i = 0; i < c->count; i++)
        if (c->at[i].x == x.x && c->at[i].y == x.y && c->at[i].z == x.z)
            return true;
    return false;
}

static void add(corners *c, pir_vec3 x) {
    if (has(c, x))
        return;
    assert_true(c->count < CORNERS);
    c->at[c->count++] = x;
}

/* The corners on one side of a plane across an axis, through 0, and where segments between corners cross it. */
static corners side_of(const corners *c, int axis, double sign) {
    corners side = {.count = 0};
    for (uint32_t i = 0; i < c->count; i++) {
        pir_vec3 a = c->at[i];
        if (sign * *coordinate(&a, axis) >= 0)
            add(&side, a);
        for (uint32_t k = 0; k < i; k++) {
            pir_vec3 b = c->at[k];
            const double from = *coordinate(&a, axis), to = *coordinate(&b, axis), part = from / (from - to);
            if (!(from * to < 0))
                continue;
            pir_vec3 x = {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), a.z + part * (b.z - a.z)};
            *coordinate(&x, axis) = 0;
            add(&side, x);
        }
    }
    return side;
}

static bool has_inside(const corners *c, int axis) {
    bool below = false, above = false;
    for (uint32_t i = 0; i < c->count; i++) {
        pir_vec3 x = c->at[i];
        below |= *coordinate(&x, axis) < 0;
        above |= *coordinate(&x, axis) > 0;
    }
    return below && above;
}

static pir_polytope *hull(const corners *c) {
    pir_polytope *p;
    assert_int_equal(pir_polytope_create(c->at, c->count, NULL, &p), PIR_OK);
    return p;
}

/* A box, a wedge or an octahedron, cut across one axis or more: where it is cut, coordinates stay exact. */
static void body_make(body *b, test_random *random) {
    static const uint64_t kinds[3] = {1, 5, 6};
    const uint32_t kind = test_random_below(random, 3), cuts = 1 + test_random_below(random, kind == 0 ? 7 : 1);
    pir_vec3 vertex[8];
    *b = (body){.pieces = 1};
    b->whole.count = soup_body(kinds[kind], vertex);
    for (uint32_t i = 0; i < b->whole.count; i++)
        b->whole.at[i] = vertex[i];
    b->part[0] = b->whole;
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t i = b->pieces; cuts >> axis & 1 && i-- > 0;)
            if (has_inside(&b->part[i], axis)) {
                const corners uncut = b->part[i];
                b->part[i] = side_of(&uncut, axis, 1);
                b->part[b->pieces++] = side_of(&uncut, axis, -1);
            }
    for (uint32_t i = 0; i < b->pieces; i++)
        b->piece[i] = hull(&b->part[i]);
    b->all = hull(&b->whole);
}

static void body_clear(body *b) {
    for (uint32_t i = 0; i < b->pieces; i++)
        pir_polytope_release(b->piece[i]);
    pir_polytope_release(b->all);
}

static pir_trimesh *mesh_of_soup(const contact_soup *soup, bool two_sided) {
    uint32_t corner[3 * SOUP_MOST];
    for (uint32_t i = 0; i < 3 * soup->count; i++)
        corner[i] = i;
    const pir_trimesh_arrays arrays = {.vertices = soup->corner,
                                       .vertex_count = 3 * (size_t)soup->count,
                                       .triangles = corner,
                                       .triangle_count = soup->count};
    pir_trimesh_options options = pir_trimesh_options_default();
    options.two_sided = two_sided;
    pir_trimesh *mesh;
    assert_int_equal(pir_trimesh_create(&arrays, &options, NULL, &mesh), PIR_OK);
    return mesh;
}

/* How far a part reaches down along n, about the body's origin. */
static double lowest(const corners *c, pir_quat rotation, pir_vec3 n) {
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < c->count; i++) {
        const pir_vec3 x = pir_pose_rotate((pir_pose){rotation, {0, 0, 0}}, c->at[i]);
        least = fmin(least, n.x * x.x + n.y * x.y + n.z * x.z);
    }
    return least;
}

static bool is_told(const pir_surface_contact *contacts, size_t count, pir_vec3 n, double within) {
    for (size_t i = 0; i < count; i++) {
        const pir_vec3 m = contacts[i].normal;
        if (fmax(fabs(m.x - n.x), fmax(fabs(m.y - n.y), fabs(m.z - n.z))) <= within)
            return true;
    }
    return false;
}

/* Whether no part of a body is lower along n than one of its pieces is, which then touches first. */
static bool is_lowest(const body *b, uint32_t k, pir_quat rotation, pir_vec3 n) {
    return lowest(&b->whole, rotation, n) >= lowest(&b->part[k], rotation, n);
}

static pir_vec3 some_place(test_random *random, const body *b, pir_quat rotation) {
    static const double heights[8] = {0, 0.0009765625, -0.0009765625, 0.0625, -0.0625, 0.25, 1e-9, 0.125};
    pir_vec3 t = {0.125 * test_random_between(random, -14, 14), 0.125 * test_random_between(random, -14, 14), 0};
    t.z = heights[test_random_below(random, 8)] - lowest(&b->whole, rotation, (pir_vec3){0, 0, 1});
    if (test_random_below(random, 3) == 0) {
        t.x += ldexp(test_random_unit(random), -10);
        t.y += ldexp(test_random_unit(random), -5);
    }
    return t;
}

typedef struct tally {
    uint64_t contacts, inner; /* of pieces; of these, of walls where pieces are alone */
    uint64_t whole, unseen;   /* of whole bodies; of these, those that no piece alone has */
    uint64_t lost;            /* of these, those that a piece has alone and none has with the others beside */
    uint64_t exact;
} tally;

/* The contacts of one piece. Its normals are those of the whole body, where the others are beside. */
static size_t ask_piece(const body *b, uint32_t k, pir_workspace *workspace, pir_surface_contact_input *input,
                        pir_surface_contact *contacts, uint64_t number, tally *seen) {
    pir_surface_contact_result result;
    assert_int_equal(pir_surface_contacts(b->piece[k], workspace, input, CONTACTS, contacts, &result), PIR_OK);
    for (size_t i = 0; i < result.contacts; i++) {
        const pir_vec3 n = contacts[i].normal;
        const double low = lowest(&b->whole, input->pose.rotation, n),
                     own = lowest(&b->part[k], input->pose.rotation, n);
        if (input->beside_count == 0) {
            seen->inner += low < own - NEAR;
            continue;
        }
        expect(low >= own - NEAR,
               "case %llu, piece %u of %u: normal %.17g %.17g %.17g, %g away, is of a wall: %g below",
               (unsigned long long)number, k, b->pieces, n.x, n.y, n.z, contacts[i].distance, own - low);
    }
    seen->contacts += result.contacts;
    seen->exact += result.counts.exact;
    return result.contacts;
}

static void check_pose(const body *b, pir_workspace *workspace, pir_surface_contact_input *input, uint64_t number,
                       tally *seen) {
    static pir_surface_contact whole[CONTACTS], found[CONTACTS];
    const pir_polytope *beside[PIECES];
    pir_surface_contact_result of_all;
    bool told[CONTACTS] = {false}, alone[CONTACTS] = {false};
    input->beside_count = 0;
    assert_int_equal(pir_surface_contacts(b->all, workspace, input, CONTACTS, whole, &of_all), PIR_OK);
    for (uint32_t k = 0; k < b->pieces; k++) {
        beside[k] = b->piece[k];
        const size_t count = ask_piece(b, k, workspace, input, found, number, seen);
        for (size_t i = 0; i < of_all.contacts; i++)
            alone[i] |=
                is_told(found, count, whole[i].normal, SAME) && is_lowest(b, k, input->pose.rotation, whole[i].normal);
    }
    input->beside = beside;
    input->beside_count = b->pieces;
    for (uint32_t k = 0; k < b->pieces; k++) {
        const size_t count = ask_piece(b, k, workspace, input, found, number, seen);
        for (size_t i = 0; i < of_all.contacts; i++)
            told[i] |= is_told(found, count, whole[i].normal, NEAR);
    }
    // pieces that overlap are seen from places of their own, as is what others hide
    for (size_t i = 0; i < of_all.contacts && of_all.state == PIR_OUTSIDE; i++) {
        seen->whole++;
        seen->unseen += !alone[i];
        seen->lost += alone[i] && !told[i];
        if (alone[i] && !told[i])
            print_message("case %llu: no piece of %u has the normal %.17g %.17g %.17g, %g away\n",
                          (unsigned long long)number, b->pieces, whole[i].normal.x, whole[i].normal.y,
                          whole[i].normal.z, whole[i].distance);
    }
}

static void walls_between_pieces_are_not_felt_and_no_contact_is_lost(void **state) {
    (void)state;
    pir_workspace *workspace;
    tally seen = {0, 0, 0, 0, 0, 0};
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t number = 0; number < poses(); number += 8) {
        test_random random = test_random_case("mesh compounds", number);
        body b;
        contact_soup soup = soup_make(&random, test_random_below(&random, 12));
        soup_jitter(&random, &soup);
        pir_trimesh *mesh = mesh_of_soup(&soup, test_random_below(&random, 3) == 0);
        body_make(&b, &random);
        const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
        pir_surface_contact_input input = pir_surface_contact_input_default();
        input.surfaces = &surface;
        input.surface_count = 1;
        for (int i = 0; i < 8; i++) {
            input.pose.rotation = soup_rotation(&random);
            input.pose.translation = some_place(&random, &b, input.pose.rotation);
            input.margin = test_random_below(&random, 2) ? 0.125 : 0.5;
            check_pose(&b, workspace, &input, number + (uint64_t)i, &seen);
        }
        body_clear(&b);
        pir_trimesh_release(mesh);
    }
    print_message("%llu contacts, %llu of walls where pieces are alone, %llu of whole bodies, %llu of these of no "
                  "piece, %llu lost, %llu exact decisions\n",
                  (unsigned long long)seen.contacts, (unsigned long long)seen.inner, (unsigned long long)seen.whole,
                  (unsigned long long)seen.unseen, (unsigned long long)seen.lost, (unsigned long long)seen.exact);
    assert_true(seen.inner * 50 > poses() && seen.whole * 2 > poses() && seen.exact * 2 > poses());
    // which piece is the lowest along a normal is told in doubles here: an ulp of a corner may have it otherwise
    assert_true(seen.unseen * 100 <= seen.whole + 1600 && seen.lost * 10000 <= seen.whole);
    pir_workspace_destroy(workspace);
}

/* --- bad input, memory --- */

/* The half of a cube of side 1 on one side of x = 0. */
static pir_polytope *half_cube(double sign) {
    corners c = {.count = 0};
    for (int i = 0; i < 8; i++)
        add(&c, (pir_vec3){i & 1 ? 0 : 0.5 * sign, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5});
    return hull(&c);
}

static pir_status ask_halves(pir_workspace *workspace, pir_polytope *const half[2], pir_trimesh *mesh,
                             pir_surface_contact_result *ret_result) {
    const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
    const pir_polytope *beside[2] = {half[0], half[1]};
    pir_surface_contact_input input = pir_surface_contact_input_default();
    pir_surface_contact contacts[16];
    input.pose = (pir_pose){{0.001, 0, 0.2, 1}, {2.1, 2.2, 0.51}};
    input.margin = 0.1;
    input.surfaces = &surface;
    input.surface_count = 1;
    input.beside = beside;
    input.beside_count = 2;
    return pir_surface_contacts(half[0], workspace, &input, 16, contacts, ret_result);
}

static void what_is_no_piece_is_refused(void **state) {
    (void)state;
    mesh_arrays plane = mesh_plane(4);
    pir_trimesh *mesh = mesh_of(&plane, NULL);
    pir_polytope *half[2] = {half_cube(1), half_cube(-1)};
    pir_workspace *workspace;
    pir_surface_contact_result result = {.triangle = 77};
    const pir_polytope *none[2] = {half[1], NULL};
    const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
    pir_surface_contact_input input = pir_surface_contact_input_default();
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    input.surfaces = &surface;
    input.surface_count = 1;
    input.beside_count = 2;
    assert_int_equal(pir_surface_contacts(half[0], workspace, &input, 0, NULL, &result), PIR_ERR_ARGUMENT);
    input.beside = none;
    assert_int_equal(pir_surface_contacts(half[0], workspace, &input, 0, NULL, &result), PIR_ERR_ARGUMENT);
    assert_int_equal(result.triangle, 77);
    input.beside_count = 1;
    assert_int_equal(pir_surface_contacts(half[0], workspace, &input, 0, NULL, &result), PIR_OK);
    pir_workspace_destroy(workspace);
    for (int i = 0; i < 2; i++)
        pir_polytope_release(half[i]);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&plane);
}

static void memory_may_run_out_for_the_pieces_too(void **state) {
    (void)state;
    mesh_arrays plane = mesh_plane(8);
    pir_trimesh *mesh = mesh_of(&plane, NULL);
    pir_polytope *half[2] = {half_cube(1), half_cube(-1)};
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    pir_surface_contact_result result;
    bool failed = true;
    for (uint64_t at = 1; failed; at++) {
        pir_workspace *workspace = NULL;
        memory.requests = 0;
        memory.fail_at = at;
        pir_status status = pir_workspace_create(&allocator, &workspace);
        if (status == PIR_OK)
            status = ask_halves(workspace, half, mesh, &result);
        failed = status == PIR_ERR_MEMORY;
        assert_true(failed || status == PIR_OK);
        memory.fail_at = 0;
        if (workspace)
            assert_int_equal(ask_halves(workspace, half, mesh, &result), PIR_OK);
        memory.requests = 0;
        if (workspace)
            assert_int_equal(ask_halves(workspace, half, mesh, &result), PIR_OK);
        assert_int_equal(memory.requests, 0);
        pir_workspace_destroy(workspace);
        assert_true(memory.blocks == 0 && !memory.wrong_size && !memory.overrun && at < 100);
    }
    for (int i = 0; i < 2; i++)
        pir_polytope_release(half[i]);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&plane);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walls_between_pieces_are_not_felt_and_no_contact_is_lost),
        cmocka_unit_test(what_is_no_piece_is_refused),
        cmocka_unit_test(memory_may_run_out_for_the_pieces_too),
    };
    return cmocka_run_group_tests_name("contacts of meshes, compounds", tests, NULL, NULL);
}

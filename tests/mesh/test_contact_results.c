/* SPDX-License-Identifier: MIT */
/*
 * What a call with surfaces says beside which contacts there are: the distance, the normal and the points of its result
 * belong together, with and without a radius; numbers of contacts are distinct and steady; a body between walls. Hulls
 * as surfaces have the nearest contacts and depths of the hulls, which pairs tell.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pair.h>

#include "mesh/contact_stage.h"

#define CONTACTS 512

static uint64_t poses(void) {
    const char *text = getenv("PIR_TEST_POSES");
    return text ? strtoull(text, NULL, 10) : 300;
}

static pir_vec3 plus(pir_vec3 a, pir_vec3 b, double part) {
    return (pir_vec3){a.x + part * b.x, a.y + part * b.y, a.z + part * b.z};
}

static double product(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static pir_vec3 cross(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* How far a point is outside of the body with its radius at t, by 300 directions: at least so much. */
static double outside_body(const stage *s, pir_vec3 t, double radius, pir_vec3 x) {
    test_random random = test_random_case("directions", 0);
    double most = -HUGE_VAL;
    for (int i = 0; i < 300; i++) {
        pir_vec3 n = test_random_direction(&random);
        double support = -HUGE_VAL;
        for (uint32_t v = 0; v < s->vertices; v++)
            support = fmax(support, product(n, pir_pose_apply((pir_pose){s->rotation, t}, s->vertex[v])));
        most = fmax(most, product(n, x) - support - radius);
    }
    return most;
}

/* How far a point is from a triangle of a surface, at most: off its plane, and beyond its sides. */
static double off_triangle(const stage *s, uint32_t surface, uint32_t triangle, pir_vec3 x) {
    const pir_vec3 *local = s->soup.corner[surface + triangle * s->surfaces];
    pir_vec3 c[3];
    for (int k = 0; k < 3; k++)
        c[k] = pir_pose_apply(s->surface[surface].pose, local[k]);
    pir_vec3 n = cross(plus(c[1], c[0], -1), plus(c[2], c[0], -1));
    n = plus((pir_vec3){0, 0, 0}, n, 1 / sqrt(product(n, n)));
    double most = fabs(product(n, plus(x, c[0], -1)));
    for (int k = 0; k < 3; k++) {
        const pir_vec3 e = plus(c[(k + 1) % 3], c[k], -1), out = cross(e, n);
        most = fmax(most, product(out, plus(x, c[k], -1)) / sqrt(product(e, e)));
    }
    return most;
}

static void ask(const stage *s, pir_workspace *workspace, const pir_surface_contact_input *input,
                pir_surface_contact *contacts, pir_surface_contact_result *ret_result) {
    assert_int_equal(pir_surface_contacts(s->body, workspace, input, CONTACTS, contacts, ret_result), PIR_OK);
}

/*
 * How the oracle has P after the move that a result asks for and a part of what is left from there to the end of the
 * way out.
 */
static int state_after(const stage *s, const pir_surface_contact_input *input, const pir_surface_contact_result *result,
                       double part) {
    const pir_vec3 move = plus((pir_vec3){0, 0, 0}, result->normal, -result->distance);
    const pir_vec3 left = plus(result->way_out, move, -1);
    oracle_scene_move(s->truth, plus(plus(input->pose.translation, move, 1), left, part));
    return oracle_scene_state(s->truth);
}

static void points_and_normals_belong_to_the_distance(void **state) {
    (void)state;
    uint64_t seen[2][3] = {{0}}, stuck = 0, overlaps = 0, out = 0, off = 0;
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t number = 0; number < poses() / 4; number++) {
        test_random random = test_random_case("results", number);
        stage s;
        stage_make(&s, &random, number);
        for (int i = 0; i < 4; i++) {
            pir_surface_contact contacts[CONTACTS];
            pir_surface_contact_result r;
            pir_surface_contact_input input = input_of(&s, some_place(&random, &s), 0.5);
            const double radius = i % 2 ? 0.1 : 0;
            input.radius = radius;
            ask(&s, workspace, &input, contacts, &r);
            seen[i % 2][r.state]++;
            stuck += !r.is_out;
            if (r.triangle == PIR_TRIANGLE_NONE) {
                // a ball behind one-sided triangles may leave them by a way that no contact is on
                expect(r.state == PIR_OUTSIDE ? r.distance == HUGE_VAL : radius > 0 && r.distance <= 0,
                       "pose %llu.%d: state %d, distance %g", (unsigned long long)number, i, r.state, r.distance);
                continue;
            }
            expect(r.state == PIR_OUTSIDE    ? r.distance > 0
                   : r.state == PIR_BOUNDARY ? r.distance == 0
                                             : r.distance <= 0,
                   "pose %llu.%d: state %d, distance %g", (unsigned long long)number, i, r.state, r.distance);
            expect(apart(r.point_p, plus(r.point_q, r.normal, r.distance)) < 1e-12 &&
                       fabs(product(r.normal, r.normal) - 1) < 1e-12,
                   "pose %llu.%d: points", (unsigned long long)number, i);
            if (!r.is_out)
                continue;
            // P that ends behind a one-sided triangle may end beside all others
            const bool is_off = off_triangle(&s, r.surface, r.triangle, r.point_q) > 1e-9;
            off += is_off;
            expect(outside_body(&s, input.pose.translation, radius, r.point_p) < 1e-9 &&
                       (!is_off || r.state == PIR_INSIDE),
                   "pose %llu.%d (%s), state %d, shortest %d: P is off its point by %g, the triangle by %g",
                   (unsigned long long)number, i, s.soup.name, r.state, r.is_shortest,
                   outside_body(&s, input.pose.translation, radius, r.point_p),
                   off_triangle(&s, r.surface, r.triangle, r.point_q));
            if (radius > 0 || r.state != PIR_INSIDE)
                continue;
            // one-sided triangles that P is behind at the end of its way may count where it touches before that
            overlaps++;
            out += state_after(&s, &input, &r, 0x1p-10) == 0;
            const pir_vec3 left = plus(r.way_out, r.normal, r.distance);
            expect(product(left, left) < 0x1p-20, "pose %llu.%d (%s): the way out is %g from there",
                   (unsigned long long)number, i, s.soup.name, sqrt(product(left, left)));
        }
        stage_clear(&s);
    }
    pir_workspace_destroy(workspace);
    print_message(
        "states %llu %llu %llu, rounded %llu %llu %llu, stuck %llu, off %llu, out after the distance %llu of %llu\n",
        (unsigned long long)seen[0][0], (unsigned long long)seen[0][1], (unsigned long long)seen[0][2],
        (unsigned long long)seen[1][0], (unsigned long long)seen[1][1], (unsigned long long)seen[1][2],
        (unsigned long long)stuck, (unsigned long long)off, (unsigned long long)out, (unsigned long long)overlaps);
    assert_true(seen[0][0] && seen[0][2] && seen[1][0] && seen[1][2] && off <= 2 + overlaps / 50 &&
                out + 2 + overlaps / 100 > overlaps);
}

/* Triangles of which a ball reaches the planes and not the fronts: behind them it stays. */
static void a_radius_takes_its_length_off_the_distance(void **state) {
    (void)state;
    uint64_t told = 0, first = 0;
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t number = 0; number < 4 * poses(); number++) {
        test_random random = test_random_case("rounded and not", number);
        stage s = {.soup = {.name = "any", .count = 6}, .surfaces = 1, .vertices = 1 + (uint32_t)(number % 4)};
        for (uint32_t k = 0; k < 3 * s.soup.count; k++)
            s.soup.corner[k / 3][k % 3] = plus((pir_vec3){0, 0, 0}, test_random_direction(&random), 1);
        for (uint32_t v = 0; v < s.vertices; v++)
            s.vertex[v] = plus((pir_vec3){0, 0, 0}, test_random_direction(&random), 0.2);
        static const uint32_t corners[18] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};
        const pir_trimesh_arrays arrays = {
            .vertices = s.soup.corner, .vertex_count = 18, .triangles = corners, .triangle_count = 6};
        pir_trimesh_options options = pir_trimesh_options_default();
        options.two_sided = number % 2;
        assert_int_equal(pir_trimesh_create(&arrays, &options, NULL, &s.mesh[0]), PIR_OK);
        assert_int_equal(pir_polytope_create(s.vertex, s.vertices, NULL, &s.body), PIR_OK);
        s.surface[0] = (pir_posed_surface){{s.mesh[0], NULL}, pir_pose_identity()};
        s.rotation = (pir_quat){0, 0, 0, 1};
        pir_surface_contact contacts[CONTACTS];
        pir_surface_contact_result core, grown;
        const double radius = 0x1p-4;
        pir_surface_contact_input input =
            input_of(&s, plus((pir_vec3){0, 0, 0}, test_random_direction(&random), 0.7), 1);
        ask(&s, workspace, &input, contacts, &core);
        const double nearest = core.contacts > 0 ? contacts[0].distance : HUGE_VAL;
        input.radius = radius;
        input.margin = 1 - radius;
        ask(&s, workspace, &input, contacts, &grown);
        // a one-sided triangle counts behind which the core is, but not all of the ball: then P overlaps it
        if (core.distance > radius && core.triangle != PIR_TRIANGLE_NONE &&
            (options.two_sided || grown.state == PIR_OUTSIDE)) {
            told++;
            expect(fabs(grown.distance - (core.distance - radius)) < 1e-12,
                   "core %llu: distance %.17g, with the radius %.17g", (unsigned long long)number, core.distance,
                   grown.distance);
            // a one-sided triangle in front of which the ball comes on its way may hide the nearest contact
            if (nearest < core.distance + 1e-12 && options.two_sided) {
                first++;
                expect(grown.contacts > 0 && fabs(contacts[0].distance - (nearest - radius)) < 1e-12,
                       "core %llu: contact %.17g, with the radius %.17g", (unsigned long long)number, nearest,
                       grown.contacts > 0 ? contacts[0].distance : HUGE_VAL);
            }
        }
        pir_polytope_release(s.body);
        pir_trimesh_release(s.mesh[0]);
    }
    pir_workspace_destroy(workspace);
    print_message("distances %llu, contacts %llu of %llu\n", (unsigned long long)told, (unsigned long long)first,
                  (unsigned long long)(4 * poses()));
    assert_true(told > poses() && first > poses() / 2);
}

/* --- numbers --- */

/* The one contact on a triangle at a place with a normal; CONTACTS for none or several. */
static size_t find_again(const pir_surface_contact *contact, const pir_surface_contact *among, size_t count) {
    size_t found = CONTACTS;
    for (size_t k = 0; k < count; k++) {
        if (among[k].surface != contact->surface || among[k].triangle != contact->triangle ||
            apart(among[k].normal, contact->normal) > 1e-6 || apart(among[k].point_q, contact->point_q) > 1e-8)
            continue;
        if (found < CONTACTS)
            return CONTACTS;
        found = k;
    }
    return found;
}

static void numbers_of_contacts_are_distinct_and_steady(void **state) {
    (void)state;
    uint64_t contacts_seen = 0, same = 0, matched = 0;
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t number = 0; number < poses() / 2; number++) {
        test_random random = test_random_case("numbers", number);
        stage s;
        stage_make(&s, &random, number);
        pir_surface_contact before[CONTACTS], after[CONTACTS];
        pir_surface_contact_result a, b;
        pir_surface_contact_input input = input_of(&s, some_place(&random, &s), number % 3 ? 0.1 : 1);
        input.radius = number % 5 == 0 ? 0.1 : 0;
        // beside aligned features, which change within any motion
        input.pose.translation = plus(input.pose.translation, test_random_direction(&random), 0.01);
        ask(&s, workspace, &input, before, &a);
        input.pose.translation = plus(input.pose.translation, test_random_direction(&random), 1e-9);
        ask(&s, workspace, &input, after, &b);
        for (size_t i = 0; i < a.contacts; i++) {
            contacts_seen++;
            for (size_t k = 0; k < i; k++)
                expect(before[k].id != before[i].id, "pose %llu (%s): contacts %zu and %zu have one number",
                       (unsigned long long)number, s.soup.name, k, i);
            const size_t again = find_again(&before[i], after, b.contacts);
            if (again == CONTACTS || find_again(&after[again], before, a.contacts) != i)
                continue;
            matched++;
            same += after[again].id == before[i].id;
        }
        stage_clear(&s);
    }
    pir_workspace_destroy(workspace);
    print_message("contacts %llu, found again %llu, with the same number %llu\n", (unsigned long long)contacts_seen,
                  (unsigned long long)matched, (unsigned long long)same);
    // where soups are an ulp off alignment, other features are the nearest after any motion
    assert_true(matched > poses() / 4 && same + 2 + matched / 100 > matched);
}

/* --- between walls --- */

/* Two walls that face each other at x = ±0.3, wide and high, as one one-sided mesh. */
static pir_trimesh *two_walls(void) {
    const double x = 0.3, w = 50;
    const pir_vec3 corner[8] = {{-x, -w, -w}, {-x, w, -w}, {-x, w, w}, {-x, -w, w},
                                {x, -w, -w},  {x, w, -w},  {x, w, w},  {x, -w, w}};
    static const uint32_t triangle[4][3] = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
    const pir_trimesh_arrays arrays = {
        .vertices = corner, .vertex_count = 8, .triangles = &triangle[0][0], .triangle_count = 4};
    pir_trimesh *mesh;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    return mesh;
}

static void walls_nearer_than_a_body_is_wide_both_push(void **state) {
    (void)state;
    pir_trimesh *mesh = two_walls();
    const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (int shape = 0; shape < 3; shape++) {
        // a ball, a capsule across with its ends beyond both walls, a box
        pir_vec3 corner[8];
        const uint32_t count = shape == 0 ? 1 : shape == 1 ? 2 : 8;
        for (uint32_t i = 0; i < count; i++)
            corner[i] = shape == 0 ? (pir_vec3){0, 0, 0}
                                   : (pir_vec3){i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5};
        if (shape == 1)
            corner[0] = (pir_vec3){-0.5, 0, 0}, corner[1] = (pir_vec3){0.5, 0, 0};
        pir_polytope *body;
        assert_int_equal(pir_polytope_create(corner, count, NULL, &body), PIR_OK);
        const double radius = shape == 0 ? 0.5 : shape == 1 ? 0.1 : 0, reach = shape == 0 ? 0.5 : 0.5 + radius;
        for (int i = -6; i < 7; i++) {
            pir_surface_contact contacts[16];
            pir_surface_contact_result r;
            pir_surface_contact_input input = pir_surface_contact_input_default();
            input.pose.translation = (pir_vec3){0.03 * i, 0.11, 0.07};
            input.radius = radius;
            input.margin = 0.01;
            input.surfaces = &surface;
            input.surface_count = 1;
            assert_int_equal(pir_surface_contacts(body, workspace, &input, 16, contacts, &r), PIR_OK);
            double left = -HUGE_VAL, right = -HUGE_VAL;
            for (size_t k = 0; k < r.contacts; k++) {
                expect(fabs(fabs(contacts[k].normal.x) - 1) < 1e-12, "shape %d, %d: normal %g", shape, i,
                       contacts[k].normal.x);
                double *depth = contacts[k].normal.x > 0 ? &left : &right;
                *depth = fmax(*depth, -contacts[k].distance);
            }
            const double at = 0.03 * i, want_left = reach - 0.3 - at, want_right = reach - 0.3 + at;
            expect(r.state == PIR_INSIDE && !r.is_out && !r.is_shortest && r.way_out.x == 0 && r.way_out.y == 0 &&
                       r.way_out.z == 0,
                   "shape %d, %d: state %d, out %d", shape, i, r.state, r.is_out);
            expect(fabs(left - want_left) < 1e-9 && fabs(right - want_right) < 1e-9,
                   "shape %d, %d: depths %g and %g, not %g and %g", shape, i, left, right, want_left, want_right);
            expect(fabs(r.distance + fmax(want_left, want_right)) < 1e-9 && r.distance == contacts[0].distance &&
                       r.normal.x == contacts[0].normal.x,
                   "shape %d, %d: distance %g", shape, i, r.distance);
        }
        pir_polytope_release(body);
    }
    pir_workspace_destroy(workspace);
    pir_trimesh_release(mesh);
}

/* A box over one facet of a tetrahedron, wherever it is moved across: it reaches over edges with 55 degrees between
 * their facets, and meets the facet behind there. */
static void acute_edges_hide_no_contact(void **state) {
    (void)state;
    static const pir_vec3 corner[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const uint32_t triangle[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const pir_trimesh_arrays arrays = {
        .vertices = corner, .vertex_count = 4, .triangles = triangle, .triangle_count = 4};
    pir_vec3 v[8];
    pir_trimesh *mesh;
    pir_polytope *box;
    pir_workspace *workspace;
    for (int i = 0; i < 8; i++)
        v[i] = (pir_vec3){i & 1 ? 2 : 0, i & 2 ? 1 : 0, i & 4 ? 1 : 0};
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    assert_int_equal(pir_polytope_create(v, 8, NULL, &box), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    const pir_posed_surface surface = {{mesh, NULL}, pir_pose_identity()};
    pir_surface_contact_input input = pir_surface_contact_input_default();
    input.surfaces = &surface;
    input.surface_count = 1;
    input.margin = 0.02;
    for (int i = -9; i <= 4; i++)
        for (int j = -9; i + j < 10 && j <= 4; j++)
            for (int k = -1; k <= 1; k++) {
                const double gap = 0.01 * k;
                pir_surface_contact contact[CONTACTS];
                pir_surface_contact_result r;
                input.pose.translation = (pir_vec3){-2 - gap, i / 10.0, j / 10.0};
                assert_int_equal(pir_surface_contacts(box, workspace, &input, CONTACTS, contact, &r), PIR_OK);
                bool felt = false;
                for (size_t c = 0; c < r.contacts; c++)
                    felt = felt || (contact[c].normal.x == -1 && fabs(contact[c].distance - gap) < 1e-12);
                // all of the facet below y + z = 1 that the box is over has an area
                expect(felt || (i > 0 && j > 0 && i + j >= 10), "%d, %d, %d: %zu contacts", i, j, k, r.contacts);
            }
    pir_workspace_destroy(workspace);
    pir_polytope_release(box);
    pir_trimesh_release(mesh);
}

/* --- hulls as surfaces --- */

#define HULL_POINTS 12

static pir_polytope *random_hull(test_random *random, uint32_t points, double size) {
    for (;;) {
        pir_vec3 v[HULL_POINTS];
        pir_polytope *hull;
        for (uint32_t i = 0; i < points; i++)
            v[i] = (pir_vec3){size * test_random_unit(random), size * test_random_unit(random),
                              size * test_random_unit(random)};
        assert_int_equal(pir_polytope_create(v, points, NULL, &hull), PIR_OK);
        if (pir_polytope_dimension(hull) == 3)
            return hull;
        pir_polytope_release(hull);
    }
}

/* The facets of a hull of points in general position, by brute force: three points with all others behind. */
static pir_trimesh *surface_of(const pir_polytope *hull) {
    pir_vec3 v[HULL_POINTS];
    uint32_t corner[6 * HULL_POINTS], count = 0;
    const uint32_t points = pir_polytope_vertex_count(hull);
    pir_trimesh *mesh;
    for (uint32_t i = 0; i < points; i++)
        v[i] = pir_polytope_vertex(hull, i);
    for (uint32_t a = 0; a < points; a++)
        for (uint32_t b = a + 1; b < points; b++)
            for (uint32_t c = b + 1; c < points; c++) {
                const pir_vec3 n = cross(plus(v[b], v[a], -1), plus(v[c], v[a], -1));
                uint32_t above = 0, below = 0;
                for (uint32_t d = 0; d < points; d++)
                    if (d != a && d != b && d != c)
                        *(product(n, plus(v[d], v[a], -1)) > 0 ? &above : &below) += 1;
                if (above > 0 && below > 0)
                    continue;
                corner[count++] = a;
                corner[count++] = above > 0 ? c : b;
                corner[count++] = above > 0 ? b : c;
            }
    const pir_trimesh_arrays arrays = {
        .vertices = v, .vertex_count = points, .triangles = corner, .triangle_count = count / 3};
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    return mesh;
}

struct hull_counts {
    uint32_t apart, inside, longer;
};

/* P at a pose beside the surface of Q or in it, against the distance of the two hulls. */
static void check_hulls(const pir_polytope *p, const pir_trimesh *surface, const pir_query_result *truth,
                        const pir_pair_input *at, pir_workspace *workspace, struct hull_counts *counts) {
    const pir_posed_surface posed = {{surface, NULL}, at->pose_q};
    pir_surface_contact_input input = pir_surface_contact_input_default();
    pir_surface_contact contact[CONTACTS];
    pir_surface_contact_result r;
    input.pose = at->pose_p;
    input.radius = at->radius_p;
    input.margin = 0.05;
    input.surfaces = &posed;
    input.surface_count = 1;
    assert_int_equal(pir_surface_contacts(p, workspace, &input, CONTACTS, contact, &r), PIR_OK);
    bool has_nearest = false;
    for (size_t i = 0; i < r.contacts; i++)
        has_nearest = has_nearest || fabs(contact[i].distance - truth->distance) < 1e-9;
    if (truth->state == PIR_OUTSIDE) {
        counts->apart++;
        expect(truth->distance >= 0.05 || (has_nearest && fabs(r.distance - truth->distance) < 1e-9),
               "apart by %g, told %g by %zu contacts", truth->distance, r.distance, r.contacts);
    } else if (truth->state == PIR_INSIDE && r.state == PIR_INSIDE) {
        counts->inside++;
        counts->longer += -r.distance > -truth->distance + 1e-9;
        expect(r.is_out && r.contacts > 0, "%zu contacts, out %d", r.contacts, r.is_out);
        expect(-r.distance > -truth->distance - 1e-9, "deep by %g, told %g", truth->distance, r.distance);
    }
}

/* Facets at edges of all angles, acute ones too, and bodies with a radius: nearest contacts are told, and ways out are
 * as long as hulls are deep, but for rare ones past two edges at once. */
static void hulls_as_surfaces_are_as_far_as_hulls(void **state) {
    (void)state;
    struct hull_counts counts = {0};
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < 2 * poses(); i++) {
        test_random random = test_random_case("hulls as surfaces", i);
        pir_polytope *p = random_hull(&random, 4 + (uint32_t)(i % 9), 0.5);
        pir_polytope *q = random_hull(&random, 4 + (uint32_t)(i / 9 % 7), 1);
        pir_trimesh *surface = surface_of(q);
        pir_pair_input at = pir_pair_input_default();
        pir_query_result truth;
        pir_pair *pair;
        assert_int_equal(pir_pair_create(p, q, NULL, &pair), PIR_OK);
        const pir_vec3 turn_p = test_random_direction(&random), turn_q = test_random_direction(&random);
        const double gap =
            i % 5 == 4 ? 0.3 * test_random_unit(&random) : 0.04 * ldexp(test_random_unit(&random), -(int)(i % 12));
        at.radius_p = i % 2 ? 0.2 : 0;
        at.pose_p.rotation = (pir_quat){turn_p.x, turn_p.y, turn_p.z, test_random_unit(&random)};
        at.pose_q.rotation = (pir_quat){turn_q.x, turn_q.y, turn_q.z, test_random_unit(&random)};
        at.pose_p.translation = plus((pir_vec3){0, 0, 0}, test_random_direction(&random), 3);
        for (int k = 0; k < 3; k++) {
            assert_int_equal(pir_pair_signed_distance(pair, workspace, &at, &truth), PIR_OK);
            const double to = (k < 2 ? 0.001 + at.radius_p : gap) - truth.distance;
            at.pose_p.translation = plus(at.pose_p.translation, truth.normal, to);
        }
        assert_int_equal(pir_pair_signed_distance(pair, workspace, &at, &truth), PIR_OK);
        check_hulls(p, surface, &truth, &at, workspace, &counts);
        pir_pair_destroy(pair);
        pir_trimesh_release(surface);
        pir_polytope_release(p);
        pir_polytope_release(q);
    }
    print_message("%u apart, %u inside, %u by a longer way\n", counts.apart, counts.inside, counts.longer);
    expect(counts.apart > 0 && counts.inside > 0 && counts.longer <= 1 + counts.inside / 500, "%u longer of %u",
           counts.longer, counts.inside);
    pir_workspace_destroy(workspace);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_and_normals_belong_to_the_distance),
        cmocka_unit_test(a_radius_takes_its_length_off_the_distance),
        cmocka_unit_test(numbers_of_contacts_are_distinct_and_steady),
        cmocka_unit_test(walls_nearer_than_a_body_is_wide_both_push),
        cmocka_unit_test(acute_edges_hide_no_contact),
        cmocka_unit_test(hulls_as_surfaces_are_as_far_as_hulls),
    };
    return cmocka_run_group_tests_name("results of contacts", tests, NULL, NULL);
}

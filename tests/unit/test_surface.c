/* SPDX-License-Identifier: MIT */
/*
 * What models are before their hull is taken: open or closed, convex or not, their own volume. By hand where it is
 * known, and over random bodies whose facets are cut, turned, doubled, dented and left out, where it is known from how
 * they were made.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <pirouette/pirouette.h>

#include "fuzz/model_files.h"
#include "support/bodies.h"
#include "support/memory.h"

struct expected {
    pir_surface_form form;
    int convex;
    double volume;
};

static pir_surface read_surface(const void *bytes, size_t size, const char *format) {
    pir_surface surface;
    pir_polytope *polytope = NULL;
    pir_report report = {PIR_OK, ""};
    if (pir_polytope_read_bytes(&(pir_file_bytes){bytes, size, "m", format}, NULL, &report, &surface, &polytope) !=
        PIR_OK)
        fail_msg("%s", report.text);
    pir_polytope_release(polytope);
    return surface;
}

/* How the same text ends where a convex model is required; the report to `text`. */
static pir_status require_convex(const void *bytes, size_t size, const char *format, char text[240]) {
    pir_polytope *polytope = NULL;
    pir_report report = {PIR_OK, ""};
    pir_read_options options = pir_read_options_default();
    options.require_convex = true;
    pir_status status =
        pir_polytope_read_bytes(&(pir_file_bytes){bytes, size, "m", format}, &options, &report, NULL, &polytope);
    assert_true((status == PIR_OK) == (polytope != NULL));
    pir_polytope_release(polytope);
    strcpy(text, report.text);
    return status;
}

static bool same_volume(double a, double b) {
    return isnan(a) ? isnan(b) : fabs(a - b) <= 1e-14 * fabs(b);
}

static void expect_surface(const void *bytes, size_t size, const char *format, struct expected expected) {
    char text[240];
    pir_surface surface = read_surface(bytes, size, format);
    if (surface.form != expected.form || surface.convex != expected.convex ||
        !same_volume(surface.volume, expected.volume))
        fail_msg("%.*s: form %d, convex %d, volume %.17g", (int)size, (const char *)bytes, (int)surface.form,
                 surface.convex, surface.volume);
    pir_status status = require_convex(bytes, size, format, text);
    assert_int_equal(status, expected.convex                     ? PIR_OK
                             : expected.form == PIR_SURFACE_OPEN ? PIR_ERR_NOT_CLOSED
                                                                 : PIR_ERR_NOT_CONVEX);
}

static void expect_off(const char *off, pir_surface_form form, int convex, double volume) {
    expect_surface(off, strlen(off), "off", (struct expected){form, convex, volume});
}

/* --- by hand --- */

#define CUBE_POINTS "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
#define CUBE_FACETS "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n"
#define CUBE        "OFF\n8 6 0\n" CUBE_POINTS CUBE_FACETS "4 3 0 4 7\n"

static void test_a_cube_in_every_way(void **state) {
    (void)state;
    expect_off(CUBE, PIR_SURFACE_CLOSED, 1, 1);
    // inside out; one facet turned; triangles instead of one facet
    expect_off("OFF\n8 6 0\n" CUBE_POINTS "4 1 2 3 0\n4 7 6 5 4\n4 4 5 1 0\n4 5 6 2 1\n4 6 7 3 2\n4 7 4 0 3\n",
               PIR_SURFACE_CLOSED, 1, -1);
    expect_off("OFF\n8 6 0\n" CUBE_POINTS CUBE_FACETS "4 7 4 0 3\n", PIR_SURFACE_CLOSED, 1, 1);
    expect_off("OFF\n8 7 0\n" CUBE_POINTS CUBE_FACETS "3 3 0 4\n3 3 4 7\n", PIR_SURFACE_CLOSED, 1, 1);
    // points inside and on a facet that no facet has, and one outside
    expect_off("OFF\n10 6 0\n" CUBE_POINTS "1/3 1/3 1/3\n1/2 1/2 1\n" CUBE_FACETS "4 3 0 4 7\n", PIR_SURFACE_CLOSED, 1,
               1);
    expect_off("OFF\n9 6 0\n" CUBE_POINTS "2 0 0\n" CUBE_FACETS "4 3 0 4 7\n", PIR_SURFACE_CLOSED, 0, 1);
    // a corner in the middle of an edge, in both facets or in one, which leaves a crack
    expect_off("OFF\n9 6 0\n" CUBE_POINTS
               "0 0 1/2\n4 0 3 2 1\n4 4 5 6 7\n5 0 1 5 4 8\n4 1 2 6 5\n4 2 3 7 6\n5 3 0 8 4 7\n",
               PIR_SURFACE_CLOSED, 1, 1);
    expect_off("OFF\n9 6 0\n" CUBE_POINTS
               "0 0 1/2\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n5 3 0 8 4 7\n",
               PIR_SURFACE_OPEN, 0, 1);
}

static void test_facets_of_one_place_or_two(void **state) {
    (void)state;
    // points 8 and 9 are where 0 is: a facet of one place, and one that goes to 1 and back
    expect_off("OFF\n10 8 0\n" CUBE_POINTS "0 0 0\n0 0 0\n" CUBE_FACETS "4 3 0 4 7\n3 0 8 9\n3 0 1 8\n",
               PIR_SURFACE_CLOSED, 1, 1);
    // nothing else is there
    expect_off("OFF\n3 1 0\n0 0 0\n0 0 0\n0 0 0\n3 0 1 2\n", PIR_SURFACE_CLOSED, 1, 0);
}

static void test_what_is_not_convex(void **state) {
    (void)state;
    // twice the same; a cavity; a prism over an L; two cubes that touch along an edge
    expect_off("OFF\n8 12 0\n" CUBE_POINTS CUBE_FACETS "4 3 0 4 7\n" CUBE_FACETS "4 3 0 4 7\n", PIR_SURFACE_CLOSED, 0,
               2);
    expect_off("OFF\n12 10 0\n-3 -3 -3\n9 -3 -3\n-3 9 -3\n-3 -3 9\n" CUBE_POINTS
               "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n4 5 6 7 4\n4 11 10 9 8\n"
               "4 8 9 5 4\n4 9 10 6 5\n4 10 11 7 6\n4 11 8 4 7\n",
               PIR_SURFACE_CLOSED, 0, 288 - 1);
    expect_off("OFF\n12 8 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 1\n2 0 1\n2 1 1\n1 1 1\n1 2 1\n0 2 1\n6 5 4 "
               "3 2 1 0\n6 6 7 8 9 10 11\n"
               "4 0 1 7 6\n4 1 2 8 7\n4 2 3 9 8\n4 3 4 10 9\n4 4 5 11 10\n4 5 0 6 11\n",
               PIR_SURFACE_CLOSED, 0, 3);
    char text[240];
    const char *open = "OFF\n8 5 0\n" CUBE_POINTS CUBE_FACETS;
    expect_off(open, PIR_SURFACE_OPEN, 0, 1);
    require_convex(open, strlen(open), "off", text);
    assert_string_equal(text, "m:11: the surface is open: the edge from (0, 0, 0) to (0, 1, 0) is on 1 facet");
    const char *dented =
        "OFF\n5 6 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n1/2 1/2 1/2\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 4\n3 2 3 4\n3 3 1 4\n";
    expect_off(dented, PIR_SURFACE_CLOSED, 0, 4);
    require_convex(dented, strlen(dented), "off", text);
    assert_string_equal(text, "m:11: not convex: this facet is inside the convex hull; volume 4, of the hull 10.6667");
}

static void test_facets_that_rounding_bends(void **state) {
    (void)state;
    // the corner (1, 1, 1) is raised by 2^-52: the facets that have it are bent outward, and still those of a convex
    // body
    const char *out =
        "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1.0000000000000002\n0 1 1\n" CUBE_FACETS
        "4 3 0 4 7\n";
    expect_off(out, PIR_SURFACE_CLOSED, 1, 1);
    // lowered, the hull cuts the top the other way, along its other diagonal, which is as good for a facet of four
    // corners ...
    const char *in = "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 0.9999999999999998\n0 1 1\n" CUBE_FACETS
                     "4 3 0 4 7\n";
    expect_off(in, PIR_SURFACE_CLOSED, 1, 1);
    // ... and not for two triangles that meet in the diagonal below it
    const char *cut = "OFF\n8 7 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 0.9999999999999998\n0 1 1\n"
                      "4 0 3 2 1\n3 4 5 6\n3 4 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
    expect_off(cut, PIR_SURFACE_CLOSED, 0, 1 - 0x1p-52);
}

static void test_points_and_flat_bodies(void **state) {
    (void)state;
    expect_off("OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n", PIR_SURFACE_POINTS, 1, NAN);
    expect_off("OFF\n5 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 1\n", PIR_SURFACE_POINTS, 1, NAN);
    expect_off("OFF\n5 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 1/2\n", PIR_SURFACE_POINTS, 0, NAN);
    expect_off("OFF\n1 0 0\n1 2 3\n", PIR_SURFACE_POINTS, 1, NAN);
    // both sides of a triangle, one side of it, both sides of an L
    expect_off("OFF\n3 2 0\n0 0 5\n1 0 5\n0 1 5\n3 0 1 2\n3 2 1 0\n", PIR_SURFACE_CLOSED, 1, 0);
    expect_off("OFF\n3 1 0\n0 0 5\n1 0 5\n0 1 5\n3 0 1 2\n", PIR_SURFACE_OPEN, 0, 5.0 / 6);
    expect_off("OFF\n6 2 0\n0 0 1\n2 0 1\n2 1 1\n1 1 1\n1 2 1\n0 2 1\n6 0 1 2 3 4 5\n6 5 4 3 2 1 0\n",
               PIR_SURFACE_CLOSED, 0, 0);
}

static void test_facets_that_face_no_side(void **state) {
    (void)state;
    // a strip turned over once and closed by a cone over its rim: each edge on two facets, and no side to face
    expect_off("OFF\n6 10 0\n0 0 0\n5 1 0\n1 5 1\n2 2 6\n7 6 3\n3 9 4\n3 0 1 2\n3 0 2 3\n3 0 3 4\n3 0 4 5\n3 0 5 1\n3 "
               "1 2 4\n3 2 3 5\n3 3 4 1\n3 4 5 2\n3 5 1 3\n",
               PIR_SURFACE_CLOSED, 0, NAN);
}

static void test_every_format_tells_the_same(void **state) {
    (void)state;
    pir_polytope *p = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &p), PIR_OK);
    assert_int_equal(pir_mesh_from_polytope(p, &mesh), PIR_OK);
    for (int form = 0; form < MODEL_FORM_COUNT; form++) {
        struct file_bytes file = model_file(mesh, (enum model_form)form);
        double volume = form == MODEL_OFF_RATIONAL ? 1e9 / (3 * 7 * 30) : 1;
        expect_surface(file.data, file.size, model_ending((enum model_form)form),
                       (struct expected){PIR_SURFACE_CLOSED, 1, volume});
        free(file.data);
    }
    pir_mesh_destroy(mesh);
    pir_polytope_release(p);
    // a square, open in every format
    static const char *const texts[][2] = {
        {"off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"},
        {"obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"},
        {"stl", "solid\nfacet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 endloop endfacet\n"
                "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 1 0 vertex 0 1 0 endloop endfacet endsolid\n"},
        {"ply",
         "ply\nformat ascii 1.0\nelement vertex 4\nproperty int x\nproperty int y\nproperty int z\nelement face 1\n"
         "property list int int vertex_index\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"},
    };
    for (size_t i = 0; i < 4; i++)
        expect_surface(texts[i][1], strlen(texts[i][1]), texts[i][0], (struct expected){PIR_SURFACE_OPEN, 0, 0});
}

/* --- memory --- */

/* Reads a text with the request for memory number `fail_at` failing; whether that was past the last. */
static bool read_with_failure(const char *text, const char *format, uint64_t fail_at) {
    test_memory memory = {.fail_at = fail_at};
    const pir_allocator allocator = test_allocator(&memory);
    const pir_read_options options = {.size = sizeof options, .allocator = &allocator};
    pir_polytope *polytope = NULL;
    pir_surface surface;
    pir_report report = {PIR_OK, ""};
    pir_status status = pir_polytope_read_bytes(&(pir_file_bytes){text, strlen(text), "m", format}, &options, &report,
                                                &surface, &polytope);
    if (status != PIR_OK) {
        assert_int_equal(status, PIR_ERR_MEMORY);
        assert_non_null(strstr(report.text, "out of memory"));
        assert_null(polytope);
    }
    pir_polytope_release(polytope);
    assert_int_equal(memory.blocks, 0);
    assert_false(memory.wrong_size);
    return status == PIR_OK;
}

static void test_no_memory_at_every_request(void **state) {
    (void)state;
    static const char *const texts[][2] = {
        {"off", CUBE},
        {"off", "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1.0000000000000002\n0 1 1\n" CUBE_FACETS
                "4 3 0 4 7\n"},
        {"off", "OFF\n3 2 0\n0 0 1/3\n1 0 1/3\n0 1 1/3\n3 0 1 2\n3 2 1 0\n"},
        {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
        {"stl",
         "solid\nfacet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 endloop endfacet endsolid\n"},
        {"ply",
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\nproperty int z\nelement face 1\n"
         "property list int int vertex_index\nend_header\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n"},
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        uint64_t request = 1;
        while (!read_with_failure(texts[i][1], texts[i][0], request))
            request++;
        assert_true(request > 20 && request < 1000);
    }
}

/* --- random bodies --- */

/* A hull of points of a grid of even numbers as OFF, its facets changed; and what it then is. */
struct body {
    pir_polytope *hull;
    pir_mesh *mesh;
    struct file_bytes points, facets;
    uint32_t point_count, facet_count;
    struct expected expected;
};

static uint32_t add_point(struct body *body, double x, double y, double z) {
    file_print(&body->points, "%.17g %.17g %.17g\n", x, y, z);
    return body->point_count++;
}

static void add_facet(struct body *body, const uint32_t *corner, uint32_t count, bool turned) {
    file_print(&body->facets, "%u", (unsigned)count);
    for (uint32_t i = 0; i < count; i++)
        file_print(&body->facets, " %u", (unsigned)corner[turned ? count - 1 - i : i]);
    file_print(&body->facets, "\n");
    body->facet_count++;
}

/* A fan from a random corner, in which points may be doubled; triangles all turned, or each as chance has it. */
static void add_fan(test_random *random, struct body *body, const uint32_t *corner, uint32_t count, bool turned,
                    bool each) {
    uint32_t apex = test_random_below(random, count);
    for (uint32_t i = 1; i + 1 < count; i++) {
        uint32_t triangle[3] = {corner[apex], corner[(apex + i) % count], corner[(apex + i + 1) % count]};
        if (test_random_below(random, 4) == 0) {
            pir_vec3 p = pir_mesh_vertices(body->mesh)[triangle[1]];
            triangle[1] = add_point(body, p.x, p.y, p.z);
        }
        add_facet(body, triangle, 3, each ? test_random_below(random, 2) : turned);
    }
}

/* Three triangles to a point below the first corner's fan: the middle of four vertices, inside of the hull or in a
 * facet of it. */
static void add_dent(struct body *body, const uint32_t *corner, uint32_t count, pir_vec3 bottom, bool turned) {
    uint32_t point = add_point(body, bottom.x, bottom.y, bottom.z);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t triangle[3] = {corner[i], corner[i + 1 < count ? i + 1 : 0], point};
        add_facet(body, triangle, 3, turned);
    }
}

/* The middle of all vertices: strictly inside. */
static pir_vec3 middle(const pir_mesh *mesh) {
    pir_vec3 sum = {0, 0, 0};
    uint32_t count = pir_mesh_vertex_count(mesh);
    for (uint32_t v = 0; v < count; v++) {
        pir_vec3 p = pir_mesh_vertices(mesh)[v];
        sum = (pir_vec3){sum.x + p.x, sum.y + p.y, sum.z + p.z};
    }
    return (pir_vec3){sum.x / count, sum.y / count, sum.z / count};
}

/* Six times the volume of the pyramid over a facet. */
static double six_pyramid(const pir_mesh *mesh, const uint32_t *corner, uint32_t count, pir_vec3 apex) {
    const pir_vec3 *v = pir_mesh_vertices(mesh);
    double six = 0;
    for (uint32_t i = 1; i + 1 < count; i++) {
        double a[3][3];
        const uint32_t index[3] = {corner[0], corner[i], corner[i + 1]};
        for (int k = 0; k < 3; k++) {
            a[k][0] = v[index[k]].x - apex.x;
            a[k][1] = v[index[k]].y - apex.y;
            a[k][2] = v[index[k]].z - apex.z;
        }
        six += a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
               a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    }
    return six;
}

/* The first four leave a body convex. */
enum change { AS_IT_IS, TURNED, EACH_TURNED, DOUBLED, DENTED, LEFT_OUT, CHANGE_COUNT };

static void make_facets(test_random *random, struct body *body, enum change change) {
    uint32_t facets = pir_mesh_facet_count(body->mesh), chosen = test_random_below(random, facets);
    bool turned = change == TURNED || (change == DENTED && test_random_below(random, 2));
    double volume = pir_polytope_volume(body->hull);
    body->expected = (struct expected){PIR_SURFACE_CLOSED, change <= DOUBLED, volume};
    for (uint32_t f = 0; f < facets; f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(body->mesh, f, &count);
        if (f == chosen && change == LEFT_OUT) {
            body->expected.form = PIR_SURFACE_OPEN;
            body->expected.volume -= six_pyramid(body->mesh, corner, count, (pir_vec3){0, 0, 0}) / 6;
        } else if (f == chosen && change == DENTED) {
            add_dent(body, corner, count, middle(body->mesh), turned);
            body->expected.volume -= six_pyramid(body->mesh, corner, count, middle(body->mesh)) / 6;
        } else if (test_random_below(random, 2)) {
            add_fan(random, body, corner, count, turned, change == EACH_TURNED);
        } else {
            add_facet(body, corner, count, change == EACH_TURNED ? test_random_below(random, 2) : turned);
        }
        // flaps of no thickness on the boundary of a convex body leave it what it is
        for (int again = 0; change == DOUBLED && again < 2; again++)
            add_facet(body, corner, count, again);
    }
    if (turned)
        body->expected.volume *= -1;
}

static void make_body(test_random *random, struct body *body, enum change change) {
    test_points points;
    *body = (struct body){0};
    do {
        pir_polytope_release(body->hull);
        test_body_points(random, test_random_below(random, 2) ? TEST_GRID : TEST_BOX, 24, &points);
        body->hull = test_polytope(&points);
    } while (pir_polytope_dimension(body->hull) < 3);
    assert_int_equal(pir_mesh_from_polytope(body->hull, &body->mesh), PIR_OK);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(body->mesh); v++) {
        pir_vec3 p = pir_mesh_vertices(body->mesh)[v];
        add_point(body, p.x, p.y, p.z);
    }
    make_facets(random, body, change);
    if (test_random_below(random, 4) > 0)
        return;
    // a facet of one place, and one of two, which change nothing
    pir_vec3 p = pir_mesh_vertices(body->mesh)[0];
    uint32_t corner[3] = {0, add_point(body, p.x, p.y, p.z), add_point(body, p.x, p.y, p.z)};
    add_facet(body, corner, 3, false);
    corner[2] = 1;
    add_facet(body, corner, 3, false);
}

static void test_random_bodies(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 600; i++) {
        test_random random = test_random_case("surfaces", i);
        struct body body;
        make_body(&random, &body, (enum change)(i % CHANGE_COUNT));
        struct file_bytes file = {0};
        file_print(&file, "OFF\n%u %u 0\n", (unsigned)body.point_count, (unsigned)body.facet_count);
        file_append(&file, body.points.data, body.points.size);
        file_append(&file, body.facets.data, body.facets.size);
        pir_surface surface = read_surface(file.data, file.size, "off");
        // by chance all facets are turned, and then the volume is negative
        if (i % CHANGE_COUNT == EACH_TURNED)
            surface.volume = fabs(surface.volume);
        if (surface.form != body.expected.form || surface.convex != body.expected.convex ||
            fabs(surface.volume - body.expected.volume) > 1e-9 * pir_polytope_volume(body.hull))
            fail_msg("case %u: form %d, convex %d, volume %.17g, not %d, %d, %.17g\n%.*s", (unsigned)i,
                     (int)surface.form, surface.convex, surface.volume, (int)body.expected.form, body.expected.convex,
                     body.expected.volume, (int)file.size, (const char *)file.data);
        free(file.data);
        free(body.points.data);
        free(body.facets.data);
        pir_mesh_destroy(body.mesh);
        pir_polytope_release(body.hull);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_cube_in_every_way),
        cmocka_unit_test(test_facets_of_one_place_or_two),
        cmocka_unit_test(test_what_is_not_convex),
        cmocka_unit_test(test_facets_that_rounding_bends),
        cmocka_unit_test(test_points_and_flat_bodies),
        cmocka_unit_test(test_facets_that_face_no_side),
        cmocka_unit_test(test_every_format_tells_the_same),
        cmocka_unit_test(test_no_memory_at_every_request),
        cmocka_unit_test(test_random_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/* The model maker: every name gives the polytope that books describe, families follow their formulas,
   bad names are refused. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "support/memory.h"

/* What a shape must be. `triangles` is the sum over facets of corners − 2; `uniform` means one edge
   length and one circumradius. */
struct expected {
    const char *name;
    uint32_t vertices, edges, facets, triangles;
    bool uniform;
};

static const struct expected known[] = {
    // the models of Behar and Lien's Figure 3, whose facet counts are of triangles
    {"cone", 41, 80, 41, 78, false},
    {"cube", 8, 12, 6, 12, true},
    {"cylinder", 72, 108, 38, 140, false},
    {"dd", 18, 48, 32, 32, false},
    {"ellipse", 482, 1440, 960, 960, false},
    {"gs1", 42, 120, 80, 80, false},
    {"gs2", 92, 270, 180, 180, false},
    {"gs3", 162, 480, 320, 320, false},
    {"gs4", 252, 750, 500, 500, false},
    {"hp", 7, 12, 7, 10, false},
    {"t", 32, 90, 60, 60, false},
    {"ti", 120, 180, 62, 236, true},
    {"vrod", 164, 486, 324, 324, false},
    // platonic
    {"tetrahedron", 4, 6, 4, 4, true},
    {"octahedron", 6, 12, 8, 8, true},
    {"dodecahedron", 20, 30, 12, 36, true},
    {"icosahedron", 12, 30, 20, 20, true},
    // archimedean
    {"truncated-tetrahedron", 12, 18, 8, 20, true},
    {"cuboctahedron", 12, 24, 14, 20, true},
    {"truncated-cube", 24, 36, 14, 44, true},
    {"truncated-octahedron", 24, 36, 14, 44, true},
    {"rhombicuboctahedron", 24, 48, 26, 44, true},
    {"truncated-cuboctahedron", 48, 72, 26, 92, true},
    {"snub-cube", 24, 60, 38, 44, true},
    {"icosidodecahedron", 30, 60, 32, 56, true},
    {"truncated-dodecahedron", 60, 90, 32, 116, true},
    {"truncated-icosahedron", 60, 90, 32, 116, true},
    {"rhombicosidodecahedron", 60, 120, 62, 116, true},
    {"truncated-icosidodecahedron", 120, 180, 62, 236, true},
    {"snub-dodecahedron", 60, 150, 92, 116, true},
    // families as they come
    {"geodesic", 252, 750, 500, 500, false},
    {"ellipsoid", 482, 1440, 960, 960, false},
    {"box", 8, 12, 6, 12, false},
    {"prism", 12, 18, 8, 20, false},
    {"antiprism", 12, 24, 14, 20, false},
    {"pyramid", 5, 8, 5, 6, false},
    {"dipyramid", 8, 18, 12, 12, false},
    {"needle", 10, 24, 16, 16, false},
    {"rod", 74, 216, 144, 144, false},
    {"polygon", 6, 6, 2, 8, false},
    {"triangle", 3, 3, 2, 2, false},
    {"segment", 2, 1, 0, 0, false},
    {"point", 1, 0, 0, 0, false},
    // and of other sizes
    {"geodesic?level=0", 12, 30, 20, 20, true},
    {"geodesic?level=1", 42, 120, 80, 80, false},
    {"geodesic?level=20&radius=3.7", 4412, 13230, 8820, 8820, false},
    {"ellipsoid?level=2&x=1&y=1&z=1", 6, 12, 8, 8, true},
    {"ellipsoid?level=3", 14, 36, 24, 24, false},
    {"ellipsoid?level=33&x=1e-3&y=5&z=1e6", 2114, 6336, 4224, 4224, false},
    {"ellipsoid?level=60&z=0.01", 7082, 21240, 14160, 14160, false},
    {"cone?sides=3", 4, 6, 4, 4, false},
    {"cone?sides=1000&radius=0.1&height=17", 1001, 2000, 1001, 1998, false},
    {"cylinder?sides=1001&radius=0.3", 2002, 3003, 1003, 4000, false},
    {"prism?sides=3&height=1e-9", 6, 9, 5, 8, false},
    {"antiprism?sides=3", 6, 12, 8, 8, false},
    {"antiprism?sides=77&height=0.01", 154, 308, 156, 304, false},
    {"dipyramid?sides=17", 19, 51, 34, 34, false},
    {"rod?sides=3&rings=1", 8, 18, 12, 12, false},
    {"rod?sides=40&rings=9&height=1e-6", 722, 2160, 1440, 1440, false},
    {"rod?sides=5&rings=7", 72, 210, 140, 140, false},
    {"polygon?sides=100000", 100000, 100000, 2, 199996, false},
    {"random?points=1&seed=9", 1, 0, 0, 0, false},
    {"random?points=4", 4, 6, 4, 4, false},
    {"random-sphere", 100, 294, 196, 196, false},
    {"random-sphere?points=1000&seed=9007199254740992", 1000, 2994, 1996, 1996, false},
};

static pir_polytope *make_shape(const char *name) {
    pir_polytope *polytope = NULL;
    pir_report report = {PIR_OK, ""};
    const pir_status status = pir_shape_create(name, NULL, &report, &polytope);
    expect(status == PIR_OK && polytope, "%s: %s", name, report.text);
    return polytope;
}

static double edge_length(const pir_polytope *polytope, uint32_t edge) {
    uint32_t ends[2];
    pir_polytope_edge(polytope, edge, ends);
    const pir_vec3 a = pir_polytope_vertex(polytope, ends[0]), b = pir_polytope_vertex(polytope, ends[1]);
    return sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

static void expect_uniform(const pir_polytope *polytope, const char *name) {
    const double length = edge_length(polytope, 0);
    for (uint32_t e = 1; e < pir_polytope_edge_count(polytope); e++)
        expect(fabs(edge_length(polytope, e) / length - 1) < 1e-5, "%s, edge %u", name, e);
    const pir_vec3 first = pir_polytope_vertex(polytope, 0);
    const double radius = hypot(hypot(first.x, first.y), first.z);
    for (uint32_t v = 1; v < pir_polytope_vertex_count(polytope); v++) {
        const pir_vec3 a = pir_polytope_vertex(polytope, v);
        expect(fabs(hypot(hypot(a.x, a.y), a.z) / radius - 1) < 2e-6, "%s, vertex %u", name, v);
    }
}

static void expect_shape(const struct expected *want) {
    pir_polytope *polytope = make_shape(want->name);
    const uint32_t vertices = pir_polytope_vertex_count(polytope), edges = pir_polytope_edge_count(polytope),
                   facets = pir_polytope_facet_count(polytope);
    uint32_t triangles = 0;
    for (uint32_t f = 0; f < facets; f++)
        triangles += pir_polytope_facet_size(polytope, f) - 2;
    expect(vertices == want->vertices && edges == want->edges && facets == want->facets && triangles == want->triangles,
           "%s: %u/%u/%u, %u triangles", want->name, vertices, edges, facets, triangles);
    expect(facets < 3 || vertices - edges + facets == 2, "%s", want->name);
    expect(pir_polytope_is_valid(polytope), "%s", want->name);
    if (want->uniform)
        expect_uniform(polytope, want->name);
    pir_polytope_release(polytope);
}

static void shapes_have_their_books_counts(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        expect_shape(&known[i]);
}

static void every_listed_name_is_known_and_explained(void **state) {
    (void)state;
    const size_t count = pir_shape_count();
    assert_true(count > 40);
    for (size_t i = 0; i < count; i++) {
        const char *name = pir_shape_name(i), *help = pir_shape_help(i);
        expect(help && *help && !strchr(help, '\n'), "%s", name);
        size_t k = 0;
        while (k < sizeof known / sizeof known[0] && strcmp(known[k].name, name) != 0)
            k++;
        // the hull of random points has no count to look up
        expect(k < sizeof known / sizeof known[0] || strcmp(name, "random") == 0, "%s is not in this test's table",
               name);
        for (size_t j = 0; j < i; j++)
            expect(strcmp(pir_shape_name(j), name) != 0, "%s twice", name);
        pir_polytope_release(make_shape(name));
    }
    assert_null(pir_shape_name(count));
    assert_null(pir_shape_help(count));
    assert_null(pir_shape_name(SIZE_MAX));
}

static void sizes_are_as_asked(void **state) {
    (void)state;
    pir_polytope *box = make_shape("box?z=3e0&x=.5&y=+2.25");
    pir_vec3 low, high;
    pir_polytope_bounds(box, &low, &high);
    assert_true(low.x == -0.25 && high.x == 0.25 && low.y == -1.125 && high.y == 1.125 && low.z == -1.5 &&
                high.z == 1.5);
    pir_polytope_release(box);
    // decimals are the nearest doubles: a segment's end is half of its length
    static const struct {
        const char *name;
        double length;
    } segments[] = {
        {"segment?length=0.1", 0.1},         {"segment?length=1e-9", 1e-9},   {"segment?length=123456.789", 123456.789},
        {"segment?length=100000000e1", 1e9}, {"segment?length=000.300", 0.3}, {"segment?length=2.", 2}};
    for (size_t i = 0; i < sizeof segments / sizeof segments[0]; i++) {
        pir_polytope *segment = make_shape(segments[i].name);
        pir_polytope_bounds(segment, &low, &high);
        expect(high.z - low.z == segments[i].length, "%s: %.17g", segments[i].name, high.z - low.z);
        pir_polytope_release(segment);
    }
    pir_polytope *cube = make_shape("cube");
    assert_true(pir_polytope_volume(cube) == 1);
    pir_polytope_release(cube);
}

static void seeds_give_other_points(void **state) {
    (void)state;
    pir_polytope *a = make_shape("random?seed=1"), *b = make_shape("random?seed=2"), *c = make_shape("random");
    const pir_vec3 va = pir_polytope_vertex(a, 0), vb = pir_polytope_vertex(b, 0), vc = pir_polytope_vertex(c, 0);
    assert_true(va.x != vb.x);
    assert_memory_equal(&va, &vc, sizeof va);
    for (uint32_t v = 0; v < pir_polytope_vertex_count(a); v++) {
        const pir_vec3 p = pir_polytope_vertex(a, v);
        assert_true(p.x * p.x + p.y * p.y + p.z * p.z <= 1);
    }
    pir_polytope_release(a);
    pir_polytope_release(b);
    pir_polytope_release(c);
}

/* FNV-1a (Fowler, Noll, Vo) of the vertices of every shape, byte by byte from the lowest. */
static void all_shapes_have_the_same_bits_everywhere(void **state) {
    (void)state;
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < pir_shape_count(); i++) {
        pir_polytope *polytope = make_shape(pir_shape_name(i));
        for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope); v++) {
            const pir_vec3 a = pir_polytope_vertex(polytope, v);
            const double c[3] = {a.x, a.y, a.z};
            for (int k = 0; k < 24; k++) {
                uint64_t bits;
                memcpy(&bits, &c[k / 8], sizeof bits);
                hash = (hash ^ (bits >> 8 * (k % 8) & 255)) * UINT64_C(0x100000001b3);
            }
        }
        pir_polytope_release(polytope);
    }
    expect(hash == UINT64_C(0xd2f93856208920b6), "hash %#llx", (unsigned long long)hash);
}

static void bad_names_are_refused_with_a_reason(void **state) {
    (void)state;
    static const struct {
        const char *name, *says;
    } bad[] = {
        {"", "unknown shape"},
        {"cub", "'cube'"},
        {"Cube", "'cube'"},
        {"dodecahedrom", "'dodecahedron'"},
        {"truncated-icosahedrons", "'truncated-icosahedron'"},
        {"cube ", "'cube'"},
        {"cu\nbe", "'cu?be'"},
        {"cu\xc3\xa9", "'cu?\?'"},
        {"a name so long that no report of two hundred and forty bytes could hold it, were it not cut somewhere: no "
         "report of two "
         "hundred and forty bytes could hold it, were it not cut somewhere, and so on and so on and so on and so on",
         "unknown shape 'a name so long"},
        {"cube?", "'' is not key=value"},
        {"cube?side=2", "no parameter 'side'; its parameters: none"},
        {"gs1?level=2", "no parameter 'level'"},
        {"geodesic?=2", "no parameter ''; its parameters: level, radius"},
        {"box?x", "'x' is not key=value"},
        {"box?x=1&", "'' is not key=value"},
        {"box?x=1&x=1", "x is given twice"},
        {"box?w=1", "its parameters: x, y, z"},
        {"box?x=", "x= is not a number"},
        {"box?x=nan", "x=nan is not a number"},
        {"box?x=inf", "x=inf is not a number"},
        {"box?x=-1", "x=-1 is not a number from 1e-09 to 1e+09"},
        {"box?x=0", "x=0 is not a number"},
        {"box?x=0x1", "x=0x1"},
        {"box?x=1e", "x=1e "},
        {"box?x=1e+", "x=1e+"},
        {"box?x=1e9999999999", "x=1e9999999999"},
        {"box?x=1e-999", "x=1e-999"},
        {"box?x=1 ", "x=1 "},
        {"box?x=1.2.3", "x=1.2.3"},
        {"box?x=.", "x=."},
        {"box?x=1?y=2", "x=1?y=2"},
        {"box?x==1", "x==1"},
        {"geodesic?level=-1", "whole number from 0 to 446"},
        {"geodesic?level=2.5", "level=2.5 is not a whole number"},
        {"geodesic?level=447", "level=447"},
        {"geodesic?level=1e9", "level=1e9"},
        {"ellipsoid?level=1", "level=1 "},
        {"cone?sides=2", "sides=2"},
        {"cone?sides=1000000", "sides=1000000"},
        {"random?points=2000000", "points=2000000"},
        {"random?points=0", "points=0"},
        {"random?seed=-1", "seed=-1"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        pir_polytope *polytope = NULL;
        pir_report report = {PIR_OK, ""};
        const pir_status status = pir_shape_create(bad[i].name, NULL, &report, &polytope);
        expect(status == PIR_ERR_ARGUMENT && !polytope && report.status == status, "%s", bad[i].name);
        expect(strstr(report.text, bad[i].says) && !strchr(report.text, '\n'), "%s: %s", bad[i].name, report.text);
        assert_int_equal(pir_shape_create(bad[i].name, NULL, NULL, &polytope), PIR_ERR_ARGUMENT);
    }
    pir_polytope *polytope = NULL;
    assert_int_equal(pir_shape_create(NULL, NULL, NULL, &polytope), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_shape_create("cube", NULL, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_null(polytope);
}

static void memory_that_runs_out_is_a_status(void **state) {
    (void)state;
    bool failed = true;
    for (uint64_t n = 1; failed; n++) {
        assert_true(n < 10000);
        test_memory memory = {.fail_at = n};
        const pir_allocator allocator = test_allocator(&memory);
        pir_polytope *polytope = NULL;
        pir_report report = {PIR_OK, ""};
        const pir_status status = pir_shape_create("geodesic?level=2", &allocator, &report, &polytope);
        failed = status != PIR_OK;
        assert_true(failed ? status == PIR_ERR_MEMORY && report.status == status && !polytope : memory.requests < n);
        pir_polytope_release(polytope);
        assert_true(memory.blocks == 0 && memory.bytes == 0 && !memory.wrong_size);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_have_their_books_counts),
        cmocka_unit_test(every_listed_name_is_known_and_explained),
        cmocka_unit_test(sizes_are_as_asked),
        cmocka_unit_test(seeds_give_other_points),
        cmocka_unit_test(all_shapes_have_the_same_bits_everywhere),
        cmocka_unit_test(bad_names_are_refused_with_a_reason),
        cmocka_unit_test(memory_that_runs_out_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

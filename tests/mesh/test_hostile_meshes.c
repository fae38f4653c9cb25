/* SPDX-License-Identifier: MIT */
/*
 * Meshes that were made to do harm: counts and indices that lie, numbers that are none, no area anywhere, all triangles
 * in one plane or through one point. Each ends with an error that names the place, or with an answer; memory is
 * bounded by what is there, not by what is claimed. PIR_TEST_TRIANGLES is how many triangles share one point; with a
 * million it is the slow suite's.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/trimesh_pair.h>

#include "mesh/mesh_models.h"
#include "support/memory.h"

/* What a refusal may take: nothing that grows with the count that is claimed. */
#define SMALL 65536

static uint32_t many(void) {
    const char *text = getenv("PIR_TEST_TRIANGLES");
    return text ? (uint32_t)strtoul(text, NULL, 10) : 20000;
}

/* --- files that lie --- */

static void expect_refused_file(const void *bytes, size_t size, const char *format, const char *words) {
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_trimesh_options options = pir_trimesh_options_default();
    options.allocator = &allocator;
    pir_trimesh *mesh = NULL;
    pir_report report = {0};
    pir_file_bytes file = {bytes, size, "lie", format};
    pir_status status = pir_trimesh_read_bytes(&file, &options, &report, &mesh);
    expect(status != PIR_OK && !mesh, "%s: it was read", format);
    expect(strstr(report.text, "lie") && strstr(report.text, words), "%s: '%s' without '%s'", format, report.text,
           words);
    expect(memory.peak < SMALL && memory.blocks == 0, "%s: %zu bytes at a time, %zu blocks left", format, memory.peak,
           memory.blocks);
}

static void refused_text(const char *text, const char *format, const char *words) {
    expect_refused_file(text, strlen(text), format, words);
}

#define PLY_HEAD(vertices, faces)                                                                                      \
    "ply\nformat ascii 1.0\nelement vertex " vertices                                                                  \
    "\nproperty double x\nproperty double y\nproperty double z\nelement face " faces                                   \
    "\nproperty list uchar int vertex_indices\nend_header\n"

static void CountsAndIndicesThatLieAreRefusedByPlace(void **state) {
    (void)state;
    refused_text("OFF\n100000000 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "off", "lie:");
    refused_text("OFF\n3 100000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "off", "lie:");
    refused_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 100000000\n", "off", "lie:6");
    refused_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n100000000 0 1 2\n", "off", "lie:6");
    refused_text("OFF\n3 1 0\n0 nan 0\n1 0 0\n0 1 0\n3 0 1 2\n", "off", "lie:3");
    refused_text("OFF\n3 1 0\n0 0 0\n1 1e999 0\n0 1 0\n3 0 1 2\n", "off", "lie:4");
    refused_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 100000000\n", "obj", "lie:4");
    refused_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -100000000\n", "obj", "lie:4");
    refused_text(PLY_HEAD("100000000", "1") "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "ply", "lie:");
    refused_text(PLY_HEAD("3", "100000000") "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "ply", "lie:");
    refused_text(PLY_HEAD("3", "1") "0 0 0\n1 0 0\n0 1 0\n3 0 1 100000000\n", "ply", "lie:13");
    // a binary STL of one triangle that claims as many
    unsigned char stl[84 + 50] = {0};
    const uint32_t claimed = 100000000;
    memcpy(stl + 80, &claimed, sizeof claimed);
    expect_refused_file(stl, sizeof stl, "stl", "lie:");
}

static void ArraysThatLieAreRefusedByTriangle(void **state) {
    (void)state;
    mesh_arrays plane = mesh_plane(50);
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_trimesh_options options = pir_trimesh_options_default();
    options.allocator = &allocator;
    pir_trimesh_arrays arrays = mesh_arrays_of(&plane);
    pir_trimesh *mesh = NULL;
    pir_report report = {0};
    plane.triangle[4321][2] = 100000000;
    assert_int_equal(pir_trimesh_create(&arrays, &options, &report, &mesh), PIR_ERR_ARGUMENT);
    expect(strstr(report.text, "triangle 4321: corner 2 is vertex 100000000"), "'%s'", report.text);
    plane.triangle[4321][2] = plane.triangle[4320][2];
    plane.vertex[plane.triangle[4999][1]].z = NAN;
    assert_int_equal(pir_trimesh_create(&arrays, &options, &report, &mesh), PIR_ERR_NOT_FINITE);
    expect(strstr(report.text, "triangle 4999: vertex"), "'%s'", report.text);
    assert_true(!mesh && memory.blocks == 0);
    mesh_arrays_clear(&plane);
}

static void ManyTrianglesWithoutAnAreaAreNone(void **state) {
    (void)state;
    mesh_arrays fan = mesh_fan(many());
    // points of one line, which no doubles hold evenly
    for (uint32_t v = 0; v < fan.vertices; v++)
        fan.vertex[v] = (pir_vec3){0.1 * (v % 97), 0.1 * (v % 97), 0.1 * (v % 97)};
    pir_trimesh_arrays arrays = mesh_arrays_of(&fan);
    pir_trimesh *mesh = NULL;
    pir_report report = {0};
    assert_int_equal(pir_trimesh_create(&arrays, NULL, &report, &mesh), PIR_ERR_EMPTY);
    assert_non_null(strstr(report.text, "has an area"));
    // one that has an area is found among them
    fan.vertex[3 * (fan.triangles / 2)].x += 1;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, &report, &mesh), PIR_OK);
    pir_trimesh_info info;
    pir_trimesh_describe(mesh, &info);
    assert_int_equal(info.degenerate, info.triangles - 1);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&fan);
}

/* --- pairs --- */

static pir_trimesh_pair *pair_of(pir_trimesh *p, pir_trimesh *q) {
    pir_trimesh_pair *pair = NULL;
    assert_int_equal(pir_trimesh_pair_create(p, q, NULL, &pair), PIR_OK);
    return pair;
}

/* One plane within itself, above itself, and beside itself: which two are told is the lowest of very many. */
static void AllTrianglesInOnePlaneAreAnswered(void **state) {
    (void)state;
    mesh_arrays plane = mesh_plane(24);
    pir_trimesh *mesh = mesh_of(&plane, NULL);
    pir_trimesh_pair *pair = pair_of(mesh, mesh);
    static const struct {
        pir_vec3 at;
        pir_trimesh_state state;
        double distance;
    } cases[] = {{{0, 0, 0}, PIR_TRIMESH_MEET, 0},
                 {{0.25, 0.125, 0}, PIR_TRIMESH_MEET, 0},
                 {{0, 0, 0.5}, PIR_TRIMESH_APART, 0.5},
                 {{0.25, 0.125, 0.5}, PIR_TRIMESH_APART, 0.5},
                 {{26, 0, 0}, PIR_TRIMESH_APART, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pir_pose p = {{0, 0, 0, 1}, cases[i].at}, q = pir_pose_identity();
        pir_trimesh_distance near, far;
        assert_int_equal(pir_trimesh_pair_nearest(pair, p, q, &near), PIR_OK);
        assert_int_equal(pir_trimesh_pair_farthest(pair, p, q, &far), PIR_OK);
        expect(near.state == cases[i].state && near.distance == cases[i].distance, "case %zu: state %d at %.17g", i,
               near.state, near.distance);
        // P's first triangle has Q's first within its reach in all cases but that beside it
        uint32_t first = i < 4 ? 0 : near.triangle_p;
        expect(near.triangle_p == first && (i == 4 || near.triangle_q == 0), "case %zu: triangles %u and %u", i,
               near.triangle_p, near.triangle_q);
        double x = fmax(24 + cases[i].at.x, 24 - cases[i].at.x), y = fmax(24 + cases[i].at.y, 24 - cases[i].at.y);
        double most = sqrt(x * x + y * y + cases[i].at.z * cases[i].at.z);
        expect(fabs(far.distance - most) < 1e-12, "case %zu: farthest %.17g, not %.17g", i, far.distance, most);
    }
    pir_trimesh_pair_destroy(pair);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&plane);
}

/* Two fans whose one point is one place, seen from one side and from both. */
static void TrianglesThroughOnePointAreAnswered(void **state) {
    (void)state;
    mesh_arrays fan = mesh_fan(many());
    pir_trimesh *mesh = mesh_of(&fan, NULL);
    pir_trimesh_pair *pair = pair_of(mesh, mesh);
    pir_trimesh_distance answer;
    const pir_pose mirrored = {{1, 0, 0, 0}, {0, 0, 0}}, stands = pir_pose_identity();
    assert_int_equal(pir_trimesh_pair_nearest(pair, mirrored, stands, &answer), PIR_OK);
    assert_true(answer.state == PIR_TRIMESH_MEET && answer.triangle_p == 0 && answer.triangle_q == 0);
    // the points of both fans are the nearest: of all triangles at one distance the lowest are told
    const pir_pose above = {{1, 0, 0, 0}, {0, 0, -0.5}};
    assert_int_equal(pir_trimesh_pair_nearest(pair, above, stands, &answer), PIR_OK);
    expect(answer.state == PIR_TRIMESH_APART && answer.distance == 0.5 && answer.triangle_p == 0 &&
               answer.triangle_q == 0,
           "state %d, %u and %u at %.17g", answer.state, answer.triangle_p, answer.triangle_q, answer.distance);
    pir_trimesh_pair_statistics counts = pir_trimesh_pair_get_statistics(pair);
    expect(counts.bytes < 64 * (size_t)many() + (1 << 22), "%zu bytes for %u triangles", counts.bytes, many());
    pir_trimesh_pair_destroy(pair);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&fan);
}

/* The nearest two of two fans, point to point, of which triangle `at` of P is another one. */
static pir_trimesh_distance nearest_with(uint32_t at, const pir_vec3 corner[3], bool reversed) {
    mesh_arrays p = mesh_fan(400), q = mesh_fan(400);
    for (uint32_t i = 0; reversed && i < 200; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t v = p.triangle[i][k];
            p.triangle[i][k] = p.triangle[399 - i][k];
            p.triangle[399 - i][k] = v;
        }
    for (int k = 0; corner && k < 3; k++)
        p.vertex[p.triangle[at][k]] = corner[k];
    pir_trimesh *mesh[2] = {mesh_of(&p, NULL), mesh_of(&q, NULL)};
    pir_trimesh_pair *pair = pair_of(mesh[0], mesh[1]);
    pir_trimesh_distance answer, again;
    const pir_pose above = {{1, 0, 0, 0}, {0, 0, -0.625}}, off = {{1, 0, 0.001, 0}, {0, 0, -0.625}};
    // a pair that has been elsewhere says what a new one says
    assert_int_equal(pir_trimesh_pair_nearest(pair, above, pir_pose_identity(), &answer), PIR_OK);
    assert_int_equal(pir_trimesh_pair_nearest(pair, off, pir_pose_identity(), &again), PIR_OK);
    assert_int_equal(pir_trimesh_pair_nearest(pair, above, pir_pose_identity(), &again), PIR_OK);
    assert_true(again.triangle_p == answer.triangle_p && again.triangle_q == answer.triangle_q &&
                again.distance == answer.distance);
    pir_trimesh_pair_destroy(pair);
    for (int i = 0; i < 2; i++)
        pir_trimesh_release(mesh[i]);
    mesh_arrays_clear(&p);
    mesh_arrays_clear(&q);
    return answer;
}

static void expect_nearest(const pir_trimesh_distance *answer, uint32_t p, double distance) {
    expect(answer->triangle_p == p && answer->triangle_q == 0 && answer->distance == distance,
           "triangles %u and %u at %.17g, not %u and 0 at %.17g", answer->triangle_p, answer->triangle_q,
           answer->distance, p, distance);
}

/* 160,000 pairs as near: the lowest is told, one that is nearer by a hair, and one that is as near elsewhere. */
static void OfManyTiesTheNearestAndTheLowestAreTold(void **state) {
    (void)state;
    const pir_vec3 nearer[3] = {{0, 0, -0x1p-40}, {1, 0, 1}, {0, 1, 1}};
    // (3/8, 0, -1/2) is 5/8 from the point of Q, exactly
    const pir_vec3 as_near[3] = {{0.375, 0, -0.125}, {1, 0, 1}, {1, 0.5, 1}};
    for (int reversed = 0; reversed < 2; reversed++) {
        pir_trimesh_distance plain = nearest_with(0, NULL, reversed);
        expect_nearest(&plain, 0, 0.625);
        static const uint32_t places[3] = {0, 177, 399};
        for (int i = 0; i < 3; i++) {
            pir_trimesh_distance hair = nearest_with(places[i], nearer, reversed);
            expect_nearest(&hair, places[i], 0.625 - 0x1p-40);
            pir_trimesh_distance tie = nearest_with(places[i], as_near, reversed);
            expect_nearest(&tie, 0, 0.625);
        }
    }
}

/* Slivers whose boxes are far larger than they are, and rims whose points all have one that is about as far. */
static void FarthestPointsOfSliversAreFound(void **state) {
    (void)state;
    mesh_arrays fan = mesh_fan(10000);
    pir_trimesh *mesh = mesh_of(&fan, NULL);
    pir_trimesh_pair *pair = pair_of(mesh, mesh);
    pir_trimesh_distance answer;
    const pir_pose above = {{1, 0, 0, 0}, {0, 0, -0.5}};
    assert_int_equal(pir_trimesh_pair_farthest(pair, above, pir_pose_identity(), &answer), PIR_OK);
    // rims of radius 1 at heights 1 and -1.5
    double most = sqrt(4 + 2.5 * 2.5);
    expect(answer.distance <= most + 1e-12 && answer.distance > most - 1e-6, "farthest %.17g", answer.distance);
    pir_trimesh_pair_destroy(pair);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&fan);
}

static void ThePointOfManyTrianglesIsAsked(void **state) {
    (void)state;
    mesh_arrays fan = mesh_fan(many());
    pir_trimesh *mesh = mesh_of(&fan, NULL);
    pir_surface_ref ref = {.mesh = mesh};
    pir_surface_ray ray = {{0, 0, -1}, {0, 0, 2}, PIR_RAY_BOTH};
    pir_ray_hit hit;
    assert_int_equal(pir_surface_ray_nearest(ref, &ray, &hit), PIR_OK);
    assert_true(hit.triangle == 0 && hit.time == 0.5);
    pir_surface_nearest nearest;
    assert_int_equal(pir_surface_nearest_point(ref, (pir_vec3){0, 0, -1}, HUGE_VAL, &nearest), PIR_OK);
    assert_true(nearest.triangle == 0 && nearest.distance == 1);
    size_t count;
    const pir_vec3 point = {0, 0, 0};
    assert_int_equal(pir_surface_box(ref, point, point, 0, NULL, &count), PIR_OK);
    assert_int_equal(count, many());
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&fan);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(CountsAndIndicesThatLieAreRefusedByPlace),
        cmocka_unit_test(ArraysThatLieAreRefusedByTriangle),
        cmocka_unit_test(ManyTrianglesWithoutAnAreaAreNone),
        cmocka_unit_test(AllTrianglesInOnePlaneAreAnswered),
        cmocka_unit_test(TrianglesThroughOnePointAreAnswered),
        cmocka_unit_test(OfManyTiesTheNearestAndTheLowestAreTold),
        cmocka_unit_test(FarthestPointsOfSliversAreFound),
        cmocka_unit_test(ThePointOfManyTrianglesIsAsked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

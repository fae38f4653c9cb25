/* SPDX-License-Identifier: MIT */
/* Calls that read, without what they read or without a place for what they make: refused with a line, nothing made. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/cspace.h>
#include <pirouette/grid.h>
#include <pirouette/history.h>
#include <pirouette/solid.h>
#include <pirouette/sum.h>

static void refused(pir_status status, pir_report *report) {
    assert_int_equal(status, PIR_ERR_ARGUMENT);
    expect(report->status == PIR_ERR_ARGUMENT && report->text[0] && !strchr(report->text, '\n'), "'%s'", report->text);
    *report = (pir_report){0};
}

static void tables_need_a_file_and_a_place(void **state) {
    (void)state;
    pir_report report = {0};
    pir_grid *grid = NULL;
    pir_pose *poses = NULL;
    size_t count = 7;
    refused(pir_grid_read(NULL, NULL, &report, &grid), &report);
    refused(pir_grid_read("x", NULL, &report, NULL), &report);
    refused(pir_grid_read_bytes(NULL, 1, "x", NULL, &report, &grid), &report);
    refused(pir_grid_read_bytes("1 0 0 0", 7, "x", NULL, &report, NULL), &report);
    refused(pir_cspace_read_poses(NULL, NULL, &report, &poses, &count), &report);
    refused(pir_cspace_read_poses("x", NULL, &report, NULL, &count), &report);
    refused(pir_cspace_read_poses("x", NULL, &report, &poses, NULL), &report);
    assert_true(!grid && !poses && count == 7);
}

static void slices_need_a_file_and_a_place(void **state) {
    (void)state;
    pir_report report = {0};
    const pir_cspace_place place = {0};
    pir_cspace *cspace = NULL;
    pir_cspace_job *job = NULL;
    const pir_halfspace *planes;
    uint32_t count;
    pir_slice slice;
    pir_sum *sum = NULL;
    pir_mesh *mesh = NULL;
    refused(pir_cspace_open(NULL, NULL, &report, &cspace), &report);
    refused(pir_cspace_open("x", NULL, &report, NULL), &report);
    refused(pir_cspace_slice(NULL, place, &report, &slice), &report);
    refused(pir_cspace_planes(NULL, place, &report, &planes, &count), &report);
    refused(pir_cspace_sum(NULL, place, &report, &sum), &report);
    refused(pir_cspace_mesh(NULL, place, PIR_DOUBLE, &report, &mesh), &report);
    refused(pir_cspace_mesh(NULL, place, PIR_DOUBLE, &report, NULL), &report);
    refused(pir_cspace_job_create(NULL, NULL, NULL, NULL, &report, &job), &report);
    refused(pir_cspace_job_run(NULL, &report), &report);
    refused(pir_cspace_job_assemble(NULL, &report), &report);
    assert_true(!cspace && !job && !sum && !mesh);
}

static void solids_sums_and_histories_need_a_file_and_a_place(void **state) {
    (void)state;
    pir_report report = {0};
    pir_solid *solid = NULL;
    pir_sum *sum = NULL;
    const pir_file_bytes none = {NULL, 1, "x", "off"}, formless = {"OFF", 3, "x", NULL};
    refused(pir_solid_read(NULL, NULL, &report, &solid), &report);
    refused(pir_solid_read("x", NULL, &report, NULL), &report);
    refused(pir_solid_read_bytes(NULL, NULL, &report, &solid), &report);
    refused(pir_solid_read_bytes(&none, NULL, &report, &solid), &report);
    refused(pir_solid_read_bytes(&formless, NULL, &report, &solid), &report);
    refused(pir_solid_create(NULL, NULL, &report, &solid), &report);
    refused(pir_sum_read(NULL, NULL, &report, &sum), &report);
    refused(pir_sum_read(stdin, NULL, &report, NULL), &report);
    refused(pir_history_replay(NULL, NULL, &report), &report);
    assert_true(!solid && !sum);
}

/* A model in memory is what it is in a file. */
static void a_solid_of_bytes_is_one(void **state) {
    (void)state;
    static const char text[] = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1/2\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    const pir_file_bytes bytes = {text, sizeof text - 1, "bytes", "off"}, cut = {text, 40, "bytes", "off"};
    pir_report report = {0};
    pir_solid *solid = NULL;
    pir_solid_info info;
    assert_int_equal(pir_solid_read_bytes(&bytes, NULL, &report, &solid), PIR_OK);
    pir_solid_describe(solid, &info);
    assert_true(info.vertices == 4 && info.facets == 4 && info.high.z == 0.5);
    pir_solid_release(solid);
    assert_int_equal(pir_solid_read_bytes(&cut, NULL, &report, &solid), PIR_ERR_FORMAT);
    expect(strncmp(report.text, "bytes:", 6) == 0, "'%s'", report.text);
}

static void a_point_of_facets_that_is_not_finite_is_named(void **state) {
    (void)state;
    const pir_vec3 points[4] = {{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}, {0, 0, 1}};
    const uint32_t starts[5] = {0, 3, 6, 9, 12}, corners[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const pir_solid_facets facets = {
        .points = points, .point_count = 4, .starts = starts, .corners = corners, .facet_count = 4};
    pir_report report = {0};
    pir_solid *solid = NULL;
    assert_int_equal(pir_solid_create(&facets, NULL, &report, &solid), PIR_ERR_NOT_FINITE);
    expect(strstr(report.text, "point 2 is not finite") != NULL, "'%s'", report.text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_need_a_file_and_a_place), cmocka_unit_test(slices_need_a_file_and_a_place),
        cmocka_unit_test(solids_sums_and_histories_need_a_file_and_a_place), cmocka_unit_test(a_solid_of_bytes_is_one),
        cmocka_unit_test(a_point_of_facets_that_is_not_finite_is_named)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

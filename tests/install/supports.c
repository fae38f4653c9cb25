/* SPDX-License-Identifier: MIT */
/* A program of libpirouette-ccd outside the build: a cube's support, and, with libccd in the build, two cubes apart. */
#include <stdio.h>

#include <pirouette/ccd.h>
#include <pirouette/pirouette.h>

static int fail(const char *what) {
    fprintf(stderr, "supports: %s\n", what);
    return 1;
}

static int ask(pir_polytope *cube) {
    pir_support_body body = {cube, {0, 0, 0, 1}, {10, 0, 0}, 0};
    double direction[3] = {1, 2, 3}, point[3];
    pir_support_body_ccd(&body, direction, point);
    if (point[0] != 10.5 || point[1] != 0.5 || point[2] != 0.5)
        return fail("not the support");
    const pir_ccd_pair pair = {cube, cube, {0, 0, 0, 1}, {3, 0, 0}};
    pir_ccd_outcome outcome = PIR_CCD_FAILED;
    double distance = 0;
    pir_status status = pir_ccd_distance(&pair, &outcome, &distance);
    if (status == PIR_ERR_NOT_BUILT)
        return 0;
    return status == PIR_OK && outcome == PIR_CCD_SEPARATED && distance > 1.999 && distance < 2.001
               ? 0
               : fail("not the distance");
}

int main(void) {
    pir_polytope *cube = NULL;
    if (pir_shape_create("cube", NULL, NULL, &cube) != PIR_OK)
        return fail("no cube");
    int result = ask(cube);
    pir_polytope_release(cube);
    return result;
}

/* SPDX-License-Identifier: MIT */
/*
 * Writes serialised sums of the tests' own small poses, to start fuzzing pir_sum_restore from: turned, scaled, behind
 * within a tolerance, of a region, differences. Usage: write_sums FOLDER
 */
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/pirouette.h>

#include "fuzz/input.h"
#include "support/bodies.h"

#define SUMS 48

static pir_sum *make_sum(test_random *random, uint32_t number) {
    test_pose pose;
    test_random_pose(random, 6, &pose);
    pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
    pir_sum_options options = pir_sum_options_default();
    options.difference = number % 2;
    pir_sum *sum = NULL;
    fuzz_require(pir_sum_create(p, q, pose.rotation, &options, &sum) == PIR_OK, "a sum is made");
    pir_polytope_release(q);
    pir_polytope_release(p);
    if (number % 3 == 1)
        fuzz_require(pir_sum_set_scale(sum, PIR_OPERAND_P, 0.7) == PIR_OK, "P is scaled");
    if (number % 3 == 2)
        fuzz_require(pir_sum_set_scale(sum, PIR_OPERAND_Q, 3) == PIR_OK, "Q is scaled");
    if (number % 4 == 3) {
        // the next rotation is within it: the pairing stays behind
        fuzz_require(pir_sum_rotate(sum, (pir_quat){1, 2, 3, 4}, PIR_METHOD_UPDATE) == PIR_OK, "it turns");
        fuzz_require(pir_sum_set_tolerance(sum, 1e3) == PIR_OK, "a tolerance is set");
        fuzz_require(pir_sum_rotate(sum, (pir_quat){1, 2, 3, 4.001}, PIR_METHOD_UPDATE) == PIR_OK, "it turns");
    }
    if (number % 5 == 4)
        fuzz_require(pir_sum_set_region(sum, (pir_vec3){1, 2, 2}, 0.4) == PIR_OK, "a region is set");
    return sum;
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: write_sums FOLDER\n");
        return 2;
    }
    for (uint32_t i = 0; i < SUMS; i++) {
        char path[4096];
        test_random random = test_random_case("write sums", i);
        pir_sum *sum = make_sum(&random, i);
        snprintf(path, sizeof path, "%s/sum_%02u", argv[1], (unsigned)i);
        FILE *file = fopen(path, "wb");
        fuzz_require(file != NULL, path);
        fuzz_require(pir_sum_write(sum, file, NULL) == PIR_OK, "it is written");
        fuzz_require(fclose(file) == 0, path);
        pir_sum_destroy(sum);
    }
    return 0;
}

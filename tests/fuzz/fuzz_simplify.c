/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a body to simplify: by exact distances in rationals (oracle/distance.h) the inner polytope is inside,
 * the outer one around, and no vertex is beyond the bounds.
 *
 * The bytes: what to stop at, then a body. See fuzz_sum.c for how to run an engine.
 */
#include <math.h>
#include <stdint.h>

#include <pirouette/simplify.h>

#include "fuzz/input.h"
#include "oracle/distance.h"

#define POINTS FUZZ_POINTS_MAX

static void check_between(const pir_polytope *inside, const pir_polytope *around, double bound) {
    oracle_body small, large;
    oracle_body_init(&small, inside);
    oracle_body_init(&large, around);
    fuzz_require(oracle_is_within(&small, &large, 0), "one holds the other");
    fuzz_require(oracle_is_within(&large, &small, bound), "it is within the bound");
    oracle_body_clear(&large);
    oracle_body_clear(&small);
}

static void check_simplified(const pir_simplified *s, pir_polytope *body, const pir_simplify_options *options) {
    const pir_polytope *inner = s->inner, *outer = s->outer;
    fuzz_require(pir_polytope_is_valid(inner) && pir_polytope_is_valid(outer), "both are polytopes");
    if (options->vertices > 0)
        fuzz_require(pir_polytope_vertex_count(inner) <= options->vertices, "the inner one is simple");
    if (options->error > 0)
        fuzz_require(s->inner_error <= options->error && s->outer_error <= options->error, "both are near enough");
    fuzz_require(s->inner_error >= 0 && s->outer_error >= 0, "bounds are lengths");
    if (pir_polytope_dimension(body) < 3 || pir_polytope_dimension(inner) < 3)
        return;
    check_between(inner, body, s->inner_error);
    check_between(body, outer, s->outer_error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct fuzz_input input = {data, size, 0};
    pir_simplify_options options = pir_simplify_options_default();
    uint8_t choice = fuzz_byte(&input);
    if (choice % 2 == 0)
        options.vertices = 4 + choice / 2 % 8;
    else
        options.error = fabs(fuzz_double(&input));
    if (options.vertices == 0 && options.error == 0)
        options.error = 1;
    pir_polytope *body = fuzz_body(&input, POINTS);
    pir_simplified simplified;
    pir_status status = pir_polytope_simplify(body, &options, &simplified);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "a body is simplified, or is too far away");
    if (status == PIR_OK) {
        check_simplified(&simplified, body, &options);
        pir_simplified_release(&simplified);
    }
    pir_polytope_release(body);
    return 0;
}

/* SPDX-License-Identifier: MIT */
/* The call: options, the inner polytope, the outer one. */
#include <pirouette/simplify.h>

#include <math.h>

#include "base/options.h"
#include "simplify/inner.h"
#include "simplify/outer.h"

static pir_status check(const pir_simplify_options *options) {
    if (!isfinite(options->error))
        return PIR_ERR_NOT_FINITE;
    bool is_bounded = options->vertices > 0 || options->error > 0;
    return is_bounded && options->error >= 0 && (options->vertices == 0 || options->vertices >= 4) ? PIR_OK
                                                                                                   : PIR_ERR_ARGUMENT;
}

static pir_status make(pir_measure *measure, pir_polytope *polytope, const pir_simplify_options *options,
                       pir_simplified *result) {
    uint32_t most = options->vertices > 0 ? options->vertices : UINT32_MAX;
    pir_status status =
        pir_simplify_inner(measure, polytope, most, options->error, &result->inner, &result->inner_error);
    if (status != PIR_OK)
        return status;
    if (polytope->dimension == 3)
        return pir_simplify_outer(measure, polytope, most, options->error, &result->outer, &result->outer_error);
    result->outer = pir_polytope_retain(polytope);
    return PIR_OK;
}

pir_status pir_polytope_simplify(pir_polytope *polytope, const pir_simplify_options *options,
                                 pir_simplified *ret_simplified) {
    if (!polytope || !options || !ret_simplified)
        return PIR_ERR_ARGUMENT;
    pir_simplify_options used = pir_simplify_options_default();
    pir_status status = pir_options_take("pir_simplify_options", options, &used, NULL);
    if (status == PIR_OK)
        status = check(&used);
    if (status != PIR_OK)
        return status;
    pir_simplified result = {0};
    if (used.vertices >= polytope->vertex_count) {
        result.inner = pir_polytope_retain(polytope);
        result.outer = pir_polytope_retain(polytope);
        *ret_simplified = result;
        return PIR_OK;
    }
    pir_measure measure;
    status = pir_measure_init(&measure, &polytope->allocator);
    if (status != PIR_OK)
        return status;
    status = make(&measure, polytope, &used, &result);
    pir_measure_finish(&measure);
    if (status == PIR_OK)
        *ret_simplified = result;
    else
        pir_simplified_release(&result);
    return status;
}

void pir_simplified_release(pir_simplified *simplified) {
    if (!simplified)
        return;
    pir_polytope_release(simplified->inner);
    pir_polytope_release(simplified->outer);
    simplified->inner = simplified->outer = NULL;
}

/* SPDX-License-Identifier: MIT */
/* Polytopes of points given as doubles or as rationals: the exact hull, its facets merged within the tolerance. */
#include "polytope/create/create.h"

#include <math.h>

#include <pirouette/exact.h>

#include "base/vec.h"
#include "polytope/create/merge.h"
#include "polytope/exact_points.h"
#include "polytope/polytope.h"

pir_polytope_options pir_polytope_options_default(void) {
    return (pir_polytope_options){NULL, 0};
}

pir_status pir_polytope_check_options(const pir_polytope_options *options) {
    if (options && !isfinite(options->merge_tolerance))
        return PIR_ERR_NOT_FINITE;
    return options && options->merge_tolerance < 0 ? PIR_ERR_ARGUMENT : PIR_OK;
}

/* Checks the arguments of both ways to make a polytope. */
static pir_status check_arguments(const void *points, size_t count, const pir_polytope_options *options,
                                  pir_polytope **ret_polytope) {
    if (!ret_polytope || (!points && count > 0))
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_polytope_check_options(options);
    if (status != PIR_OK)
        return status;
    if (count == 0)
        return PIR_ERR_EMPTY;
    return count >= (size_t)1 << 30 ? PIR_ERR_LIMIT : PIR_OK;
}

/* The hull of exact points, its facets merged where `tolerance` is not 0. */
static pir_status build(const struct pir_exact_points *exact, const pir_vec3 *doubles, const pir_allocator *allocator,
                        double tolerance, pir_polytope **ret_polytope) {
    pir_polytope_parts parts = {.points = &exact->vectors, .scale = &exact->scale, .doubles = doubles};
    pir_polytope *hull = NULL;
    pir_status status = pir_polytope_build_hull(&parts, allocator, &hull);
    return status == PIR_OK ? pir_polytope_merge_within(hull, tolerance, ret_polytope) : status;
}

pir_status pir_polytope_create(const pir_vec3 *points, size_t count, const pir_polytope_options *options,
                               pir_polytope **ret_polytope) {
    pir_status status = check_arguments(points, count, options, ret_polytope);
    if (status != PIR_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        if (!pir_vec_is_finite(points[i]))
            return PIR_ERR_NOT_FINITE;
    const pir_allocator used = pir_allocator_or_default(options ? options->allocator : NULL);
    struct pir_exact_points exact;
    status = pir_exact_points_of_doubles(&exact, points, count, &used);
    if (status != PIR_OK)
        return status;
    status = build(&exact, points, &used, options ? options->merge_tolerance : 0, ret_polytope);
    pir_exact_points_finish(&exact, &used);
    return status;
}

pir_status pir_polytope_create_exact(const mpq_t *coordinates, size_t count, const pir_polytope_options *options,
                                     pir_polytope **ret_polytope) {
    pir_status status = check_arguments(coordinates, count, options, ret_polytope);
    if (status != PIR_OK)
        return status;
    const pir_allocator used = pir_allocator_or_default(options ? options->allocator : NULL);
    struct pir_exact_points exact;
    status = pir_exact_points_of_rationals(&exact, coordinates, count, &used);
    if (status != PIR_OK)
        return status;
    status = build(&exact, NULL, &used, options ? options->merge_tolerance : 0, ret_polytope);
    pir_exact_points_finish(&exact, &used);
    return status;
}

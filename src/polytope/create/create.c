/* SPDX-License-Identifier: MIT */
/* Polytopes of points given as doubles or as rationals: the exact hull, its facets merged within the tolerance. */
#include "polytope/create/create.h"

#include <math.h>

#include <pirouette/exact.h>

#include "base/options.h"
#include "base/vec.h"
#include "polytope/create/merge.h"
#include "polytope/exact_points.h"
#include "polytope/polytope.h"

pir_status pir_polytope_check_tolerance(double merge_tolerance) {
    if (!isfinite(merge_tolerance))
        return PIR_ERR_NOT_FINITE;
    return merge_tolerance < 0 ? PIR_ERR_ARGUMENT : PIR_OK;
}

/* Checks the arguments of both ways to make a polytope, and takes the options. */
static pir_status check_arguments(const void *points, size_t count, const pir_polytope_options *options,
                                  pir_polytope **ret_polytope, pir_polytope_options *ret_used) {
    if (!ret_polytope || (!points && count > 0))
        return PIR_ERR_ARGUMENT;
    pir_polytope_options used = pir_polytope_options_default();
    pir_status status = pir_options_take("pir_polytope_options", options, &used, NULL);
    if (status == PIR_OK)
        status = pir_polytope_check_tolerance(used.merge_tolerance);
    if (status != PIR_OK)
        return status;
    if (count == 0)
        return PIR_ERR_EMPTY;
    *ret_used = used;
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
    pir_polytope_options used;
    pir_status status = check_arguments(points, count, options, ret_polytope, &used);
    if (status != PIR_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        if (!pir_vec_is_finite(points[i]))
            return PIR_ERR_NOT_FINITE;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    struct pir_exact_points exact;
    status = pir_exact_points_of_doubles(&exact, points, count, &allocator);
    if (status != PIR_OK)
        return status;
    status = build(&exact, points, &allocator, used.merge_tolerance, ret_polytope);
    pir_exact_points_finish(&exact, &allocator);
    return status;
}

pir_status pir_polytope_create_exact(const mpq_t *coordinates, size_t count, const pir_polytope_options *options,
                                     pir_polytope **ret_polytope) {
    pir_polytope_options used;
    pir_status status = check_arguments(coordinates, count, options, ret_polytope, &used);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    struct pir_exact_points exact;
    status = pir_exact_points_of_rationals(&exact, coordinates, count, &allocator);
    if (status != PIR_OK)
        return status;
    status = build(&exact, NULL, &allocator, used.merge_tolerance, ret_polytope);
    pir_exact_points_finish(&exact, &allocator);
    return status;
}

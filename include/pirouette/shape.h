/* SPDX-License-Identifier: MIT */
/**
 * The model maker: polytopes by name. The thirteen models of Behar and Lien's paper, the platonic and the archimedean
 * solids, and families of any level: geodesic spheres, ellipsoids, boxes, cones, cylinders.
 */
#ifndef PIROUETTE_SHAPE_H
#define PIROUETTE_SHAPE_H

#include <pirouette/base.h>
#include <pirouette/polytope.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Makes the polytope that `name` describes: a name, then optional parameters, as in "cube", "geodesic?level=20" or
 * "box?x=1&y=2&z=0.5". pir_shape_name and pir_shape_help list the names and their parameters.
 *
 * allocator  NULL for malloc.
 * report     NULL, or filled with what, where and why when the name or a parameter is wrong.
 *
 * Errors: PIR_ERR_ARGUMENT (unknown name or parameter, value out of range), PIR_ERR_MEMORY.
 *
 * Cost: the hull of the shape's points.
 */
PIR_API pir_status pir_shape_create(const char *name, const pir_allocator *allocator, pir_report *report,
                                    pir_polytope **ret_polytope);

/** The number of shape names. O(1). */
PIR_API size_t pir_shape_count(void);

/** Name `index`, or NULL past the end; static memory. O(1). */
PIR_API const char *pir_shape_name(size_t index);

/**
 * One line on shape `index`: what it is and its parameters with their defaults; NULL past the end; static memory. O(1).
 */
PIR_API const char *pir_shape_help(size_t index);

#ifdef __cplusplus
}
#endif

#endif

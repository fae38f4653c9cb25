/* SPDX-License-Identifier: MIT */
/* See measure.h. */
#include "simplify/measure.h"

#include <math.h>

#include "polytope/some_vertices.h"

/* The bound that query.h promises of a distance, with a part in a thousand for the roundings here. */
#define PROMISE 1.001e-12

pir_status pir_measure_init(pir_measure *measure, const pir_allocator *allocator) {
    const pir_polytope_options options = {.allocator = allocator};
    *measure = (pir_measure){0};
    pir_status status = pir_polytope_create(&(pir_vec3){0, 0, 0}, 1, &options, &measure->origin);
    if (status == PIR_OK)
        status = pir_workspace_create(allocator, &measure->workspace);
    if (status != PIR_OK)
        pir_measure_finish(measure);
    return status;
}

void pir_measure_finish(pir_measure *measure) {
    pir_pair_destroy(measure->pair);
    pir_workspace_destroy(measure->workspace);
    pir_polytope_release(measure->origin);
}

/* The sum of the sides of a box, and the greatest coordinate. */
static double extent(const pir_polytope *polytope, double *ret_reach) {
    pir_vec3 low, high;
    pir_polytope_bounds(polytope, &low, &high);
    *ret_reach = fmax(fmax(fmax(-low.x, high.x), fmax(-low.y, high.y)), fmax(-low.z, high.z));
    return (high.x - low.x) + (high.y - low.y) + (high.z - low.z);
}

pir_status pir_measure_aim(pir_measure *measure, pir_polytope *polytope) {
    double reach, size = extent(polytope, &reach);
    pir_pair_options options = pir_pair_options_default();
    options.allocator = &polytope->allocator;
    pir_status status = measure->pair ? pir_pair_reset(measure->pair, measure->origin, polytope)
                                      : pir_pair_create(measure->origin, polytope, &options, &measure->pair);
    if (status != PIR_OK)
        return status;
    // vertices are known as doubles, off by half an ulp in each coordinate
    measure->slack = PROMISE * size + 0x1p-51 * reach;
    return PIR_OK;
}

pir_status pir_measure_point(pir_measure *measure, pir_vec3 point, pir_measured *ret_measured) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    input.pose_p.translation = point;
    pir_status status = pir_pair_distance(measure->pair, measure->workspace, &input, &result);
    if (status != PIR_OK)
        return status;
    bool apart = result.state == PIR_OUTSIDE;
    ret_measured->distance = apart ? result.distance * (1 + PROMISE) + measure->slack : 0;
    ret_measured->nearest = apart ? result.witness.q : (pir_feature){PIR_FEATURE_NONE, 0};
    return PIR_OK;
}

pir_status pir_measure_holds(pir_measure *measure, pir_polytope *around, const pir_polytope *polytope, uint32_t vertex,
                             bool *ret_holds) {
    const pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    pir_polytope *point = NULL;
    pir_status status = pir_polytope_of_some(polytope, &vertex, 1, &point);
    if (status == PIR_OK)
        status = pir_pair_reset(measure->pair, point, around);
    if (status == PIR_OK)
        status = pir_pair_overlap(measure->pair, measure->workspace, &input, &result);
    if (status == PIR_OK)
        *ret_holds = result.state != PIR_OUTSIDE;
    pir_polytope_release(point);
    return status;
}

/* SPDX-License-Identifier: MIT */
/* See measure.h. */
#include "simplify/measure.h"

#include <math.h>

#include "polytope/some_vertices.h"

/* The bound that query.h promises of a distance, with a part in a thousand for the roundings here. */
#define PROMISE 1.001e-12

pir_status pir_measure_init(pir_measure *measure, const pir_allocator *allocator) {
    const pir_polytope_options options = {.size = sizeof options, .allocator = allocator};
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

/* The most that rounding a vertex may add to a distance, as a part of the size. */
#define ROUGH 1e-12

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
    // vertices as doubles are off by half an ulp in each coordinate
    double off = 0x1p-51 * reach;
    measure->polytope = polytope;
    measure->slack = PROMISE * size;
    measure->rough = off <= ROUGH * size ? PROMISE * size + off : 0;
    return PIR_OK;
}

/* Asks the pair, whose P is moved by `by`. */
static pir_status ask(pir_measure *measure, pir_vec3 by, double slack, pir_measured *ret_measured) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    input.pose_p.translation = by;
    pir_status status = pir_pair_distance(measure->pair, measure->workspace, &input, &result);
    if (status != PIR_OK)
        return status;
    bool apart = result.state == PIR_OUTSIDE;
    ret_measured->distance = apart ? result.distance * (1 + PROMISE) + slack : 0;
    ret_measured->nearest = apart ? result.witness.q : (pir_feature){PIR_FEATURE_NONE, 0};
    return PIR_OK;
}

pir_status pir_measure_point(pir_measure *measure, pir_vec3 point, pir_measured *ret_measured) {
    return ask(measure, point, measure->slack, ret_measured);
}

/* A pair of two points has the unit 1 unless its bodies are far or near: a translation of P then may not be. */
static bool is_moderate(pir_vec3 v) {
    double most = fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z));
    return most == 0 || (most > 0x1p-300 && most < 0x1p300);
}

pir_status pir_measure_vertex(pir_measure *measure, const pir_polytope *of, uint32_t vertex,
                              pir_measured *ret_measured) {
    bool moves = measure->polytope->dimension > 0 || is_moderate(of->vertex[vertex]), exact = true;
    for (int k = 0; k < 3; k++)
        exact &= pir_vertex_is_double(of, vertex, k);
    if (moves && (exact || measure->rough > 0))
        return ask(measure, of->vertex[vertex], exact ? measure->slack : measure->rough, ret_measured);
    pir_polytope *point = NULL;
    pir_status status = pir_polytope_of_some(of, &vertex, 1, &point);
    if (status == PIR_OK)
        status = pir_pair_reset(measure->pair, point, measure->polytope);
    if (status == PIR_OK)
        status = ask(measure, (pir_vec3){0, 0, 0}, measure->slack, ret_measured);
    if (status == PIR_OK)
        status = pir_pair_reset(measure->pair, measure->origin, measure->polytope);
    pir_polytope_release(point);
    return status;
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

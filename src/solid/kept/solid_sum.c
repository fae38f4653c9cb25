/* SPDX-License-Identifier: MIT */
/*
 * The exact sum of two solids, at one rotation after another. Both are divided into convex pieces at rest, once; for
 * each rotation they are turned (space/rest.h) and the boundary is made of them (boundary.h).
 *
 * Invariant: `rotation` and `scale` are those of the last call that succeeded. `made` says whether the boundary is
 * there for them; after an update it is not, and after a call that failed neither is what was kept: whoever needs the
 * boundary next glues it of what is kept, or makes it.
 */
#include "solid/kept/solid_sum.h"

#include <math.h>

#include "base/options.h"
#include "polytope/mesh.h"
#include "solid/pieces/join_pieces.h"
#include "solid/sum/solid_mesh.h"

/* --- at rest --- */

/* The pieces of an operand, in its space. */
static pir_status divide(pir_solid_sum *sum, int k) {
    pir_space *space = &sum->operands.space;
    pir_cells cells;
    pir_piece_list pieces = {0};
    pir_space_begin_stage(space, k == 0 ? "dividing P" : "dividing Q", 0);
    pir_cells_init(&cells, space);
    pir_status status = pir_decompose(&sum->operands.body[k], PIR_DECOMPOSE_FACETS, &cells, &pieces);
    if (status == PIR_OK) {
        pir_merge_pieces(&cells, &pieces);
        pir_convexes_make(&sum->convexes[k], &cells, &pieces);
        status = space->status;
    }
    pir_piece_list_finish(&pieces, space);
    pir_cells_finish(&cells);
    return status;
}

static void keep_body(pir_space_rest *rest, const pir_shell_body *body, int k) {
    for (uint32_t i = 0; i < body->source.point_count; i++)
        pir_rest_keep_point(rest, body->first_point + i, k);
    for (uint32_t f = 0; f < body->source.facet_count; f++)
        pir_rest_keep_direction(rest, rest->space->plane[body->plane[f]].direction[0], k);
    for (uint32_t e = 0; e < body->edge_count; e++)
        pir_rest_keep_edge(rest, body->edge[e].direction, body->edge[e].a, body->edge[e].b, k);
    for (uint32_t p = 0; p < body->part_count; p++)
        for (uint32_t i = body->part_start[p], end = body->part_start[p + 1]; i < end; i++)
            pir_rest_keep_edge(rest, body->part_direction[i], body->part_corner[i],
                               body->part_corner[i + 1 < end ? i + 1 : body->part_start[p]], k);
}

static void keep_convexes(pir_space_rest *rest, const pir_convexes *convexes, int k) {
    for (uint32_t i = 0; i < convexes->vertex_count; i++)
        pir_rest_keep_point(rest, convexes->vertex[i], k);
    for (uint32_t i = 0; i < convexes->face_count; i++) {
        pir_rest_keep_point(rest, convexes->face[i].point, k);
        pir_rest_keep_direction(rest, convexes->face[i].normal, k);
    }
    for (uint32_t i = 0; i < convexes->edge_count; i++) {
        const pir_convex_edge *edge = &convexes->edge[i];
        pir_rest_keep_edge(rest, edge->direction, edge->point, edge->end, k);
        for (int side = 0; side < 2; side++)
            pir_rest_keep_direction(rest, edge->normal[side], k);
    }
}

static pir_status prepare(pir_solid_sum *sum) {
    const pir_solid *const solids[2] = {sum->solid[0], sum->solid[1]};
    const pir_solid_options options = {sizeof options, &sum->allocator, sum->options.memory, sum->options.report};
    pir_rotation rest = {.integers = &sum->integers};
    pir_status status = pir_rotation_set(&rest, (pir_quat){0, 0, 0, 1});
    if (status == PIR_OK)
        status = pir_operands_init(&sum->operands, solids, &rest, sum->options.difference != 0, &options);
    for (int k = 0; k < 2 && status == PIR_OK; k++)
        status = divide(sum, k);
    if (status != PIR_OK)
        return status;
    pir_rest_init(&sum->rest, &sum->operands.space);
    for (int k = 0; k < 2; k++) {
        keep_body(&sum->rest, &sum->operands.body[k], k);
        keep_convexes(&sum->rest, &sum->convexes[k], k);
    }
    pir_rest_settle(&sum->rest);
    return sum->operands.space.status;
}

/* --- at a rotation --- */

/* Turns that are larger than this are rebuilt, unless the caller wants an update. */
#define TURN_MOST .015

/* An update that has clipped more than this part of all did not pay. */
#define CLIPPED_MOST .25

/* How many rotations are rebuilt after one at the least and at the most. */
#define REST_LEAST 8
#define REST_MOST  256

static void turn(pir_solid_sum *sum, const double scale[2], bool keep) {
    pir_rest_turn(&sum->rest, &sum->turned, scale, keep);
    for (int k = 0; k < 2; k++)
        pir_convexes_set_boxes(&sum->convexes[k]);
}

/* Makes the boundary from the pieces, at the rotation that the space has been given. */
static void rebuild(pir_solid_sum *sum, const double scale[2]) {
    pir_kept_sum_finish(&sum->kept);
    pir_sum_boundary_finish(&sum->boundary);
    turn(sum, scale, false);
    pir_sum_boundary_make(&sum->boundary, sum->operands.body, sum->convexes, sum->options.open != 0);
    sum->clipped = sum->boundary.candidates;
    sum->made = sum->operands.space.status == PIR_OK;
}

/* Keeps a sum from now on; false where there is nothing to keep. */
static bool begin_to_keep(pir_solid_sum *sum, pir_quat rotation, const double scale[2]) {
    pir_kept_sum_finish(&sum->kept);
    turn(sum, scale, false);
    if (pir_kept_sum_make(&sum->kept, sum->operands.body, sum->convexes, rotation))
        return true;
    pir_kept_sum_finish(&sum->kept);
    return false;
}

/* Brings what is kept to a rotation; likewise. */
static bool update(pir_solid_sum *sum, pir_quat rotation, const double scale[2]) {
    pir_kept_sum *kept = &sum->kept;
    if (!kept->valid || kept->maker.turn > PIR_TURN_MOST / 2)
        return begin_to_keep(sum, rotation, scale);
    pir_kept_sum_begin(kept);
    turn(sum, scale, true);
    return pir_kept_sum_update(kept, rotation);
}

/* Whether an update is to be tried. */
static bool may_update(pir_solid_sum *sum, pir_quat rotation, const double scale[2], pir_solid_method method) {
    if (method == PIR_SOLID_REBUILD || sum->options.open || scale[0] != sum->scale[0] || scale[1] != sum->scale[1])
        return false;
    if (method == PIR_SOLID_UPDATE)
        return true;
    if (sum->rests > 0) {
        sum->rests--;
        return false;
    }
    return pir_angle_between(pir_quat_of_length_1(sum->rotation), pir_quat_of_length_1(rotation)) <= TURN_MOST;
}

/* Learns whether an update has paid: where much was clipped, or nothing could be kept, the next are rebuilds. */
static void learn(pir_solid_sum *sum, bool was_kept, bool done) {
    if (done && (!was_kept || (double)sum->clipped <= CLIPPED_MOST * sum->kept.count)) {
        sum->pause = was_kept ? REST_LEAST : sum->pause;
        return;
    }
    sum->rests = sum->pause < REST_LEAST ? REST_LEAST : sum->pause;
    sum->pause = 2 * sum->rests < REST_MOST ? 2 * sum->rests : REST_MOST;
}

static pir_status make(pir_solid_sum *sum, pir_quat rotation, const double scale[2], pir_solid_method method) {
    pir_space *space = &sum->operands.space;
    pir_rotation turned = {.integers = &sum->integers};
    pir_status status = pir_rotation_set(&turned, rotation);
    if (status != PIR_OK)
        return status;
    const bool updates = may_update(sum, rotation, scale, method), was_kept = sum->kept.valid;
    bool done = false;
    sum->made = false;
    sum->turned = turned;
    space->status = PIR_OK;
    space->refused = false;
    if (updates) {
        done = update(sum, rotation, scale);
        sum->clipped = done ? sum->kept.maker.made : 0;
        learn(sum, was_kept, done);
    }
    if (!done && space->status == PIR_OK)
        rebuild(sum, scale);
    if (space->status != PIR_OK)
        pir_kept_sum_finish(&sum->kept);
    return pir_space_outcome(space, space->status, "sum", sum->options.report);
}

/* Sees to it that the boundary is there. */
static pir_status ensure(pir_solid_sum *sum) {
    pir_space *space = &sum->operands.space;
    if (sum->made)
        return PIR_OK;
    if (!sum->kept.valid)
        return make(sum, sum->rotation, sum->scale, PIR_SOLID_REBUILD);
    pir_kept_sum_begin(&sum->kept);
    if (pir_kept_sum_glue(&sum->kept, &sum->boundary))
        sum->made = space->status == PIR_OK;
    else if (space->status == PIR_OK)
        rebuild(sum, sum->scale);
    if (space->status != PIR_OK)
        pir_kept_sum_finish(&sum->kept);
    return pir_space_outcome(space, space->status, "sum", sum->options.report);
}

static pir_solid_sum_info describe(const pir_solid_sum *sum) {
    const pir_sum_boundary *b = &sum->boundary;
    return (pir_solid_sum_info){.vertices = b->vertex_count,
                                .edges = b->edges,
                                .facets = b->loops.facet_count,
                                .holes = b->loops.hole_count,
                                .two_sided = b->loops.facet_count - b->loops.boundary_count,
                                .segments = b->segments,
                                .points = b->points.point_count,
                                .pieces_p = sum->convexes[0].count,
                                .pieces_q = sum->convexes[1].count,
                                .candidates = b->candidates,
                                .survivors = b->survivors,
                                .clipped = sum->clipped};
}

static pir_status change(pir_solid_sum *sum, pir_quat rotation, const double scale[2], pir_solid_method method) {
    const pir_status status = make(sum, rotation, scale, method);
    if (status != PIR_OK)
        return status;
    sum->rotation = rotation;
    sum->scale[0] = scale[0];
    sum->scale[1] = scale[1];
    sum->generation++;
    return PIR_OK;
}

pir_status pir_solid_sum_rotate(pir_solid_sum *sum, pir_quat rotation, pir_solid_method method) {
    if (!sum || (method != PIR_SOLID_AUTO && method != PIR_SOLID_UPDATE && method != PIR_SOLID_REBUILD))
        return PIR_ERR_ARGUMENT;
    return change(sum, rotation, sum->scale, method);
}

pir_status pir_solid_sum_set_scale(pir_solid_sum *sum, pir_operand operand, double scale) {
    if (!sum || (operand != PIR_OPERAND_P && operand != PIR_OPERAND_Q))
        return PIR_ERR_ARGUMENT;
    if (!isfinite(scale))
        return PIR_ERR_NOT_FINITE;
    if (!(scale > 0))
        return PIR_ERR_ARGUMENT;
    const double scales[2] = {operand == PIR_OPERAND_P ? scale : sum->scale[0],
                              operand == PIR_OPERAND_Q ? scale : sum->scale[1]};
    return change(sum, sum->rotation, scales, PIR_SOLID_REBUILD);
}

/* --- the object --- */

static pir_status create(const pir_solid *const solid[2], const pir_solid_sum_options *options, pir_quat rotation,
                         const double scale[2], pir_solid_sum **ret_sum) {
    const pir_allocator allocator = pir_allocator_or_default(options->allocator);
    pir_solid_sum *sum = PIR_ZEROED(&allocator, pir_solid_sum, 1);
    if (!sum)
        return PIR_ERR_MEMORY;
    sum->allocator = allocator;
    sum->options = *options;
    sum->options.allocator = &sum->allocator;
    for (int k = 0; k < 2; k++)
        sum->solid[k] = pir_solid_retain((pir_solid *)solid[k]);
    pir_status status = pir_rotation_set(&sum->turned, rotation);
    if (status == PIR_OK) {
        status = prepare(sum);
        status = pir_space_outcome(&sum->operands.space, status, "sum", options->report);
    }
    if (status == PIR_OK)
        status = change(sum, rotation, scale, PIR_SOLID_REBUILD);
    sum->generation = 0;
    if (status == PIR_OK)
        *ret_sum = sum;
    else
        pir_solid_sum_destroy(sum);
    return status;
}

pir_status pir_solid_sum_create(const pir_solid *p, const pir_solid *q, pir_quat rotation,
                                const pir_solid_sum_options *options, pir_solid_sum **ret_sum) {
    if (!p || !q || !ret_sum)
        return PIR_ERR_ARGUMENT;
    pir_solid_sum_options used = pir_solid_sum_options_default();
    const pir_status status = pir_options_take("pir_solid_sum_options", options, &used, &used.report);
    if (status != PIR_OK)
        return status;
    return create((const pir_solid *const[2]){p, q}, &used, rotation, (const double[2]){1, 1}, ret_sum);
}

pir_status pir_solid_sum_clone(const pir_solid_sum *sum, pir_solid_sum **ret_sum) {
    if (!sum || !ret_sum)
        return PIR_ERR_ARGUMENT;
    return create((const pir_solid *const *)sum->solid, &sum->options, sum->rotation, sum->scale, ret_sum);
}

void pir_solid_sum_destroy(pir_solid_sum *sum) {
    if (!sum)
        return;
    const pir_allocator allocator = sum->allocator;
    pir_sum_boundary_finish(&sum->boundary);
    pir_kept_sum_finish(&sum->kept);
    pir_rest_finish(&sum->rest);
    for (int k = 0; k < 2; k++) {
        pir_convexes_finish(&sum->convexes[k]);
        pir_solid_release(sum->solid[k]);
    }
    pir_operands_finish(&sum->operands);
    PIR_FREE(&allocator, sum, 1);
}

pir_quat pir_solid_sum_rotation(const pir_solid_sum *sum) {
    return sum->rotation;
}

uint64_t pir_solid_sum_generation(const pir_solid_sum *sum) {
    return sum->generation;
}

pir_status pir_solid_sum_describe(pir_solid_sum *sum, pir_solid_sum_info *ret_info) {
    if (!sum || !ret_info)
        return PIR_ERR_ARGUMENT;
    const pir_status status = ensure(sum);
    if (status == PIR_OK)
        *ret_info = describe(sum);
    return status;
}

pir_status pir_solid_sum_mesh(pir_solid_sum *sum, pir_precision precision, pir_mesh **ret_mesh) {
    if (!sum || !ret_mesh || (precision != PIR_DOUBLE && precision != PIR_EXACT))
        return PIR_ERR_ARGUMENT;
    const pir_status status = ensure(sum);
    return status == PIR_OK ? pir_solid_mesh_make(&sum->operands, &sum->boundary, precision == PIR_EXACT, ret_mesh)
                            : status;
}

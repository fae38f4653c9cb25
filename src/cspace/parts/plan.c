/* SPDX-License-Identifier: MIT */
/* Plans: see plan.h. */
#include "cspace/parts/plan.h"

#include <string.h>

#include "base/report.h"
#include "polytope/write/off_text.h"

/* Where the caller leaves it open: units are shorter where all slices together are few, so that threads share them. */
#define LONG_UNIT   256
#define SHORT_UNIT  64
#define MANY_SLICES (64 * LONG_UNIT)
#define USUAL_KEYS  64
#define PIECES_MOST (1u << 24)

/* --- pieces --- */

static pir_status add_pieces(pir_plan *plan, uint32_t first, pir_polytope *const *piece, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        if (!piece[i])
            return PIR_ERR_ARGUMENT;
        pir_plan_piece *added = &plan->piece[first + i];
        added->polytope = pir_polytope_retain(piece[i]);
        pir_status status = pir_off_text(piece[i], &plan->allocator, &added->off);
        if (status != PIR_OK)
            return status;
        added->hash = pir_hash_bytes(PIR_HASH_START, added->off.data, added->off.used);
    }
    return PIR_OK;
}

/* --- the plan --- */

static uint64_t hash_u64(uint64_t hash, uint64_t number) {
    uint8_t bytes[8];
    for (int i = 0; i < 8; i++)
        bytes[i] = (uint8_t)(number >> 8 * i);
    return pir_hash_bytes(hash, bytes, sizeof bytes);
}

static uint64_t hash_double(uint64_t hash, double number) {
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    return hash_u64(hash, bits);
}

/* Everything that decides the content. */
static uint64_t hash_of(const pir_plan *plan) {
    uint64_t hash = hash_u64(PIR_HASH_START, PIR_SLICES_VERSION);
    hash = hash_u64(hash, plan->robot_count);
    hash = hash_u64(hash, plan->obstacle_count);
    for (uint32_t i = 0; i < plan->robot_count + plan->obstacle_count; i++)
        hash = hash_u64(hash, plan->piece[i].hash);
    hash = hash_u64(hash, plan->slices_per_unit);
    hash = hash_u64(hash, plan->slices_per_key);
    hash = hash_u64(hash, (uint64_t)plan->planes | (uint64_t)plan->vertices << 1);
    hash = hash_u64(hash, plan->slices);
    for (uint64_t i = 0; i < plan->slices; i++) {
        pir_quat q = pir_grid_rotation(plan->grid, i);
        hash = hash_double(hash_double(hash_double(hash_double(hash, q.x), q.y), q.z), q.w);
    }
    return hash;
}

static pir_status count_units(pir_plan *plan, const pir_cspace_options *options, pir_report *report) {
    plan->slices = pir_grid_get_info(plan->grid).count;
    plan->pairs = (uint64_t)plan->robot_count * plan->obstacle_count;
    if (plan->pairs > UINT64_MAX / 16 / plan->slices)
        return pir_fail(report, PIR_ERR_LIMIT, "slices: too many pieces for so many rotations");
    plan->slices_per_unit = options->slices_per_unit;
    if (plan->slices_per_unit == 0)
        plan->slices_per_unit = plan->pairs * plan->slices >= MANY_SLICES ? LONG_UNIT : SHORT_UNIT;
    plan->slices_per_key = options->slices_per_key ? options->slices_per_key : USUAL_KEYS;
    if (plan->slices_per_unit > PIR_CSPACE_UNIT_MAX)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: more than %u slices a unit", PIR_CSPACE_UNIT_MAX);
    plan->units_per_pair = (plan->slices + plan->slices_per_unit - 1) / plan->slices_per_unit;
    plan->units = plan->pairs * plan->units_per_pair;
    return PIR_OK;
}

pir_status pir_plan_init(pir_plan *plan, const pir_cspace_bodies *bodies, const pir_grid *grid,
                         const pir_cspace_options *options, pir_report *report) {
    *plan = (pir_plan){.allocator = pir_allocator_or_default(options->allocator), .grid = grid};
    if (!bodies || !grid || !bodies->robot || !bodies->obstacle)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no bodies or no grid");
    if (bodies->robot_count == 0 || bodies->obstacle_count == 0)
        return pir_fail(report, PIR_ERR_EMPTY, "slices: no pieces");
    if (bodies->robot_count > PIECES_MOST || bodies->obstacle_count > PIECES_MOST)
        return pir_fail(report, PIR_ERR_LIMIT, "slices: more than %u pieces", PIECES_MOST);
    plan->planes = options->planes != 0;
    plan->vertices = options->vertices != 0;
    plan->piece = PIR_ZEROED(&plan->allocator, pir_plan_piece, (size_t)bodies->robot_count + bodies->obstacle_count);
    if (!plan->piece)
        return pir_fail(report, PIR_ERR_MEMORY, "slices: out of memory");
    plan->robot_count = bodies->robot_count;
    plan->obstacle_count = bodies->obstacle_count;
    pir_status status = add_pieces(plan, 0, bodies->robot, bodies->robot_count);
    if (status == PIR_OK)
        status = add_pieces(plan, bodies->robot_count, bodies->obstacle, bodies->obstacle_count);
    if (status != PIR_OK)
        return pir_fail(report, status, "slices: pieces: %s", pir_status_text(status));
    status = count_units(plan, options, report);
    if (status == PIR_OK)
        plan->hash = hash_of(plan);
    return status;
}

void pir_plan_finish(pir_plan *plan) {
    size_t pieces = (size_t)plan->robot_count + plan->obstacle_count;
    for (size_t i = 0; plan->piece && i < pieces; i++) {
        pir_polytope_release(plan->piece[i].polytope);
        pir_bytes_finish(&plan->piece[i].off, &plan->allocator);
    }
    if (plan->piece)
        PIR_FREE(&plan->allocator, plan->piece, pieces);
    *plan = (pir_plan){0};
}

/* SPDX-License-Identifier: MIT */
/*
 * Time and bytes of a job, from samples: the first slices of units that are spread evenly over all of them. First
 * slices and later ones are counted apart, for a first slice takes more of both.
 */
#include <math.h>
#include <time.h>

#include <pirouette/cspace.h>

#include "base/options.h"
#include "base/report.h"
#include "cspace/parts/maker.h"

#define SAMPLES       24
#define SLICES_SAMPLE 17u

/* Bytes of a slice in the tables, and of a rotation with its number in the grid, compressed as they mostly are. */
#define TABLE_BYTES    1.5
#define ROTATION_BYTES 33

/* Bytes of a unit in the tables, and what a chunk takes beside the records in it. */
#define UNIT_BYTES  16
#define CHUNK_BYTES 100

/* Bytes that an HDF5 file takes before there is anything in it, and a piece, beside its model. */
#define FILE_BYTES  16384
#define PIECE_BYTES 8192

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec / 1e9;
}

/* Of whole slices and of changes: how many, their seconds, their bytes. */
struct sample {
    double count, seconds, bytes;
};

/* Bytes of the slices of the unit that was made, as the file holds them. */
static pir_status add_bytes(pir_maker *maker, double *bytes) {
    pir_unit *unit = &maker->unit;
    if (!pir_unit_pack(unit, maker->packer, &maker->plan->allocator))
        return PIR_ERR_MEMORY;
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        *bytes += fmax(0, (double)unit->packed[s].used - CHUNK_BYTES);
    return PIR_OK;
}

static pir_status take_sample(pir_maker *maker, uint64_t number, struct sample *whole, struct sample *changes) {
    uint32_t slices = pir_plan_count(maker->plan, number), most = slices < SLICES_SAMPLE ? slices : SLICES_SAMPLE;
    // once unmeasured, so that memory has been made
    pir_status status = pir_maker_make(maker, number, most);
    double start = seconds_now();
    if (status == PIR_OK)
        status = pir_maker_make(maker, number, 1);
    double first = seconds_now() - start, first_bytes = 0, all_bytes = 0;
    if (status == PIR_OK)
        status = add_bytes(maker, &first_bytes);
    start = seconds_now();
    if (status == PIR_OK)
        status = pir_maker_make(maker, number, most);
    double all = seconds_now() - start;
    if (status == PIR_OK)
        status = add_bytes(maker, &all_bytes);
    if (status != PIR_OK)
        return status;
    whole->count += 1;
    whole->seconds += first;
    whole->bytes += first_bytes;
    changes->count += most - 1;
    changes->seconds += all > first ? all - first : 0;
    changes->bytes += fmax(0, all_bytes - first_bytes);
    return PIR_OK;
}

static pir_status sample(const pir_plan *plan, struct sample *whole, struct sample *changes) {
    pir_maker maker;
    pir_status status = pir_maker_init(&maker, plan) ? PIR_OK : PIR_ERR_MEMORY;
    uint64_t samples = plan->units < SAMPLES ? plan->units : SAMPLES;
    for (uint64_t i = 0; status == PIR_OK && i < samples; i++)
        status =
            take_sample(&maker, i * (plan->units / samples) + i * (plan->units % samples) / samples, whole, changes);
    pir_maker_finish(&maker);
    return status;
}

static pir_cspace_estimate work_out(const pir_plan *plan, const struct sample *whole, const struct sample *changes) {
    double slices = (double)plan->pairs * (double)plan->slices, units = (double)plan->units;
    double keys = fmax(units, fmin(slices, slices / plan->slices_per_key)), rest = slices - keys;
    double bytes = FILE_BYTES + keys * whole->bytes / whole->count + slices * TABLE_BYTES +
                   units * (UNIT_BYTES + CHUNK_BYTES) + (double)plan->slices * ROTATION_BYTES;
    double seconds = units * whole->seconds / whole->count;
    if (changes->count > 0) {
        bytes += rest * changes->bytes / changes->count;
        seconds += (slices - units) * changes->seconds / changes->count;
    }
    for (uint32_t i = 0; i < plan->robot_count + plan->obstacle_count; i++)
        bytes += PIECE_BYTES + 4 * (double)plan->piece[i].off.used;
    pir_grid_turns turns = pir_grid_get_turns(plan->grid);
    return (pir_cspace_estimate){.slices = plan->pairs * plan->slices,
                                 .units = plan->units,
                                 .seconds = seconds,
                                 .bytes = bytes,
                                 .mean_turn = turns.mean,
                                 .most_turn = turns.most};
}

pir_status pir_cspace_get_estimate(const pir_cspace_bodies *bodies, const pir_grid *grid,
                                   const pir_cspace_options *options, pir_report *report,
                                   pir_cspace_estimate *ret_estimate) {
    if (!ret_estimate)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: nowhere to put the estimate");
    pir_cspace_options used = pir_cspace_options_default();
    pir_status status = pir_options_take("pir_cspace_options", options, &used, &report);
    if (status != PIR_OK)
        return status;
    pir_plan plan;
    struct sample whole = {0}, changes = {0};
    status = pir_plan_init(&plan, bodies, grid, &used, report);
    if (status == PIR_OK) {
        status = sample(&plan, &whole, &changes);
        if (status != PIR_OK)
            pir_fail(report, status, "slices: %s", pir_status_text(status));
        else
            *ret_estimate = work_out(&plan, &whole, &changes);
    }
    pir_plan_finish(&plan);
    return status;
}

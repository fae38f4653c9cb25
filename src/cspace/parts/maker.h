/* SPDX-License-Identifier: MIT */
/*
 * Makes units: follows the difference of a pair through the rotations of a unit. One maker a thread. What it makes is a
 * function of the unit alone: the first slice is whole and made by a walk, and the pairing at every rotation is unique.
 */
#ifndef PIR_CSPACE_PARTS_MAKER_H
#define PIR_CSPACE_PARTS_MAKER_H

#include "cspace/parts/pack.h"
#include "cspace/parts/plan.h"
#include "cspace/record/recorder.h"

typedef struct pir_maker {
    const pir_plan *plan; /* borrowed */
    pir_sum *sum;         /* of `pair`, or NULL */
    uint64_t pair;
    pir_recorder recorder;
    pir_unit unit;
    pir_packer *packer; /* for whoever packs the unit */
} pir_maker;

/* False when out of memory. pir_maker_finish releases whatever is there. */
bool pir_maker_init(pir_maker *maker, const pir_plan *plan);
void pir_maker_finish(pir_maker *maker);

/*
 * Makes the first slices of a unit, `most` of them or all where it has fewer. They stand in maker->unit until the next
 * call. Errors: PIR_ERR_MEMORY, PIR_ERR_LIMIT.
 */
pir_status pir_maker_make(pir_maker *maker, uint64_t number, uint32_t most);

#endif

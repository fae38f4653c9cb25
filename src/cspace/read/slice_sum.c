/* SPDX-License-Identifier: MIT */
/*
 * Slices as sums and as meshes. What the file says of the pairing is not trusted: it is proven in exact arithmetic, so
 * a sum that is returned is right.
 */
#include <string.h>

#include "base/report.h"
#include "cspace/read/cspace.h"
#include "dymsum/fill.h"

/* Puts the pairing that the cursor is at into a sum that has been begun. False when out of memory. */
static bool fill(pir_sum *sum, const pir_replay *replay, const pir_replay_crossing *crossing, uint32_t count) {
    memcpy(pir_fill_cells(sum, PIR_OPERAND_P), replay->fv, replay->p->facet_count * sizeof *replay->fv);
    memcpy(pir_fill_cells(sum, PIR_OPERAND_Q), replay->vf, replay->q->facet_count * sizeof *replay->vf);
    if (!pir_fill_crossings(sum, count))
        return false;
    uint32_t last = PIR_NO_CROSSING;
    for (uint32_t i = 0; i < count; i++) {
        if (i > 0 && crossing[i].edge != crossing[i - 1].edge)
            last = PIR_NO_CROSSING;
        if (!pir_fill_crossing(sum, crossing[i].edge, crossing[i].half, &last))
            return false;
    }
    pir_fill_end(sum);
    return true;
}

pir_status pir_cspace_sum(pir_cspace *cspace, pir_cspace_place place, pir_report *report, pir_sum **ret_sum) {
    if (!cspace || !ret_sum)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file, or nowhere to put the sum");
    const pir_replay_crossing *crossing;
    uint32_t count;
    pir_status status = pir_cspace_go_to(cspace, place, report, &crossing, &count);
    if (status != PIR_OK)
        return status;
    // a sum takes a reference, which is no change of what the piece says
    pir_polytope *obstacle = (pir_polytope *)pir_cspace_obstacle(cspace, place.obstacle);
    pir_polytope *minus_p = cspace->cursor.minus_p;
    const pir_fill_operands operands = {{minus_p, obstacle}, {minus_p, obstacle}, true};
    pir_sum *sum = NULL;
    status = pir_fill_begin(&operands, pir_cspace_cursor_rotation(cspace), &cspace->allocator, &sum);
    if (status == PIR_OK && !fill(sum, &cspace->cursor.replay, crossing, count))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK && !pir_sum_is_valid(sum))
        status = PIR_ERR_FORMAT;
    if (status != PIR_OK) {
        pir_sum_destroy(sum);
        return pir_fail(report, status, "slices: %s",
                        status == PIR_ERR_FORMAT ? "it is not the pairing at its rotation" : pir_status_text(status));
    }
    *ret_sum = sum;
    return PIR_OK;
}

pir_status pir_cspace_mesh(pir_cspace *cspace, pir_cspace_place place, pir_precision precision, pir_report *report,
                           pir_mesh **ret_mesh) {
    pir_sum *sum = NULL;
    if (!ret_mesh)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: nowhere to put the mesh");
    pir_status status = pir_cspace_sum(cspace, place, report, &sum);
    if (status != PIR_OK)
        return status;
    status = pir_sum_mesh(sum, precision, ret_mesh);
    pir_sum_destroy(sum);
    return status == PIR_OK ? PIR_OK : pir_fail(report, status, "slices: mesh: %s", pir_status_text(status));
}

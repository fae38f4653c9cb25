/* SPDX-License-Identifier: MIT */
/*
 * Slices as sums and as meshes. What the file says of the pairing is not trusted. There is one pairing at a rotation,
 * so the sum is made anew and its pairing held against the file's.
 */
#include <string.h>

#include "base/report.h"
#include "cspace/read/cspace.h"
#include "dymsum/view.h"

/* Whether the crossings of edge e of −P are those that stand from *at on; moves *at past them. */
static bool same_crossings(const pir_pairing *pairing, uint32_t e, const pir_record_replay_crossing **at,
                           const pir_record_replay_crossing *end) {
    for (uint32_t slot = pir_crossing_first(pairing, e); slot != PIR_NO_CROSSING;
         slot = pir_crossing_next(pairing, slot), ++*at)
        if (*at == end || (*at)->edge != e || (*at)->half != pir_crossing_half(pairing, slot))
            return false;
    return true;
}

/* Whether the pairing of the sum is that which the cursor is at. */
static bool same_pairing(const pir_sum *sum, const pir_record_replay *replay,
                         const pir_record_replay_crossing *crossing, uint32_t count) {
    const pir_pairing *pairing = pir_sum_pairing(sum);
    const pir_record_replay_crossing *at = crossing, *end = crossing + count;
    if (memcmp(pairing->fv, replay->fv, replay->p->facet_count * sizeof *replay->fv) != 0 ||
        memcmp(pairing->vf, replay->vf, replay->q->facet_count * sizeof *replay->vf) != 0)
        return false;
    for (uint32_t e = 0; e < replay->p->edge_count; e++)
        if (!same_crossings(pairing, e, &at, end))
            return false;
    return at == end;
}

pir_status pir_cspace_sum(pir_cspace *cspace, pir_cspace_place place, pir_report *report, pir_sum **ret_sum) {
    if (!cspace || !ret_sum)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file, or nowhere to put the sum");
    const pir_record_replay_crossing *crossing;
    uint32_t count;
    pir_status status = pir_cspace_go_to(cspace, place, report, &crossing, &count);
    if (status != PIR_OK)
        return status;
    // a sum takes a reference, which is no change of what the pieces say
    pir_polytope *robot = (pir_polytope *)pir_cspace_robot(cspace, place.robot);
    pir_polytope *obstacle = (pir_polytope *)pir_cspace_obstacle(cspace, place.obstacle);
    const pir_sum_options options = {.size = sizeof options, .allocator = &cspace->allocator, .difference = true};
    pir_sum *sum = NULL;
    status = pir_sum_create(robot, obstacle, pir_cspace_cursor_rotation(cspace), &options, &sum);
    if (status == PIR_OK && !same_pairing(sum, &cspace->cursor.replay, crossing, count))
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

/* SPDX-License-Identifier: MIT */
/* The half-spaces of a slice, in the order of its pairs: fv, vf, ee. */
#include "base/report.h"
#include "cspace/read/cspace.h"
#include "cspace/record/halfspaces.h"

static bool reserve(pir_cspace *cspace, uint32_t count) {
    pir_cspace_cursor *cursor = &cspace->cursor;
    if (cursor->plane && count <= cursor->plane_room)
        return true;
    pir_halfspace *room = PIR_NEW(&cspace->allocator, pir_halfspace, count);
    if (!room)
        return false;
    PIR_FREE(&cspace->allocator, cursor->plane, cursor->plane_room);
    cursor->plane = room;
    cursor->plane_room = count;
    return true;
}

static void make(pir_cspace *cspace, const pir_mat3 *r, const pir_record_replay_crossing *crossing, uint32_t count) {
    const pir_record_replay *replay = &cspace->cursor.replay;
    pir_halfspace *plane = cspace->cursor.plane;
    pir_halfspaces of = pir_halfspaces_of(replay->p, replay->q, r);
    for (uint32_t f = 0; f < replay->p->facet_count; f++)
        *plane++ = pir_halfspace_fv(&of, f, replay->fv[f]);
    for (uint32_t g = 0; g < replay->q->facet_count; g++)
        *plane++ = pir_halfspace_vf(&of, g, replay->vf[g]);
    for (uint32_t i = 0; i < count; i++)
        *plane++ = pir_halfspace_ee(&of, crossing[i].edge, crossing[i].half, replay->fv);
}

pir_status pir_cspace_planes(pir_cspace *cspace, pir_cspace_place place, pir_report *report,
                             const pir_halfspace **ret_planes, uint32_t *ret_count) {
    if (!cspace || !ret_planes || !ret_count)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file, or nowhere to put the planes");
    const pir_record_replay_crossing *crossing;
    uint32_t count;
    pir_status status = pir_cspace_go_to(cspace, place, report, &crossing, &count);
    if (status != PIR_OK)
        return status;
    const pir_record_replay *replay = &cspace->cursor.replay;
    uint32_t planes = replay->p->facet_count + replay->q->facet_count + count;
    pir_rotation rotation;
    status = pir_rotation_set(&rotation, pir_cspace_cursor_rotation(cspace));
    if (status == PIR_OK && !reserve(cspace, planes))
        status = PIR_ERR_MEMORY;
    if (status != PIR_OK)
        return pir_fail(report, status, "slices: %s", pir_status_text(status));
    make(cspace, &rotation.r, crossing, count);
    *ret_planes = cspace->cursor.plane;
    *ret_count = planes;
    return PIR_OK;
}

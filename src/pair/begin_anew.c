/* SPDX-License-Identifier: MIT */
/* Slow path of a call's beginning: its inputs changed since the call before. See begin.h. */
#include "pair/begin.h"

void pir_pair_set_bodies(const pir_pair *pair, pir_workspace *workspace) {
    pir_frame *frame = &workspace->frame;
    pir_frame_take_bodies(frame, pair->body_p, pair->body_q);
    frame->offset = frame->q.centre;
    pir_frame_set_exponent(frame, pair->exponent);
}

pir_status pir_pair_set_q(pir_workspace *workspace, const pir_pose *q) {
    workspace->has_q = false;
    pir_status status = pir_rotation_set(&workspace->rotation_q, q->rotation);
    if (status != PIR_OK)
        return status;
    workspace->world.translation_q = q->translation;
    workspace->posed = !pir_world_is_plain(&workspace->world);
    workspace->is_turned = !pir_quat_is_identity(q->rotation);
    workspace->exact.world = workspace->posed ? &workspace->world : NULL;
    workspace->pose[1] = *q;
    workspace->has_q = true;
    return PIR_OK;
}

pir_status pir_pair_set_any_rotation(pir_workspace *workspace, const pir_pair_input *input) {
    pir_status status = pir_rotation_set_relative(&workspace->rotation, input->pose_q.rotation, input->pose_p.rotation);
    workspace->frame.is_set = false;
    if (status == PIR_OK)
        pir_frame_turn(&workspace->frame, &workspace->rotation);
    return status;
}

/* SPDX-License-Identifier: MIT */
/* What a call on a pair begins and ends with: the relative pose, and the way back to the world. */
#include "pair/pair.h"

pir_pair_input pir_pair_input_default(void) {
    const pir_pose origin = {{0, 0, 0, 1}, {0, 0, 0}};
    return (pir_pair_input){.pose_p = origin, .pose_q = origin, .cutoff = HUGE_VAL};
}

/* Both rotations, and P's relative to Q. */
static pir_status set_rotations(pir_workspace *workspace, const pir_pair_input *input) {
    pir_quat q = input->pose_q.rotation, before = workspace->rotation_q.given;
    pir_status status = PIR_OK;
    if (!workspace->has_rotation_q || q.x != before.x || q.y != before.y || q.z != before.z || q.w != before.w)
        status = pir_rotation_set(&workspace->rotation_q, q);
    if (status != PIR_OK)
        return status;
    workspace->has_rotation_q = true;
    bool is_turned = q.x != 0 || q.y != 0 || q.z != 0 || q.w != 1;
    if (!is_turned && pir_rotation_set_near_one(&workspace->rotation, input->pose_p.rotation))
        return PIR_OK;
    return pir_rotation_set_relative(&workspace->rotation, input->pose_q.rotation, input->pose_p.rotation);
}

/* The frame and the placement, the rotations being set. The bodies may be there already. */
static pir_status set_frame(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, bool fits) {
    pir_frame *frame = &workspace->frame;
    if (!fits) {
        frame->p = pair->body_p->body;
        frame->q = pair->body_q->body;
        pir_frame_set_exponent(frame, pair->exponent);
    }
    frame->is_set = false;
    pir_frame_turn(frame, &workspace->rotation);
    workspace->world.translation_p = input->pose_p.translation;
    workspace->world.translation_q = input->pose_q.translation;
    workspace->posed = !pir_world_is_plain(&workspace->world);
    workspace->exact.world = workspace->posed ? &workspace->world : NULL;
    pir_exact_forget(&workspace->exact);
    if (!pir_exact_has_limbs(&workspace->exact, pair->limbs) &&
        !pir_exact_reserve_limbs(&workspace->exact, &workspace->allocator, pair->limbs))
        return PIR_ERR_MEMORY;
    if (workspace->posed)
        return pir_frame_place_relative(frame, &workspace->world, &workspace->placement);
    return pir_frame_place(frame, input->pose_p.translation, &workspace->placement);
}

pir_status pir_pair_begin(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input) {
    if (!pair || !workspace || !input)
        return PIR_ERR_ARGUMENT;
    bool fits = pir_pair_is_at(pair, workspace);
    workspace->pair = NULL;
    workspace->moved = (pir_leeway){HUGE_VAL, HUGE_VAL};
    pair->left = 0;
    pir_status status = pir_pair_check(input);
    if (status == PIR_OK)
        status = set_rotations(workspace, input);
    if (status == PIR_OK)
        status = set_frame(pair, workspace, input, fits);
    if (status != PIR_OK)
        return status;
    workspace->pair = pair;
    workspace->is_framed = true;
    workspace->pose[0] = input->pose_p;
    workspace->pose[1] = input->pose_q;
    pair->workspace = workspace;
    return PIR_OK;
}

pir_vec3 pir_pair_point_to_world(const pir_workspace *workspace, pir_vec3 y) {
    return pir_vec_add(pir_mat_apply(&workspace->rotation_q.r, y), workspace->world.translation_q);
}

void pir_pair_to_world(const pir_workspace *workspace, pir_query_result *result) {
    bool has_points = result->normal.x != 0 || result->normal.y != 0 || result->normal.z != 0;
    if (!has_points)
        return;
    result->normal = pir_mat_apply(&workspace->rotation_q.r, result->normal);
    result->point_q = pir_pair_point_to_world(workspace, result->point_q);
    result->point_p = pir_vec_add(result->point_q, pir_vec_scale(result->normal, result->distance));
}

/* SPDX-License-Identifier: MIT */
/* What a call on a pair begins and ends with: the relative pose, and the way back to the world. */
#include <string.h>

#include "pair/pair.h"

pir_pair_input pir_pair_input_default(void) {
    const pir_pose origin = {{0, 0, 0, 1}, {0, 0, 0}};
    return (pir_pair_input){.pose_p = origin, .pose_q = origin, .cutoff = HUGE_VAL};
}

/* Whether radii and cutoff are numbers that mean something. */
static pir_status check(const pir_pair_input *input) {
    if (isnan(input->radius_p) || isnan(input->radius_q) || isnan(input->cutoff) || isnan(input->margin))
        return PIR_ERR_NOT_FINITE;
    if (!(input->radius_p >= 0 && input->radius_p < HUGE_VAL && input->radius_q >= 0 && input->radius_q < HUGE_VAL))
        return PIR_ERR_ARGUMENT;
    return PIR_OK;
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
    return pir_rotation_set_relative(&workspace->rotation, input->pose_q.rotation, input->pose_p.rotation);
}

/* Whether the frame is at this pair. */
static bool is_at(const pir_pair *pair, const pir_workspace *workspace) {
    return workspace->pair == pair && pair->workspace == workspace;
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

pir_status pir_pair_begin(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                          pir_placement *ret_placement) {
    if (!pair || !workspace || !input)
        return PIR_ERR_ARGUMENT;
    bool fits = is_at(pair, workspace);
    workspace->pair = NULL;
    workspace->moved = (pir_leeway){HUGE_VAL, HUGE_VAL};
    pir_status status = check(input);
    if (status == PIR_OK)
        status = set_rotations(workspace, input);
    if (status == PIR_OK)
        status = set_frame(pair, workspace, input, fits);
    if (status != PIR_OK)
        return status;
    workspace->pair = pair;
    workspace->pose[0] = input->pose_p;
    workspace->pose[1] = input->pose_q;
    pair->workspace = workspace;
    *ret_placement = workspace->placement;
    return PIR_OK;
}

pir_status pir_pair_resume(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input) {
    if (!pair || !workspace || !input)
        return PIR_ERR_ARGUMENT;
    pir_placement placement;
    const pir_pose *pose = workspace->pose;
    // bits may differ where numbers do not: then it begins anew
    if (!is_at(pair, workspace) || memcmp(&input->pose_p, &pose[0], sizeof *pose) != 0 ||
        memcmp(&input->pose_q, &pose[1], sizeof *pose) != 0)
        return pir_pair_begin(pair, workspace, input, &placement);
    return check(input);
}

pir_vec3 pir_pair_point_to_world(const pir_workspace *workspace, pir_vec3 y) {
    return pir_vec_add(pir_mat_apply(&workspace->rotation_q.r, y), workspace->world.translation_q);
}

void pir_pair_to_world(const pir_workspace *workspace, pir_query_result *result) {
    if (!workspace->posed)
        return;
    bool has_points = result->normal.x != 0 || result->normal.y != 0 || result->normal.z != 0;
    if (!has_points)
        return;
    result->normal = pir_mat_apply(&workspace->rotation_q.r, result->normal);
    result->point_q = pir_pair_point_to_world(workspace, result->point_q);
    result->point_p = pir_vec_add(result->point_q, pir_vec_scale(result->normal, result->distance));
}

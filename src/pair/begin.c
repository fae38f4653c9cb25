/* SPDX-License-Identifier: MIT */
/* The beginning and the end of a call on a pair: the relative pose, and the way back to the world. */
#include "pair/begin.h"

pir_pair_input pir_pair_input_default(void) {
    const pir_pose origin = {{0, 0, 0, 1}, {0, 0, 0}};
    return (pir_pair_input){.pose_p = origin, .pose_q = origin, .cutoff = HUGE_VAL};
}

/* P's rotation as Q sees it. */
static inline pir_status set_rotation(pir_workspace *workspace, const pir_pair_input *input) {
    const pir_quat given = pir_quat_signed(input->pose_p.rotation);
    if (workspace->is_turned || !pir_quat_is_near_one(given))
        return pir_pair_set_any_rotation(workspace, input);
    const pir_rotation_doubles doubles = pir_doubles_as_given(given);
    pir_rotation_set_given(&workspace->rotation, given);
    pir_frame_set_doubles(&workspace->frame, given, &doubles);
    return PIR_OK;
}

/* x, and what exact signs need, the rotations being set. */
static pir_status set_place(const pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input) {
    pir_exact_forget(&workspace->exact);
    if (!pir_exact_has_limbs(&workspace->exact, pair->limbs) &&
        !pir_exact_reserve_limbs(&workspace->exact, &workspace->allocator, pair->limbs))
        return PIR_ERR_MEMORY;
    if (!workspace->posed)
        return pir_frame_place(&workspace->frame, input->pose_p.translation, &workspace->placement);
    workspace->world.translation_p = input->pose_p.translation;
    return pir_frame_place_relative(&workspace->frame, &workspace->world, &workspace->placement);
}

pir_status pir_pair_begin(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input) {
    if (!pir_pair_is_at(pair, workspace))
        pir_pair_set_bodies(pair, workspace);
    workspace->pair = NULL;
    pir_status status = pir_pair_check(input);
    if (status != PIR_OK)
        return status;
    // mostly it is where it was in the call before
    if (!(workspace->has_q && pir_pose_is_same(&input->pose_q, &workspace->pose[1]))) {
        status = pir_pair_set_q(workspace, &input->pose_q);
        if (status != PIR_OK)
            return status;
    }
    status = set_rotation(workspace, input);
    if (status != PIR_OK)
        return status;
    status = set_place(pair, workspace, input);
    if (status != PIR_OK)
        return status;
    workspace->pair = pair;
    workspace->pose[0] = input->pose_p;
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

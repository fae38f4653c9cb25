/* SPDX-License-Identifier: MIT */
/* The beginning and the end of a call on a pair: the relative pose, and the way back to the world. */
#include "pair/pair.h"

pir_pair_input pir_pair_input_default(void) {
    const pir_pose origin = {{0, 0, 0, 1}, {0, 0, 0}};
    return (pir_pair_input){.pose_p = origin, .pose_q = origin, .cutoff = HUGE_VAL};
}

/* --- where inputs have changed since the call before: out of line --- */

/* Makes the frame one of the bodies of this pair. */
__attribute__((noinline)) static void set_bodies(const pir_pair *pair, pir_workspace *workspace) {
    pir_frame *frame = &workspace->frame;
    pir_frame_take_bodies(frame, pair->body_p, pair->body_q);
    frame->offset = frame->q.centre;
    pir_frame_set_exponent(frame, pair->exponent);
}

/* Sets Q's place. */
__attribute__((noinline)) static pir_status set_q(pir_workspace *workspace, const pir_pose *q) {
    workspace->has_q = false;
    pir_rotation *rotation = &workspace->rotation_q;
    pir_status status = PIR_OK;
    if (workspace->relative->turn(&q->rotation, &rotation->unit, &rotation->r))
        pir_rotation_set_given(rotation, q->rotation);
    else
        status = pir_rotation_set(rotation, q->rotation);
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

/* A quaternion with a component of 1 or more is halved, as that of ground that stands as it was made. */
static inline pir_quat halved(const pir_quat *q) {
    const double by = fabs(q->x) < 1 && fabs(q->y) < 1 && fabs(q->z) < 1 && fabs(q->w) < 1 ? 1 : 0.5;
    return (pir_quat){by * q->x, by * q->y, by * q->z, by * q->w};
}

/*
 * Sets P's rotation as Q, which is turned, sees it. False where a quaternion has to be scaled by more than a half.
 */
static inline bool set_relative_rotation(pir_workspace *workspace, const pir_quat *q, const pir_quat *p) {
    pir_frame *frame = &workspace->frame;
    pir_quat_product product;
    const pir_quat near_q = halved(q), near_p = halved(p);
    if (!workspace->relative->find(&near_q, &near_p, &product, &frame->unit, &frame->r))
        return false;
    pir_rotation_set_factors(&workspace->rotation, &product, *q, *p);
    pir_frame_set_given(frame, product.whole, product.rest);
    return true;
}

/* Sets P's rotation as Q sees it, where Q is turned or P's quaternion has to be scaled. */
__attribute__((noinline)) static pir_status set_any_rotation(pir_workspace *workspace, const pir_pair_input *input) {
    if (workspace->is_turned && set_relative_rotation(workspace, &input->pose_q.rotation, &input->pose_p.rotation))
        return PIR_OK;
    pir_rotation *rotation = &workspace->rotation;
    pir_status status = pir_rotation_set_relative(rotation, input->pose_q.rotation, input->pose_p.rotation);
    if (status != PIR_OK)
        return status;
    workspace->frame.unit = rotation->unit;
    workspace->frame.r = rotation->r;
    pir_frame_set_given(&workspace->frame, rotation->given, rotation->rest);
    return PIR_OK;
}

/* --- every call --- */

/* P's rotation as Q sees it. */
static inline pir_status set_rotation(pir_workspace *workspace, const pir_pair_input *input) {
    if (workspace->is_turned)
        return set_any_rotation(workspace, input);
    const pir_quat given = pir_quat_signed(input->pose_p.rotation);
    if (!pir_quat_is_near_one(given))
        return set_any_rotation(workspace, input);
    const pir_rotation_doubles doubles = pir_doubles_as_given(given);
    workspace->frame.unit = doubles.unit;
    workspace->frame.r = doubles.r;
    pir_rotation_set_given(&workspace->rotation, given);
    pir_frame_set_given(&workspace->frame, given, (pir_quat){0, 0, 0, 0});
    return PIR_OK;
}

/* x, and what exact signs need, the rotations being set. */
static pir_status set_place(const pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input) {
    pir_exact_forget(&workspace->exact);
    if (!pir_exact_has_limbs(&workspace->exact, pair->limbs) &&
        !pir_exact_reserve_limbs(&workspace->exact, &workspace->allocator, pair->limbs))
        return PIR_ERR_MEMORY;
    workspace->world.translation_p = input->pose_p.translation;
    if (workspace->posed && pir_frame_is_far(&workspace->frame) && pir_quat_is_identity(input->pose_p.rotation) &&
        pir_frame_place_middles(&workspace->frame, &workspace->world, &workspace->placement))
        return PIR_OK;
    if (workspace->frame.p.far > 0)
        pir_frame_set_offset(&workspace->frame);
    if (!workspace->posed)
        return pir_frame_place(&workspace->frame, input->pose_p.translation, &workspace->placement);
    if (pir_frame_place_near(&workspace->frame, &workspace->world, &workspace->placement))
        return PIR_OK;
    return pir_frame_place_relative(&workspace->frame, &workspace->world, &workspace->placement);
}

pir_status pir_pair_begin(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input) {
    if (!pir_pair_is_at(pair, workspace))
        set_bodies(pair, workspace);
    workspace->pair = NULL;
    pir_status status = pir_pair_check(input);
    if (status != PIR_OK)
        return status;
    // mostly it is where it was in the call before
    if (!(workspace->has_q && pir_pose_is_same(&input->pose_q, &workspace->pose[1]))) {
        status = set_q(workspace, &input->pose_q);
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
    const pir_vec3 normal = pir_vec_just_stored(&result->normal), point = pir_vec_just_stored(&result->point_q);
    bool has_points = normal.x != 0 || normal.y != 0 || normal.z != 0;
    if (!has_points)
        return;
    result->normal = pir_mat_apply(&workspace->rotation_q.r, normal);
    result->point_q = pir_pair_point_to_world(workspace, point);
    result->point_p = pir_vec_add(result->point_q, pir_vec_scale(result->normal, result->distance));
}

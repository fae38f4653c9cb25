/* SPDX-License-Identifier: MIT */
/* Contact manifolds of pairs: those of query/contact/manifold.h, brought to Q's frame and back. */
#include "query/contact/manifold.h"

#include "pair/pair.h"

static inline pir_vec3 from_world(const pir_workspace *workspace, const pir_vec3 *point) {
    const pir_vec3 way = pir_vec_sub(pir_vec_just_stored(point), pir_vec_just_stored(&workspace->world.translation_q));
    return pir_mat_apply_transposed(&workspace->rotation_q.r, way);
}

/* An answer in the world, which has mostly just been made, as Q sees it. */
static inline pir_query_result seen_by_q(const pir_workspace *workspace, const pir_query_result *answer) {
    return (pir_query_result){
        .state = answer->state,
        .outcome = answer->outcome,
        .distance = answer->distance,
        .normal = pir_mat_apply_transposed(&workspace->rotation_q.r, pir_vec_just_stored(&answer->normal)),
        .point_p = from_world(workspace, &answer->point_p),
        .point_q = from_world(workspace, &answer->point_q),
        .witness = answer->witness,
        .steps = answer->steps,
    };
}

/* Brings contacts in Q's frame to the world, the first of them being the answer. */
static void to_world(const pir_workspace *workspace, const pir_query_result *answer, pir_contact *contacts,
                     size_t count) {
    const pir_vec3 normal = pir_vec_just_stored(&answer->normal);
    if (count > 0) {
        contacts[0].point_p = pir_vec_just_stored(&answer->point_p);
        contacts[0].point_q = pir_vec_just_stored(&answer->point_q);
    }
    for (size_t i = 1; i < count; i++) {
        const pir_vec3 q = pir_pair_point_to_world(workspace, pir_vec_just_stored(&contacts[i].point_q));
        contacts[i].point_p = pir_vec_add(q, pir_vec_scale(normal, contacts[i].distance));
        contacts[i].point_q = q;
    }
}

/*
 * Begins a call that may follow one on this pair in this workspace: at the same poses it uses what that one
 * made. Where no contact is asked for, poses that are valid need no frame.
 */
static pir_status resume(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, bool needs_frame) {
    if (!pair || !workspace || !input)
        return PIR_ERR_ARGUMENT;
    const pir_pose *at_p = &input->pose_p, *at_q = &input->pose_q;
    if (!needs_frame && pair->down > 0 &&
        pir_poses_are_plain(pir_pair_reach(&pair->body_p->body, &pair->body_q->body, at_p, at_q, pair->down), at_p,
                            at_q))
        return pir_pair_check(input);
    // bits may differ where numbers do not: then it begins anew
    if (!pir_pair_is_at(pair, workspace) || !pir_pose_is_same(at_p, &workspace->pose[0]) ||
        !pir_pose_is_same(at_q, &workspace->pose[1]))
        return pir_pair_begin(pair, workspace, input);
    return pir_pair_check(input);
}

pir_status pir_pair_manifold(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                             const pir_query_result *answer, size_t capacity, pir_contact *ret_contacts,
                             size_t *ret_count) {
    if (!answer || (!ret_contacts && capacity > 0) || !ret_count)
        return PIR_ERR_ARGUMENT;
    bool has_points = answer->outcome != PIR_BEYOND_CUTOFF && answer->outcome != PIR_NO_HIT;
    pir_status status = resume(pair, workspace, input, has_points);
    if (status != PIR_OK)
        return status;
    if (!has_points) {
        *ret_count = 0;
        return input->margin >= 0 ? PIR_OK : PIR_ERR_ARGUMENT;
    }
    if (!pir_patch_room_reserve(&workspace->patches, &workspace->allocator, pair->p->vertex_count,
                                pair->q->vertex_count))
        return PIR_ERR_MEMORY;
    pir_query_result seen;
    if (workspace->posed)
        seen = seen_by_q(workspace, answer);
    const pir_query_input asked = {.radius_p = input->radius_p, .radius_q = input->radius_q, .margin = input->margin};
    const pir_manifold_ask ask = {&asked, workspace->posed ? &seen : answer, capacity};
    status =
        pir_manifold_find(&workspace->frame, &workspace->placement, &workspace->patches, &ask, ret_contacts, ret_count);
    pair->statistics.manifolds += status == PIR_OK;
    if (workspace->posed && status == PIR_OK)
        to_world(workspace, answer, ret_contacts, *ret_count < capacity ? *ret_count : capacity);
    return status;
}

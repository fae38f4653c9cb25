/* SPDX-License-Identifier: MIT */
/* The object: its making, its poses, the nearest triangles with the state. */
#include "mesh/pair/trimesh_pair.h"

#include "base/options.h"
#include "mesh/pair/inside.h"
#include "mesh/pair/nearest_pair.h"
#include "mesh/pair/pair_descent.h"

/* How far a mesh's vertices are from its origin, rounded up. */
static double reach_of(const pir_trimesh *mesh) {
    double most = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        most = fmax(most, pir_vec_dot(mesh->vertex[v], mesh->vertex[v]));
    // squares of what is below 2^-500 are lost
    return sqrt(most) * (1 + 0x1p-50) + 0x1p-500;
}

pir_status pir_trimesh_pair_create(pir_trimesh *p, pir_trimesh *q, const pir_trimesh_pair_options *options,
                                   pir_trimesh_pair **ret_pair) {
    if (!p || !q || !ret_pair)
        return PIR_ERR_ARGUMENT;
    pir_trimesh_pair_options used = pir_trimesh_pair_options_default();
    const pir_status status = pir_options_take("pir_trimesh_pair_options", options, &used, NULL);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    pir_trimesh_pair *pair = PIR_ZEROED(&allocator, pir_trimesh_pair, 1);
    if (!pair)
        return PIR_ERR_MEMORY;
    pair->allocator = allocator;
    pair->mesh[0] = pir_trimesh_retain(p);
    pair->mesh[1] = pir_trimesh_retain(q);
    for (int i = 0; i < 2; i++) {
        pair->frame.mesh[i] = pair->mesh[i];
        pair->frame.reach[i] = reach_of(pair->mesh[i]);
    }
    const pir_mesh_tree *tree = &p->tree;
    pair->about = (pir_vec3){0.5 * ((double)tree->low[0] + (double)tree->high[0]),
                             0.5 * ((double)tree->low[1] + (double)tree->high[1]),
                             0.5 * ((double)tree->low[2] + (double)tree->high[2])};
    pir_best_pair_clear(&pair->best);
    pair->farthest_p = pair->farthest_q = PIR_TRIANGLE_NONE;
    *ret_pair = pair;
    return PIR_OK;
}

void pir_trimesh_pair_destroy(pir_trimesh_pair *pair) {
    if (!pair)
        return;
    const pir_allocator allocator = pair->allocator;
    pir_mesh_front_finish(&pair->front, &allocator);
    pir_tie_sides_finish(&pair->sides, &pair->frame, &allocator);
    pir_best_pair_finish(&pair->best, &allocator);
    pir_mesh_frame_finish(&pair->frame, &allocator);
    pir_trimesh_release(pair->mesh[0]);
    pir_trimesh_release(pair->mesh[1]);
    PIR_FREE(&allocator, pair, 1);
}

pir_status pir_trimesh_pair_place(pir_trimesh_pair *pair, pir_pose pose_p, pir_pose pose_q, double length) {
    pir_status status = pir_mesh_frame_set(&pair->frame, &pair->allocator, pose_p, pose_q, length);
    if (status == PIR_OK && !pir_best_pair_reserve(&pair->best, &pair->allocator, pair->frame.coordinate))
        status = PIR_ERR_MEMORY;
    if (status != PIR_OK)
        return status;
    pir_float_frame_set(&pair->floats, &pair->frame, pair->about);
    pair->counts.calls++;
    return PIR_OK;
}

/* The state of two meshes that share no point. */
static pir_trimesh_state apart_state(pir_trimesh_pair *pair) {
    if (pir_is_inside(&pair->frame, 0))
        return PIR_TRIMESH_P_INSIDE;
    return pir_is_inside(&pair->frame, 1) ? PIR_TRIMESH_Q_INSIDE : PIR_TRIMESH_APART;
}

pir_status pir_trimesh_pair_nearest(pir_trimesh_pair *pair, pir_pose pose_p, pir_pose pose_q,
                                    pir_trimesh_distance *ret_distance) {
    pir_status status = pair && ret_distance ? pir_trimesh_pair_place(pair, pose_p, pose_q, 0) : PIR_ERR_ARGUMENT;
    if (status == PIR_OK)
        status = pir_nearest_pair_update(pair);
    if (status != PIR_OK)
        return status;
    pir_best_pair *best = &pair->best;
    if (best->meets)
        pir_lowest_pair_find(pair, 0);
    pir_vec3 p = pir_mesh_frame_world(&pair->frame, best->span.point_a);
    pir_vec3 q = pir_mesh_frame_world(&pair->frame, best->span.point_b);
    pir_vec3 between = pir_vec_sub(best->span.point_a, best->span.point_b);
    *ret_distance = (pir_trimesh_distance){
        .state = best->meets ? PIR_TRIMESH_MEET : apart_state(pair),
        .distance = best->meets ? 0 : sqrt(pir_vec_dot(between, between)),
        .triangle_p = best->p,
        .triangle_q = best->q,
        .point_p = p,
        .point_q = q,
    };
    return PIR_OK;
}

pir_trimesh_pair_statistics pir_trimesh_pair_get_statistics(const pir_trimesh_pair *pair) {
    pir_trimesh_pair_statistics counts = pair->counts;
    counts.front = pair->front.count;
    counts.bytes = sizeof *pair + pir_tie_sides_bytes(&pair->sides, &pair->frame) +
                   pair->front.room * (sizeof *pair->front.entry + 3 * sizeof(float)) +
                   (pair->frame.limbs.capacity + 4 * (size_t)pair->best.room) * sizeof(mp_limb_t);
    return counts;
}

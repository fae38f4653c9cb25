/* SPDX-License-Identifier: MIT */
/**
 * Vectors, quaternions, poses and contacts to and from cglm (https://github.com/recp/cglm), whose numbers are floats.
 * Header only, and optional: include it where cglm is installed. pirouette.h does not include it.
 *
 *     mat4 model;
 *     pir_pose_to_mat4(pose, model);
 *
 * To floats each number is rounded to the nearest; from floats nothing is lost, but for matrices, whose rotation is
 * made a quaternion in floats.
 *
 * Threads: functions of their arguments alone; any thread.
 */
#ifndef PIROUETTE_CGLM_H
#define PIROUETTE_CGLM_H

#include <cglm/cglm.h>

#include <pirouette/pose.h>
#include <pirouette/query.h>
#include <pirouette/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A vector `v` of floats as one of doubles. O(1). */
static inline pir_vec3 pir_vec3_from_cglm(const float v[3]) {
    const pir_vec3 made = {v[0], v[1], v[2]};
    return made;
}

/** A vector `v` of doubles as one of floats. O(1). */
static inline void pir_vec3_to_cglm(pir_vec3 v, float ret_v[3]) {
    ret_v[0] = (float)v.x;
    ret_v[1] = (float)v.y;
    ret_v[2] = (float)v.z;
}

/** A versor `q`, whose numbers are x, y, z, w, as a quaternion. O(1). */
static inline pir_quat pir_quat_from_cglm(const float q[4]) {
    const pir_quat made = {q[0], q[1], q[2], q[3]};
    return made;
}

/** A quaternion `q`, of any length but 0, as a versor of length 1. O(1). */
static inline void pir_quat_to_cglm(pir_quat q, float ret_q[4]) {
    const double length = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    ret_q[0] = (float)(q.x / length);
    ret_q[1] = (float)(q.y / length);
    ret_q[2] = (float)(q.z / length);
    ret_q[3] = (float)(q.w / length);
}

/** The pose of a versor `rotation` and a `translation`. O(1). */
static inline pir_pose pir_pose_from_cglm(const float rotation[4], const float translation[3]) {
    const pir_pose made = {pir_quat_from_cglm(rotation), pir_vec3_from_cglm(translation)};
    return made;
}

/** A pose as a versor, `ret_rotation`, and a translation, `ret_translation`. O(1). */
static inline void pir_pose_to_cglm(pir_pose pose, float ret_rotation[4], float ret_translation[3]) {
    pir_quat_to_cglm(pose.rotation, ret_rotation);
    pir_vec3_to_cglm(pose.translation, ret_translation);
}

/** The matrix of a pose, by columns, as renderers take it: a point p of the body stands at matrix · (p, 1). O(1). */
static inline void pir_pose_to_mat4(pir_pose pose, mat4 ret_matrix) {
    const pir_vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (uint32_t k = 0; k < 3; k++) {
        pir_vec3_to_cglm(pir_pose_rotate(pose, axis[k]), ret_matrix[k]);
        ret_matrix[k][3] = 0;
    }
    pir_vec3_to_cglm(pose.translation, ret_matrix[3]);
    ret_matrix[3][3] = 1;
}

/** The pose of a matrix that turns and moves, without scale. O(1). */
static inline pir_pose pir_pose_from_mat4(mat4 matrix) {
    versor rotation;
    glm_mat4_quat(matrix, rotation);
    return pir_pose_from_cglm(rotation, matrix[3]);
}

/**
 * The contacts of an event as points half-way between the bodies, with what they are apart, below 0 where they overlap.
 *
 * capacity               room for how many points and distances.
 * ret_points             room for them, or NULL.
 * ret_distances          room for them, or NULL.
 *
 * Cost: O(contacts). The result is how many there are, also beyond the capacity.
 */
static inline uint32_t pir_event_to_cglm(const pir_scene_event *event, uint32_t capacity, vec3 *ret_points,
                                         float *ret_distances) {
    for (uint32_t i = 0; i < event->contact_count && i < capacity; i++) {
        const pir_contact *contact = &event->contacts[i];
        const pir_vec3 middle = {0.5 * (contact->point_p.x + contact->point_q.x),
                                 0.5 * (contact->point_p.y + contact->point_q.y),
                                 0.5 * (contact->point_p.z + contact->point_q.z)};
        if (ret_points)
            pir_vec3_to_cglm(middle, ret_points[i]);
        if (ret_distances)
            ret_distances[i] = (float)contact->distance;
    }
    return event->contact_count;
}

#ifdef __cplusplus
}
#endif

#endif

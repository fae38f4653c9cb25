/* SPDX-License-Identifier: MIT */
/**
 * Poses: where a body stands in the world, and what a program does with poses every frame.
 *
 * A pose takes a body's point v to R·v + translation, where R is the rotation that the quaternion stands for. The
 * quaternion has any length but 0; nothing here needs it to be 1, and only pir_pose_integrate makes it 1.
 *
 * Results are doubles: each component is within 32·2^-53 of the exact one, relative to the largest number that enters
 * it. They are made with +, −, ·, / and the square root alone, so their bits are the same on every machine. A
 * component that is not finite, or a quaternion of zeros, gives components that are not finite.
 *
 * Threads: plain values; any thread.
 */
#ifndef PIROUETTE_POSE_H
#define PIROUETTE_POSE_H

#include <pirouette/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A body's place in the world: a vertex v stands at R·v + translation. */
typedef struct pir_pose {
    pir_quat rotation; /**< of any length but 0 */
    pir_vec3 translation;
} pir_pose;

/** Not turned, at the origin. O(1). */
PIR_API pir_pose pir_pose_identity(void);

/** First `inner`, then `outer`: pir_pose_apply of the result is that of `outer` on that of `inner`. O(1). */
PIR_API pir_pose pir_pose_compose(pir_pose outer, pir_pose inner);

/** The pose that undoes `pose`. O(1). */
PIR_API pir_pose pir_pose_invert(pir_pose pose);

/** Where `point` of the body at `pose` stands in the world. O(1). */
PIR_API pir_vec3 pir_pose_apply(pir_pose pose, pir_vec3 point);

/** Which point of the body at `pose` stands at `point` of the world. O(1). */
PIR_API pir_vec3 pir_pose_apply_inverse(pir_pose pose, pir_vec3 point);

/** A direction of the body at `pose`, turned into the world: without the translation. O(1). */
PIR_API pir_vec3 pir_pose_rotate(pir_pose pose, pir_vec3 direction);

/** A direction of the world, as the body at `pose` sees it. O(1). */
PIR_API pir_vec3 pir_pose_rotate_inverse(pir_pose pose, pir_vec3 direction);

/**
 * The pose after `time` at constant velocity and constant angular velocity, about the body's origin. The turn is the
 * exact one, e^(time·ω), for any angle up to 2^20 radians, not a first-order step. The rotation that comes back has
 * length 1 within 2^-50, so that poses can be integrated without end.
 *
 * velocity          of the body's origin, in the world, a length per unit of time.
 * angular_velocity  ω in the world: along the axis, in radians per unit of time.
 *
 * Cost: O(1).
 */
PIR_API pir_pose pir_pose_integrate(pir_pose pose, pir_vec3 velocity, pir_vec3 angular_velocity, double time);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
/*
 * See motion.h. The implicit midpoint rule for Euler's equations has the spin ω in the body's frame that solves
 *
 *     I ω + (h/2) ω × I ω = L,
 *
 * with L the angular momentum there, and turns the body by Cayley's transform of hω. It keeps L in the world and the
 * energy, which is a quadratic form that the equations keep (Austin, Krishnaprasad and Wang, J. Computational Physics
 * 107, 1993).
 */
#include "motion.h"

/* The angle of a part, and the most parts. */
#define PART_ANGLE 0.5
#define PARTS_MOST 64
/* Newton's method doubles the bits that are right; it begins with three or more. */
#define NEWTON_STEPS 6

unsigned motion_parts(pir_vec3 spin, double time) {
    double parts = ceil(vec_length(spin) * time / PART_ANGLE);
    return parts < 1 ? 1 : parts < PARTS_MOST ? (unsigned)parts : PARTS_MOST;
}

/* The spin halfway. */
static pir_vec3 midpoint_spin(const struct motion_law *law, pir_vec3 spin, double time) {
    const pir_vec3 *row = law->inertia->row, momentum = mat_times(law->inertia, spin);
    pir_vec3 w = spin;
    for (int i = 0; i < NEWTON_STEPS; i++) {
        pir_vec3 l = mat_times(law->inertia, w), left = vec_add(l, vec_times(0.5 * time, vec_cross(w, l)));
        // row i of [w]× inertia, and of [l]×
        pir_vec3 turned[3] = {vec_less(vec_times(w.y, row[2]), vec_times(w.z, row[1])),
                              vec_less(vec_times(w.z, row[0]), vec_times(w.x, row[2])),
                              vec_less(vec_times(w.x, row[1]), vec_times(w.y, row[0]))};
        pir_vec3 crossed[3] = {{0, -l.z, l.y}, {l.z, 0, -l.x}, {-l.y, l.x, 0}};
        struct mat3 slope;
        for (int k = 0; k < 3; k++)
            slope.row[k] = vec_add(row[k], vec_times(0.5 * time, vec_less(turned[k], crossed[k])));
        struct mat3 inverse = mat_inverse(&slope);
        w = vec_less(w, mat_times(&inverse, vec_less(left, momentum)));
    }
    return w;
}

/* The arc tangent below 1/2, by its series with the angle halved twice. */
static double arc_tangent(double x) {
    for (int i = 0; i < 2; i++)
        x /= 1 + sqrt(1 + x * x);
    double square = x * x, sum = 0;
    for (int k = 12; k >= 0; k--)
        sum = 1. / (2 * k + 1) - square * sum;
    return 4 * x * sum;
}

struct motion_part motion_over(const struct motion_state *from, const struct motion_law *law, double time) {
    struct motion_part part = {.to = *from};
    part.way.way = vec_times(time, vec_add(from->velocity, vec_times(0.5 * time, law->gravity)));
    part.to.velocity = vec_add(from->velocity, vec_times(time, law->gravity));
    pir_vec3 spin = pir_pose_rotate_inverse(from->pose, from->spin), momentum = mat_times(law->inertia, spin);
    pir_vec3 middle = midpoint_spin(law, spin, time);
    double length = vec_length(middle);
    if (length > 0) {
        double angle = 2 * arc_tangent(0.5 * time * length);
        part.way.turn = pir_pose_rotate(from->pose, vec_times(angle / length, middle));
    }
    part.to.pose = pir_pose_integrate(from->pose, part.way.way, part.way.turn, 1);
    // the momentum stays in the world
    pir_vec3 in_world = pir_pose_rotate(from->pose, momentum);
    pir_vec3 now = mat_times(law->inverse_inertia, pir_pose_rotate_inverse(part.to.pose, in_world));
    part.to.spin = pir_pose_rotate(part.to.pose, now);
    return part;
}

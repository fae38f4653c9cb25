/* SPDX-License-Identifier: MIT */
/* The pose options. */
#include "pose.h"

#include "message.h"
#include "turn.h"

bool axis_read(const struct args *args, const char *name, pir_vec3 *ret_axis) {
    double axis[3];
    if (!args_numbers(args, name, 3, axis))
        return false;
    if (axis[0] == 0 && axis[1] == 0 && axis[2] == 0) {
        complain("%s: %s: '%s' is the zero vector, which has no direction", args->command->name, name,
                 args_value(args, name));
        return false;
    }
    *ret_axis = (pir_vec3){axis[0], axis[1], axis[2]};
    return true;
}

static bool quaternion_read(const struct args *args, pir_quat *ret_rotation) {
    double q[4];
    if (!args_numbers(args, "--quat", 4, q))
        return false;
    if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) {
        complain("%s: --quat: '%s' is the zero quaternion, which turns nothing", args->command->name,
                 args_value(args, "--quat"));
        return false;
    }
    *ret_rotation = (pir_quat){q[0], q[1], q[2], q[3]};
    return true;
}

bool pose_read(const struct args *args, pir_quat *ret_rotation) {
    bool quat = args_has(args, "--quat"), axis = args_has(args, "--axis"), angle = args_has(args, "--angle");
    if (quat && (axis || angle)) {
        complain("%s: --quat and %s are both given; one rotation is enough", args->command->name,
                 axis ? "--axis" : "--angle");
        return false;
    }
    if (axis != angle) {
        complain("%s: %s needs %s beside it", args->command->name, axis ? "--axis" : "--angle",
                 axis ? "--angle DEGREES" : "--axis x,y,z");
        return false;
    }
    if (quat)
        return quaternion_read(args, ret_rotation);
    pir_vec3 about = {0, 0, 1};
    double degrees = 0;
    if (axis && (!axis_read(args, "--axis", &about) || !args_numbers(args, "--angle", 1, &degrees)))
        return false;
    *ret_rotation = turn_about(about, degrees, 360);
    return true;
}

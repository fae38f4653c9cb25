/* SPDX-License-Identifier: MIT */
/* The pose options: one rotation, as a quaternion or as an axis and an angle. */
#ifndef TOOLS_POSE_H
#define TOOLS_POSE_H

#include <stdbool.h>

#include <pirouette/base.h>

#include "args.h"

/* The rotation that the options ask for, the identity when there are none; false after a complaint. */
bool pose_read(const struct args *args, pir_quat *ret_rotation);

/* Reads an axis from option `name`, which was given; false after a complaint. */
bool axis_read(const struct args *args, const char *name, pir_vec3 *ret_axis);

#endif

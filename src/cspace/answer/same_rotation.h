/* SPDX-License-Identifier: MIT */
/* Whether two quaternions are one rotation, exactly. */
#ifndef PIR_CSPACE_ANSWER_SAME_ROTATION_H
#define PIR_CSPACE_ANSWER_SAME_ROTATION_H

#include <stdbool.h>

#include <pirouette/base.h>

/* Whether a and b, finite and not zero, are multiples of each other. */
bool pir_same_rotation(pir_quat a, pir_quat b);

#endif

/* SPDX-License-Identifier: MIT */
/* Rotations in double-double. */
#ifndef PIR_QUERY_FRAME_DD_ROTATION_H
#define PIR_QUERY_FRAME_DD_ROTATION_H

#include "query/frame/dd.h"

/* The rows of R = M(q)/|q|², each entry off by a few 2^-104, for the quaternion q + rest. */
void pir_dd_rotation(pir_quat q, pir_quat rest, pir_dd3 row[3]);

#endif

/* SPDX-License-Identifier: MIT */
/* A motion as tests think of it: from a rotation and a place on, about an axis by an angle. */
#ifndef PIR_TEST_TURNING_H
#define PIR_TEST_TURNING_H

#include <math.h>

#include <pirouette/query.h>

typedef struct test_turning {
    pir_quat rotation;
    pir_vec3 start, motion, axis;
    double angle;
} test_turning;

/* The motion, the angle along the axis. */
static inline pir_motion test_motion(const test_turning *turning) {
    const pir_vec3 a = turning->axis;
    const double length = sqrt(a.x * a.x + a.y * a.y + a.z * a.z), part = length > 0 ? turning->angle / length : 0;
    return (pir_motion){turning->motion, {part * a.x, part * a.y, part * a.z}, 0};
}

/* What it meets first, from its rotation on, which the sum of the query is brought to. */
static inline pir_status test_impact(pir_query *query, pir_sum *sum, const test_turning *turning, double tolerance,
                                     pir_impact *ret_impact) {
    const pir_motion motion = test_motion(turning);
    pir_query_input input = pir_query_input_default();
    input.translation = turning->start;
    pir_status status = pir_sum_rotate(sum, turning->rotation, PIR_METHOD_AUTO);
    return status == PIR_OK ? pir_query_time_of_impact(query, &input, &motion, tolerance, ret_impact) : status;
}

#endif

/* SPDX-License-Identifier: MIT */
/*
 * See flight.h. With the normal n from Q to P at some time and the distance d, the bodies stay apart along n while P
 * comes nearer along it by less than d: P's points move along −n at most at the rate −way·n + |turn| · reach. So
 * there is no contact for d over that rate, and none at all where it is not positive (Mirtich 1996).
 */
#include "pair/flight.h"

#include "base/vec.h"

#define MOST_STEPS 256

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

pir_status pir_flight_check(pir_vec3 way, pir_vec3 turn, double tolerance) {
    if (!pir_vec_is_finite(way) || !pir_vec_is_finite(turn) || isnan(tolerance))
        return PIR_ERR_NOT_FINITE;
    if (!(tolerance > 0 && tolerance < HUGE_VAL))
        return PIR_ERR_ARGUMENT;
    return length(turn) <= 0x1p20 ? PIR_OK : PIR_ERR_LIMIT;
}

pir_status pir_pair_fly(pir_pair *pair, pir_workspace *workspace, pir_pair_input *input, const pir_flight *flight,
                        double until, pir_flight_end *ret_end) {
    const double swing = length(flight->turn) * flight->reach;
    pir_flight_end end = {.meets = true};
    for (int step = 0; step < MOST_STEPS; step++) {
        input->pose_p =
            end.time == 0 ? flight->from : pir_pose_integrate(flight->from, flight->way, flight->turn, end.time);
        const pir_status status = pir_pair_distance(pair, workspace, input, &end.answer);
        if (status != PIR_OK)
            return status;
        const double left = end.answer.distance - flight->error;
        if (end.answer.state != PIR_OUTSIDE || end.answer.distance <= flight->tolerance || step + 1 == MOST_STEPS)
            break;
        const double rate =
            (swing - pir_vec_dot(flight->way, end.answer.normal)) * (1 + 0x1p-40) + 0x1p-40 * length(flight->way);
        end.time += rate > 0 && left > 0 ? left / rate : rate > 0 ? 0x1p-40 : HUGE_VAL;
        end.meets = end.time <= until;
        if (!end.meets)
            break;
    }
    *ret_end = end;
    return PIR_OK;
}

/* SPDX-License-Identifier: MIT */
/*
 * See flight.h. The normal n from Q to P at some time, and Q's point nearest to P, make a plane that has Q below it for
 * good, since Q is at rest. The bodies are apart until P comes down to it (query/proof/parting.h). There the distance
 * is asked for again, and its plane parts them further.
 */
#include "pair/flight.h"

#include "polytope/polytope.h"
#include "query/proof/parting.h"

/*
 * Few casts need more than ten steps. Those that take all glide along something that is hardly farther than the
 * tolerance, or pass it so at every corner: so many are for each full turn that is begun, and so many for all.
 */
#define STEPS_A_TURN 512
#define MOST_STEPS   65536
#define FULL_TURN    6.283185307179586
/* Distances are within this of the exact ones, relative to bodies and coordinates, with room to spare. */
#define DISTANCE_ERROR 1e-11
/* Likewise of the way of P's farthest point: angles of many turns have few bits behind them. */
#define TURN_ERROR 0x1p-48

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

static int most_steps(const pir_flight *flight) {
    return (int)fmin(MOST_STEPS, STEPS_A_TURN * (1 + floor(length(flight->motion->turn) / FULL_TURN)));
}

/* Ends a flight that begins where the bodies share a point. */
static pir_status end_at_once(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                              const pir_flight *flight, pir_flight_end *end) {
    bool inside = end->answer.state == PIR_INSIDE;
    end->outcome = flight->motion->held > 0 ? PIR_CAST_MISS : inside ? PIR_CAST_START_INSIDE : PIR_CAST_HIT;
    return inside && !(flight->motion->held > 0) ? pir_pair_penetration(pair, workspace, input, &end->answer) : PIR_OK;
}

pir_status pir_pair_fly(pir_pair *pair, pir_workspace *workspace, pir_pair_input *input, const pir_flight *flight,
                        double until, pir_flight_end *ret_end) {
    const double error = DISTANCE_ERROR * flight->size + TURN_ERROR * length(flight->motion->turn) * flight->reach;
    const pir_parted body = {flight->p->vertex, flight->p->vertex_count, input->radius_p,
                             flight->reach,     flight->motion->way,     flight->motion->turn};
    pir_flight_end end = {.outcome = PIR_CAST_STEP_LIMIT};
    double near = 0;
    const int steps = most_steps(flight);
    // what is farther than P can come at all need not be known
    input->cutoff = (length(flight->motion->way) + length(flight->motion->turn) * flight->reach) * (1 + 0x1p-40) +
                    2 * error + fmax(flight->tolerance, 4 * error);
    for (int step = 0; step < steps && end.outcome == PIR_CAST_STEP_LIMIT; step++) {
        input->pose_p = end.time == 0
                            ? flight->from
                            : pir_pose_integrate(flight->from, flight->motion->way, flight->motion->turn, end.time);
        pir_status status = pir_pair_distance(pair, workspace, input, &end.answer);
        if (status == PIR_OK && step == 0 && end.answer.state != PIR_OUTSIDE)
            status = end_at_once(pair, workspace, input, flight, &end);
        if (status != PIR_OK)
            return status;
        if (end.answer.outcome == PIR_BEYOND_CUTOFF)
            end.outcome = PIR_CAST_MISS;
        if (end.outcome != PIR_CAST_STEP_LIMIT)
            break;
        if (step == 0)
            near = pir_motion_near(flight->motion, flight->tolerance, end.answer.distance, 4 * error);
        if (near == 0 || end.answer.distance <= near) {
            end.outcome = near == 0 ? PIR_CAST_MISS : PIR_CAST_HIT;
            break;
        }
        const pir_parting plane = {end.answer.normal, end.answer.point_q, 0.75 * near, 0.5 * near};
        end.time = pir_part_until(&body, &plane, input->pose_p, end.answer.distance, end.time, until);
        if (!(end.time <= until))
            end.outcome = PIR_CAST_MISS;
    }
    *ret_end = end;
    return PIR_OK;
}

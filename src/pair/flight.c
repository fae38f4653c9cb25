/* SPDX-License-Identifier: MIT */
/* When P of a pair comes near Q: see flight.h. */
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

static int most_steps(const pir_flight *flight) {
    return (int)fmin(MOST_STEPS, STEPS_A_TURN * (1 + floor(pir_vec_length(flight->motion->turn) / FULL_TURN)));
}

/* An advance on a pair. */
struct pair_advance {
    pir_advance advance; /* first: what the loop knows */
    pir_pair *pair;
    pir_workspace *workspace;
    pir_pair_input *input;
    const pir_flight *flight;
};

static pir_status ask(pir_advance *advance, pir_pose *ret_pose) {
    struct pair_advance *on = (struct pair_advance *)advance;
    const pir_motion *motion = advance->motion;
    on->input->pose_p = *ret_pose =
        advance->time == 0 ? on->flight->from
                           : pir_pose_integrate(on->flight->from, motion->way, motion->turn, advance->time);
    pir_status status = pir_pair_distance(on->pair, on->workspace, on->input, &advance->answer);
    if (status == PIR_OK && advance->answer.outcome == PIR_BEYOND_CUTOFF)
        advance->outcome = PIR_CAST_MISS;
    if (status != PIR_OK || advance->time != 0 || advance->answer.state == PIR_OUTSIDE)
        return status;
    // at the beginning the bodies share a point
    const bool inside = advance->answer.state == PIR_INSIDE;
    advance->outcome = motion->held > 0 ? PIR_CAST_MISS : inside ? PIR_CAST_START_INSIDE : PIR_CAST_HIT;
    if (advance->outcome != PIR_CAST_START_INSIDE)
        return PIR_OK;
    return pir_pair_penetration(on->pair, on->workspace, on->input, &advance->answer);
}

pir_status pir_pair_fly(pir_pair *pair, pir_workspace *workspace, pir_pair_input *input, const pir_flight *flight,
                        double until, pir_flight_end *ret_end) {
    const pir_motion *motion = flight->motion;
    const double error = DISTANCE_ERROR * flight->size + TURN_ERROR * pir_vec_length(motion->turn) * flight->reach;
    struct pair_advance on = {{.body = {.point = flight->p->vertex,
                                        .count = flight->p->vertex_count,
                                        .radius = input->radius_p,
                                        .reach = flight->reach,
                                        .way = motion->way,
                                        .turn = motion->turn},
                               .motion = motion,
                               .tolerance = flight->tolerance,
                               .least = 4 * error,
                               .until = until,
                               .steps = most_steps(flight),
                               .ask = ask},
                              pair,
                              workspace,
                              input,
                              flight};
    // a distance beyond P's whole way need not be known
    input->cutoff = (pir_vec_length(motion->way) + pir_vec_length(motion->turn) * flight->reach) * (1 + 0x1p-40) +
                    2 * error + fmax(flight->tolerance, 4 * error);
    pir_status status = pir_advance_run(&on.advance);
    if (status == PIR_OK)
        *ret_end = (pir_flight_end){on.advance.outcome, on.advance.time, on.advance.answer};
    return status;
}

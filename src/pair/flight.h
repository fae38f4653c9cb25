/* SPDX-License-Identifier: MIT */
/* When P of a pair, moving, comes near Q: conservative advancement. */
#ifndef PIR_PAIR_FLIGHT_H
#define PIR_PAIR_FLIGHT_H

#include <stdbool.h>

#include <pirouette/pair.h>

/* A motion of P over time 0 to 1, at constant speed. */
typedef struct pir_flight {
    const pir_polytope *p;
    pir_pose from;
    const pir_motion *motion;
    double reach;     /* no point of P is farther from its origin */
    double tolerance; /* bodies this near have met */
    double size;      /* of both bodies and their coordinates, which rounding is relative to */
} pir_flight;

typedef struct pir_flight_end {
    pir_cast_outcome outcome; /* HIT, MISS, START_INSIDE or STEP_LIMIT */
    double time;
    pir_query_result answer; /* that of the last step; of START_INSIDE the penetration */
} pir_flight_end;

/* The time at which P comes within the tolerance of Q, where that is at most `until`; else a miss. `input` has Q's
 * pose, the radii and no cutoff. */
pir_status pir_pair_fly(pir_pair *pair, pir_workspace *workspace, pir_pair_input *input, const pir_flight *flight,
                        double until, pir_flight_end *ret_end);

#endif

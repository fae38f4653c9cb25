/* SPDX-License-Identifier: MIT */
/*
 * That there is no path, where a piece of the robot has to pass a wall whose holes are too narrow at every rotation.
 *
 * Planes across the directions of obstacles' facets, at heights between those of their vertices, are tried for walls
 * (opening_wall.h). In the frame of the piece a plane has three degrees of freedom, whatever the piece's turn about the
 * plane's normal and place in the plane are: these are what is divided (opening_cells.h), instead of the six of the
 * piece. A wall without holes has nothing to be divided. All is made by one thread, the same at each call.
 */
#ifndef PIR_PLAN_OPENING_OPENING_H
#define PIR_PLAN_OPENING_OPENING_H

#include <stdio.h>

#include "plan/opening/opening_cells.h"
#include "plan/opening/opening_wall.h"

typedef struct pir_opening_result {
    bool is_closed;
    uint32_t cells; /* that planes were divided into, for the wall that decided, else for all of them */
} pir_opening_result;

/*
 * Decides, or leaves it; writes the proof where there is a file. `cells` of the budget is how many may be made in
 * all; what its `goes_on` ends is a PIR_ERR_LIMIT.
 */
pir_status pir_opening_decide(const pir_plan_asked *question, const pir_opening_budget *how, FILE *proof,
                              pir_opening_result *ret_result);

#endif

/* SPDX-License-Identifier: MIT */
/* Lower bounds on the slacks of groups, without looking at their planes: see bounds.c. */
#ifndef PIR_QUERY_DEPTH_BOUNDS_H
#define PIR_QUERY_DEPTH_BOUNDS_H

#include "query/depth/groups.h"

/* All arrays have an element per group, padded to whole lanes. */
typedef struct pir_bounds {
    pir_lasting_lanes lasting;
    double *low; /* the bounds for the present placement */

    /* caps at the rotation that the stamp of their block is of, with the angles of the groups' lists */
    pir_cap_lanes caps;
    uint64_t *cap_stamp; /* per block of lanes */

    /* an upper bound on the sum of the angles between the rotations at which bounds were found */
    double turn;
    pir_quat turned_to; /* the last of these rotations */
    uint64_t turned;    /* its stamp */
} pir_bounds;

/* Adds the rows of the bounds to a layout. */
void pir_bounds_add_rows(pir_bounds *bounds, const pir_groups *groups, pir_layout *layout);

/* Forgets all bounds and takes the angles of the caps from the lists. */
void pir_bounds_fill(pir_bounds *bounds, const pir_groups *groups);

/*
 * Sets bounds->low[g] to a lower bound on the slacks of every group g at x, as tight as it takes to tell it from
 * `limit`. Returns an upper bound on the least slack of all, HUGE_VAL where it has found none.
 */
double pir_bounds_find(pir_bounds *bounds, const pir_groups *groups, const pir_placement *placement, double limit);

/* The least s − error and the least s + error of all planes of group `g`. The first is kept as the group's bound. */
void pir_bounds_look(pir_bounds *bounds, pir_groups *groups, uint32_t g, const pir_placement *placement,
                     double *ret_low, double *ret_high);

/* Keeps a bound for group `g` at x: no slack is below `low`, and no n·x is below `along`. */
void pir_bounds_keep(pir_bounds *bounds, const pir_groups *groups, uint32_t g, const pir_placement *placement,
                     double low, double along);

#endif

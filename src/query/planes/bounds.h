/* SPDX-License-Identifier: MIT */
/* What the slacks of a group can be without looking at its planes: see bounds.c. */
#ifndef PIR_QUERY_PLANES_BOUNDS_H
#define PIR_QUERY_PLANES_BOUNDS_H

#include "query/planes/group_planes.h"

/* All arrays have an element per group, padded to whole lanes. */
typedef struct pir_bounds {
    pir_lasting_lanes lasting;
    double *low; /* the bounds for the placement in hand */

    /* caps, at the rotation of the stamp of their block of lanes; their axes and corners as the body has them */
    pir_cap_lanes caps;
    pir_lanes cap_axis_body, cap_corner_body;
    uint64_t *cap_stamp; /* per block of lanes */

    /* an upper bound on the sum of all turns from one rotation that bounds were asked at to the next */
    double turn;
    pir_quat turned_to; /* the last of these rotations */
    uint64_t turned;    /* its stamp */
} pir_bounds;

/* Memory; false when out of it: pir_bounds_finish frees what is there. Filled in: caps, and no bound known. */
bool pir_bounds_init(pir_bounds *bounds, const pir_allocator *allocator, const pir_groups *groups);
void pir_bounds_finish(pir_bounds *bounds, const pir_allocator *allocator, const pir_groups *groups);
void pir_bounds_fill(pir_bounds *bounds, pir_groups *groups);

/*
 * bounds->low[g]: no slack of group g at x is below it; worked out no better than to tell it from `limit`. Returns a
 * number that the least slack of all is not above, HUGE_VAL where it met none.
 */
double pir_bounds_find(pir_bounds *bounds, const pir_groups *groups, const pir_placement *placement, double limit);

/* Looks at every plane of group `g`: the least s − error and the least s + error; keeps the first as its bound. */
void pir_bounds_look(pir_bounds *bounds, pir_groups *groups, uint32_t g, const pir_placement *placement,
                     double *ret_low, double *ret_high);

/* Keeps what is known of group `g` at x: no slack is below `low`, and no n·x below `along`. */
void pir_bounds_keep(pir_bounds *bounds, const pir_groups *groups, uint32_t g, const pir_placement *placement,
                     double low, double along);

#endif

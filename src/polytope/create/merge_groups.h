/* SPDX-License-Identifier: MIT */
/* Which facets of a hull might become one, and near which plane: decided by doubles, and proven by merge.c. */
#ifndef PIR_POLYTOPE_CREATE_MERGE_GROUPS_H
#define PIR_POLYTOPE_CREATE_MERGE_GROUPS_H

#include "base/vec.h"
#include "polytope/polytope.h"

#define PIR_NO_GROUP UINT32_MAX

/*
 * The direction of a group's plane, whose normal has components 2^bits at `axis`, −slope[0] and −slope[1] at the
 * two axes that follow cyclically. So a coordinate along `axis` of a point of the plane is an integer over 2^bits.
 */
typedef struct pir_merge_slope {
    int axis, bits;
    int64_t slope[2];
} pir_merge_slope;

typedef struct pir_merge_group {
    pir_merge_slope slope;
    double area;   /* of its facets, in units of the body's size */
    uint32_t next; /* the end of its facets in the list; it begins where the group before ends */
    bool active;   /* whether it is to be merged */
} pir_merge_group;

typedef struct pir_merge_groups {
    uint32_t count, room;
    pir_merge_group *group;
    uint32_t *of;     /* per facet of the hull: its group, or PIR_NO_GROUP when it is alone */
    uint32_t *facets; /* the facets of all groups, group by group */
} pir_merge_groups;

/*
 * Groups of two facets and more whose corners are within half of `tolerance`, a length, of one plane. Deterministic.
 * PIR_ERR_MEMORY leaves nothing to release.
 */
pir_status pir_merge_groups_make(pir_merge_groups *groups, const pir_polytope *hull, double tolerance);
void pir_merge_groups_finish(pir_merge_groups *groups, const pir_polytope *hull);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * What a sum keeps when its caller needs a cone of directions only. The idea and the invariants stand in region.c.
 */
#ifndef PIR_DYMSUM_REGION_H
#define PIR_DYMSUM_REGION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/memory.h"
#include "base/vec.h"

/* An angle from 0 to π by its cosine and sine. */
typedef struct pir_arc {
    double cosine, sine;
} pir_arc;

/* Where the region was, and how far it and the bodies may go, when what is kept was chosen: that is a function of this alone. */
typedef struct pir_cover {
    bool whole;              /* all is kept */
    pir_vec3 axis_p, axis_q; /* the region's axis, unit: as P saw it, and Q */
    pir_arc half_angle;      /* the region's */
    double skin_p, skin_q;   /* radians: how far either sight of the axis may go */
    double cosine_p, cosine_q;
    double stride; /* radians: how far a step that leads out of here may, or has led in here */
} pir_cover;

/* Features of one kind. */
typedef struct pir_members {
    uint32_t *at, count; /* the active ones */
    uint32_t *next;      /* room for those of the next sweep */
    uint32_t *seen;      /* per feature: the last sweep that counted it in */
    uint32_t capacity;   /* how many features there are */
} pir_members;

/* Facets as the sweep reads them. */
typedef struct pir_region_facets {
    float *x, *y, *z;     /* normals */
    float *cosine, *sine; /* of half the longest arc at each */
    float *apart;         /* what a pass over them found */
    uint32_t *hint;       /* per dormant facet: the cell it was in last */
    pir_members members;
} pir_region_facets;

/* A cone of directions in the frame of Q, or all of them. */
typedef struct pir_cone {
    bool set;                  /* else all */
    pir_vec3 axis;             /* unit */
    double half_angle, cosine; /* cosine: rounded down */
} pir_cone;

typedef struct pir_region {
    pir_cone cone;
    pir_cover cover;
    bool admits;             /* a sweep has counted in features that are still dormant */
    bool leapt;              /* the last step may have carried what was or is dormant through what is active */
    uint32_t steps;          /* since the cover was centred */
    uint32_t sweep, changes; /* changes: how often the active features have become others */
    pir_region_facets p, q;  /* memory from the first cone on, as for the edges */
    pir_members edges;       /* of P */
} pir_region;

struct pir_sum;
struct pir_rotation;

/* Whether a direction of any length is in the cone, rounding towards yes; what has no direction is. */
static inline bool pir_cone_has(const pir_cone *cone, pir_vec3 n) {
    return !cone->set || pir_vec_dot(n, cone->axis) >= cone->cosine * sqrt(pir_vec_dot(n, n));
}

/* The cone about an axis of any length. Errors as pir_sum_set_region. */
pir_status pir_cone_make(pir_vec3 axis, double half_angle, pir_cone *ret_cone);

void pir_region_finish(struct pir_sum *sum);

/* Gives `to`, a sum of the same operands and of no pairing, the region and the active features of `from`; false when out of memory. */
bool pir_region_copy(struct pir_sum *to, const struct pir_sum *from);

/* Whether what is kept holds all that the region needs at `rotation`. */
bool pir_region_holds(const struct pir_sum *sum, const struct pir_rotation *rotation);

/* --- around an update --- */

/* Before: where the region needs it chooses anew what is kept, and lets the rest go. */
void pir_region_follow(struct pir_sum *sum);

/* After: brings in what has been chosen and is not there yet. False when out of memory. */
bool pir_region_admit(struct pir_sum *sum);

/* --- around a rebuild --- */

/* Chooses anew what is kept, at the rotation of now, whatever was before. */
void pir_region_renew(struct pir_sum *sum);

/* The pairing of what is kept, from nothing; false when out of memory. */
bool pir_region_walk(struct pir_sum *sum);

/* All is kept, for a rebuild that knows no regions; and then again only what the region needs. */
void pir_region_open(struct pir_sum *sum);
void pir_region_close(struct pir_sum *sum);

/* The part of all features that is active, from 0 to 1. */
double pir_region_share(const struct pir_sum *sum);

#endif

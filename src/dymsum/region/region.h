/* SPDX-License-Identifier: MIT */
/*
 * What a sum keeps when its caller needs a cone of directions only. The idea and the invariants stand in region.c.
 */
#ifndef PIR_DYMSUM_REGION_REGION_H
#define PIR_DYMSUM_REGION_REGION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/memory.h"
#include "base/vec.h"
#include "dymsum/region/cover.h"

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

typedef struct pir_region {
    pir_cone cone;
    pir_cover cover;
    bool admits;            /* a sweep has counted in features that are still dormant */
    bool jumped;             /* the last step may have carried what was or is dormant through what is active */
    uint32_t sweep;         /* the number of the last sweep */
    pir_region_facets p, q; /* memory from the first cone on, as for the edges */
    pir_members edges;      /* of P */
} pir_region;

struct pir_sum;
struct pir_rotation;

/*
 * Gives a sum that has no region, but the pairing of one, that region; *ret_fits: whether the pairing has a cell for every facet that the
 * cover asks for, none for any other, no crossings else, and the cover holds. Cells are in range or PIR_NO_PAIR. False when out of memory.
 */
bool pir_region_adopt(struct pir_sum *sum, const pir_cone *cone, const pir_cover *cover, bool *ret_fits);

/* Whether what is kept holds all that the region needs at `rotation`. */
bool pir_region_holds(const struct pir_sum *sum, const struct pir_rotation *rotation);

/* Takes note of a step from the rotation of unit quaternion `before`, which the sum was at, to that of now. */
void pir_region_step(struct pir_sum *sum, pir_quat before);

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

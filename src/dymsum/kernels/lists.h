/* SPDX-License-Identifier: MIT */
/*
 * Caps, points and arcs within reach of a direction, by floats. A region's sweep lists them.
 */
#ifndef PIR_DYMSUM_KERNELS_LISTS_H
#define PIR_DYMSUM_KERNELS_LISTS_H

#include "dymsum/kernels/facet_checks.h"

/* A direction, and how far from it a region's sweep looks, by floats. */
typedef struct pir_sight {
    float x, y, z;      /* unit */
    float cosine, sine; /* of the reach */
    float slack;        /* what is beyond the reach by no more, in the cosine, counts as within */
} pir_sight;

/* Caps on the sphere, so many; there is room for whole blocks of PIR_LANES. */
typedef struct pir_caps {
    float *x, *y, *z, *cosine, *sine;
    uint32_t count;
} pir_caps;

/* Points or arcs in clusters of PIR_LANES, the last perhaps with fewer, and which clusters are looked at. */
typedef struct pir_clustered {
    const float *row;     /* cluster by cluster, as many rows as an item has numbers */
    const uint32_t *item; /* numbers, with room for whole clusters */
    uint32_t count;       /* of items */
    const uint32_t *cluster;
    uint32_t clusters;
} pir_clustered;

/* Rows of an arc: the normals at its ends, the direction of its edge, the cosine of its length. */
enum {
    PIR_ARC_FROM = 0,
    PIR_ARC_TO = 3,
    PIR_ARC_ALONG = 6,
    PIR_ARC_COSINE = 9,
    PIR_ARC_ROWS = 10,
};

/* Rows of a point: its unit vector. */
enum { PIR_POINT_ROWS = 3 };

/* The scalar reference, for versions that have none of their own. */
uint32_t pir_list_caps(const pir_caps *caps, const pir_sight *sight, uint32_t *ret_which);
uint32_t pir_list_points(const pir_clustered *points, const pir_sight *sight, uint32_t *ret_item);
uint32_t pir_list_arcs(const pir_clustered *arcs, const pir_sight *sight, uint32_t *at, uint32_t *ret_item);

#endif

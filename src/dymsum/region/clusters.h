/* SPDX-License-Identifier: MIT */
/* Points and arcs of a Gaussian map, sorted into clusters of neighbours: see clusters.c. */
#ifndef PIR_DYMSUM_REGION_CLUSTERS_H
#define PIR_DYMSUM_REGION_CLUSTERS_H

#include "dymsum/region/cover.h"
#include "polytope/polytope.h"

/* Items in a cluster; the last may have fewer. */
#define PIR_CLUSTER 8

/* The part of the sphere within `radius` of a unit vector. */
typedef struct pir_cap {
    pir_vec3 middle;
    pir_arc radius;
} pir_cap;

/* A cap that holds item i of a polytope. */
typedef pir_cap pir_cap_of(const pir_polytope *p, uint32_t i);

typedef struct pir_clusters {
    uint32_t count; /* of items */
    uint32_t *item; /* cluster by cluster */

    /* per cluster, as floats: a cap that holds its items */
    float *x, *y, *z, *cosine, *sine;

    /* of the last search: per cluster the cosine that it is within reach by, and which clusters are near */
    float *by;
    uint32_t *near;
} pir_clusters;

/* Sorts `count` items of p. False when out of memory: then there is nothing. */
bool pir_clusters_init(pir_clusters *clusters, const pir_polytope *p, uint32_t count, pir_cap_of *cap_of,
                       const pir_allocator *allocator);
void pir_clusters_finish(pir_clusters *clusters, const pir_allocator *allocator);

static inline uint32_t pir_cluster_count(const pir_clusters *clusters) {
    return (clusters->count + PIR_CLUSTER - 1) / PIR_CLUSTER;
}

/* How many items cluster k has. */
static inline uint32_t pir_cluster_size(const pir_clusters *clusters, uint32_t k) {
    uint32_t left = clusters->count - k * PIR_CLUSTER;
    return left < PIR_CLUSTER ? left : PIR_CLUSTER;
}

/*
 * Lists in `near` the clusters that may have an item within `reach` of the axis, or beyond that by up to 2^-17 in the
 * cosine. Returns how many there are.
 */
uint32_t pir_clusters_search(pir_clusters *clusters, pir_vec3 axis, pir_arc reach);

#endif

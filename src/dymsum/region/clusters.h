/* SPDX-License-Identifier: MIT */
/* Points and arcs of a Gaussian map, sorted into clusters of neighbours: see clusters.c. */
#ifndef PIR_DYMSUM_REGION_CLUSTERS_H
#define PIR_DYMSUM_REGION_CLUSTERS_H

#include "dymsum/kernels/kernels.h"
#include "dymsum/region/cover.h"

/* Items in a cluster, as many as kernels take at a time; the last may have fewer. */
#define PIR_CLUSTER PIR_LANES

/* The part of the sphere within `radius` of a unit vector. */
typedef struct pir_cap {
    pir_vec3 middle;
    pir_arc radius;
} pir_cap;

/* A cap that holds item i of a polytope. */
typedef pir_cap pir_cap_of(const pir_polytope *p, uint32_t i);

typedef struct pir_clusters {
    uint32_t count; /* of items */
    uint32_t *item; /* cluster by cluster, with room for whole clusters */
    pir_caps caps;  /* per cluster: a cap that holds its items */
    uint32_t *near; /* which clusters the last search has found, with room for whole blocks of them */
} pir_clusters;

/* Sorts `count` items of p. False when out of memory: then there is nothing. */
bool pir_clusters_init(pir_clusters *clusters, const pir_polytope *p, uint32_t count, pir_cap_of *cap_of,
                       const pir_allocator *allocator);
void pir_clusters_finish(pir_clusters *clusters, const pir_allocator *allocator);

static inline uint32_t pir_cluster_count(const pir_clusters *clusters) {
    return (clusters->count + PIR_CLUSTER - 1) / PIR_CLUSTER;
}

/* So many numbers, and room for whole blocks of PIR_LANES. */
static inline uint32_t pir_whole_lanes(uint32_t count) {
    return (count + PIR_LANES - 1) / PIR_LANES * PIR_LANES;
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
uint32_t pir_clusters_search(pir_clusters *clusters, const pir_kernels *kernels, pir_vec3 axis, pir_arc reach);

#endif

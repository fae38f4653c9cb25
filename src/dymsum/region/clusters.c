/* SPDX-License-Identifier: MIT */
/*
 * Clusters: items of a Gaussian map that lie near each other stand together, with a cap around each cluster. A search
 * compares the caps, and its caller the items of those that are near, by kernels.
 *
 * Items are sorted by the squares of a grid on the faces of a cube, and these in Morton's order: the bits of the two
 * coordinates alternate. So an item's place depends on the polytope alone.
 */
#include "dymsum/region/clusters.h"

#include "base/layout.h"

/*
 * Radians that each cap is widened by. An item beyond a reach ρ by 2^-17 in the cosine is beyond it by at most
 * 2^-17/sin ρ as an angle, where ρ is no nearer to 0 or π than this; nearer to π, FLOAT_SLACK includes all.
 */
#define CAP_SLACK 0x1p-8

/* Floats are off by less than 2^-20 in the cosine. */
#define FLOAT_SLACK 0x1p-17f

/* A grid has about so many items in a square. */
#define SQUARE 4

/* --- memory --- */

static pir_layout layout_of(pir_clusters *clusters) {
    uint32_t count = pir_cluster_count(clusters), lanes = pir_whole_lanes(count);
    pir_caps *caps = &clusters->caps;
    return (pir_layout){{PIR_ROW(clusters->item, count * PIR_CLUSTER), PIR_ROW(caps->x, lanes), PIR_ROW(caps->y, lanes),
                         PIR_ROW(caps->z, lanes), PIR_ROW(caps->cosine, lanes), PIR_ROW(caps->sine, lanes),
                         PIR_ROW(clusters->near, lanes)}};
}

void pir_clusters_finish(pir_clusters *clusters, const pir_allocator *allocator) {
    pir_layout layout = layout_of(clusters);
    pir_layout_free(allocator, &layout);
    *clusters = (pir_clusters){0};
}

/* --- sorting --- */

/* The squares along a side of the grid, a power of two: its logarithm. */
static unsigned grid_bits(uint32_t count) {
    unsigned bits = 0;
    while (bits < 12 && 6ull * SQUARE << 2 * (bits + 1) <= count)
        bits++;
    return bits;
}

/* Which of the squares along a side has the coordinate c, from −1 to 1. */
static uint32_t square_along(double c, unsigned bits) {
    double at = (c + 1) / 2 * (double)(1u << bits), most = (double)((1u << bits) - 1);
    return (uint32_t)fmin(fmax(at, 0), most);
}

/* The number of the square that a direction goes through. */
static uint32_t square_of(pir_vec3 n, unsigned bits) {
    const double c[3] = {n.x, n.y, n.z};
    int k = fabs(c[0]) >= fabs(c[1]) ? 0 : 1;
    k = fabs(c[2]) > fabs(c[k]) ? 2 : k;
    uint32_t i = square_along(c[(k + 1) % 3] / fabs(c[k]), bits), j = square_along(c[(k + 2) % 3] / fabs(c[k]), bits);
    uint32_t square = (uint32_t)k + (c[k] < 0 ? 3 : 0);
    for (unsigned bit = bits; bit-- > 0;)
        square = square << 2 | (i >> bit & 1) << 1 | (j >> bit & 1);
    return square;
}

/* Counting sort by squares. `start` has room for one number more than there are squares. */
static void sort_items(pir_clusters *clusters, const pir_polytope *p, pir_cap_of *cap_of, unsigned bits,
                       uint32_t *start) {
    uint32_t squares = 6u << 2 * bits;
    for (uint32_t i = 0; i < clusters->count; i++)
        start[square_of(cap_of(p, i).middle, bits) + 1]++;
    for (uint32_t s = 0; s < squares; s++)
        start[s + 1] += start[s];
    for (uint32_t i = 0; i < clusters->count; i++)
        clusters->item[start[square_of(cap_of(p, i).middle, bits)]++] = i;
}

/* Makes the cap of cluster k: about the mean of its items' middles. */
static void bound_cluster(pir_clusters *clusters, const pir_polytope *p, pir_cap_of *cap_of, uint32_t k) {
    const uint32_t *item = clusters->item + k * PIR_CLUSTER;
    uint32_t size = pir_cluster_size(clusters, k);
    pir_vec3 mean = {0, 0, 0};
    for (uint32_t i = 0; i < size; i++)
        mean = pir_vec_add(mean, cap_of(p, item[i]).middle);
    double square = pir_vec_dot(mean, mean);
    // any middle will do where there is no mean
    pir_vec3 middle = square > 0x1p-10 ? pir_vec_scale(mean, 1 / sqrt(square)) : cap_of(p, item[0]).middle;
    pir_arc radius = {1, 0};
    for (uint32_t i = 0; i < size; i++) {
        pir_cap cap = cap_of(p, item[i]);
        pir_arc to = pir_arc_add(pir_arc_from_cosine(pir_vec_dot(middle, cap.middle)), cap.radius);
        radius = to.cosine < radius.cosine ? to : radius;
    }
    radius = pir_arc_add(radius, pir_arc_of(CAP_SLACK));
    clusters->caps.x[k] = (float)middle.x;
    clusters->caps.y[k] = (float)middle.y;
    clusters->caps.z[k] = (float)middle.z;
    clusters->caps.cosine[k] = (float)radius.cosine;
    clusters->caps.sine[k] = (float)radius.sine;
}

bool pir_clusters_init(pir_clusters *clusters, const pir_polytope *p, uint32_t count, pir_cap_of *cap_of,
                       const pir_allocator *a) {
    *clusters = (pir_clusters){.count = count};
    clusters->caps.count = pir_cluster_count(clusters);
    unsigned bits = grid_bits(count);
    uint32_t starts = (6u << 2 * bits) + 1, *start = PIR_ZEROED(a, uint32_t, starts);
    pir_layout layout = layout_of(clusters);
    bool done = start && pir_layout_new(a, &layout);
    if (done) {
        sort_items(clusters, p, cap_of, bits, start);
        for (uint32_t k = 0; k < pir_cluster_count(clusters); k++)
            bound_cluster(clusters, p, cap_of, k);
    }
    PIR_FREE(a, start, starts);
    return done;
}

/* --- searching --- */

uint32_t pir_clusters_search(pir_clusters *clusters, const pir_kernels *kernels, pir_vec3 axis, pir_arc reach) {
    const pir_sight sight = {(float)axis.x,       (float)axis.y,     (float)axis.z,
                             (float)reach.cosine, (float)reach.sine, FLOAT_SLACK};
    return kernels->list_caps(&clusters->caps, &sight, clusters->near);
}

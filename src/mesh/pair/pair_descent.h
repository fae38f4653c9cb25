/* SPDX-License-Identifier: MIT */
/* A descent from the roots of two trees to the pairs of leaves that may be within a distance. */
#ifndef PIR_MESH_PAIR_PAIR_DESCENT_H
#define PIR_MESH_PAIR_PAIR_DESCENT_H

#include "mesh/pair/trimesh_pair.h"

typedef struct pir_pair_descent {
    double within;
    /* Whether a pair of items need not be looked at, for another reason than its distance; or NULL. */
    bool (*skip)(const void *context, pir_mesh_item p, pir_mesh_item q);
    /* Looks at two leaves; n is a direction that nearly takes them apart. */
    void (*look)(void *context, const uint32_t leaf[2], pir_vec3 n);
    void *context;
} pir_pair_descent;

/* Items of lower triangles are looked at first. */
void pir_pair_descend(pir_trimesh_pair *pair, const pir_pair_descent *descent);

/*
 * Looks for pairs as near as the best, or nearer, among those within a distance and of lower numbers, the lowest first.
 * Where the best meets and the distance is 0 it becomes the lowest that meets.
 */
void pir_lowest_pair_find(pir_trimesh_pair *pair, double within);

#endif

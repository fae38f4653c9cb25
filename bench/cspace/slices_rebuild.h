/* SPDX-License-Identifier: MIT */
/* The other ways to a slice: rebuilds, timed at rotations spread over the scene, and meshes stored whole. */
#ifndef BENCH_SLICES_REBUILD_H
#define BENCH_SLICES_REBUILD_H

#include "slices_scene.h"

/* Nanoseconds of a slice of a pair of pieces. NaN where the build lacks what it takes. */
double slices_walk(const struct slices_bodies *bodies);
double slices_older_walk(const struct slices_bodies *bodies);

/* qhull on all sums of vertices. */
double slices_hull(const struct slices_bodies *bodies);

/* The mean bytes of a mesh: vertices as doubles, corners of facets as numbers of 32 bits, both deflated as by gzip. */
double slices_mesh_bytes(const struct slices_bodies *bodies);

#endif

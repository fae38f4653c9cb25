/* SPDX-License-Identifier: MIT */
/* What the benchmark of slices measures: pieces, a grid, and how many of its rotations. */
#ifndef BENCH_SLICES_SCENE_H
#define BENCH_SLICES_SCENE_H

#include <pirouette/cspace.h>
#include <pirouette/pirouette.h>

#define SLICES_PIECES_MOST 64
#define SLICES_UNIT        256 /* slices of a unit, as where there are many */

/* A body by name, "shape:NAME" or the path of a model, or a robot of all models in a folder. */
struct slices_scene {
    const char *name, *p, *q;
    uint32_t steps, level; /* about an axis where steps > 0, else all rotations of the level */
    uint32_t share;        /* the first ones, one in so many */
};

/* The scene made. Each piece of P meets Q. */
struct slices_bodies {
    char name[SLICES_PIECES_MOST][1024]; /* of P's pieces */
    const char *q_name;
    pir_polytope *p[SLICES_PIECES_MOST], *q;
    uint32_t pieces;
    pir_grid *grid;
    uint64_t slices; /* of each piece */
    double turn;     /* the mean, in degrees */
};

/* Ends the program with a message where a model cannot be read. */
void slices_make(const struct slices_scene *scene, struct slices_bodies *ret_bodies);
void slices_free(struct slices_bodies *bodies);

/* CPU time of the process, in nanoseconds. */
double slices_cpu(void);

#endif

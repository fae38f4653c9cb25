/* SPDX-License-Identifier: MIT */
/* The slices of a file that a picture or a page shows. Functions that return false have complained. */
#ifndef TOOLS_VIEWS_SLICES_H
#define TOOLS_VIEWS_SLICES_H

#include <stdbool.h>

#include <pirouette/cspace.h>
#include <pirouette/pirouette.h>

struct slices {
    const char *path; /* the caller's */
    pir_cspace *file;
    pir_cspace_info info;
    uint64_t first, every, count; /* which are shown: first, first + every, …; count of them */
    uint32_t pairs;               /* pairs of a robot's piece and an obstacle's */
};

/* Opens a file, to show every `every`-th slice; 0 stands for as few as needed to show at most `most`. */
bool slices_open(struct slices *slices, const char *path, uint64_t every, uint64_t most);

/* A zeroed one is accepted. */
void slices_close(struct slices *slices);

/* The slice's number in the file, of one that is shown. */
uint64_t slices_number(const struct slices *slices, uint64_t shown);

pir_quat slices_rotation(const struct slices *slices, uint64_t shown);

/* The mesh of the difference of pair `pair`, which counts through the obstacles of the first robot's piece first; to be
   destroyed. NULL after a complaint. */
pir_mesh *slices_mesh(const struct slices *slices, uint64_t shown, uint32_t pair, pir_precision precision);

/* A ball about `middle` that holds all differences of all rotations; the radius is above 0. */
void slices_ball(const struct slices *slices, pir_vec3 *ret_middle, double *ret_radius);

#endif

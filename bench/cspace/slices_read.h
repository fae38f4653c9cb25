/* SPDX-License-Identifier: MIT */
/* Slices read from files. */
#ifndef BENCH_SLICES_READ_H
#define BENCH_SLICES_READ_H

#include "results.h"
#include "slices_scene.h"

/* A job of one thread for the scene, which writes to `path`; 0: every 64th slice of a unit is whole. */
pir_cspace_job *slices_job(const struct slices_bodies *bodies, const char *path, uint32_t slices_per_key);

/*
 * Writes slices_read.csv: for some scenes and distances between slices that are written whole, the bytes of a slice,
 * and what it takes to open the file, to read a slice alone, at random places of the file, and to read the next one.
 */
void slices_read_all(const struct results *results);

#endif

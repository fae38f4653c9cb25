/* SPDX-License-Identifier: MIT */
/*
 * Rebuilds by the walk as it was before pairs by need (commit dec4918), from a shared library of that time, which
 * -Dpeers_dir names. It is loaded beside this one, in a space of names of its own.
 */
#ifndef BENCH_OLDER_WALK_H
#define BENCH_OLDER_WALK_H

struct older_walk;

/* Bodies as of slices_scene.h; NULL where there is no such library. */
struct older_walk *older_walk_new(const char *p, const char *q, const double rotation[4]);
void older_walk_free(struct older_walk *walk);

/* Makes the pairing of the difference at another rotation, from nothing. */
void older_walk_rebuild(struct older_walk *walk, const double rotation[4]);

#endif

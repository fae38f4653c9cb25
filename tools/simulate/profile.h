/* SPDX-License-Identifier: MIT */
/* The work of all updates of a run, part by part: its mean, 99th percentile and worst. */
#ifndef TOOLS_SIMULATE_PROFILE_H
#define TOOLS_SIMULATE_PROFILE_H

#include <stdbool.h>
#include <stdio.h>

#include <pirouette/scene.h>

/* As many as the table in profile.c has. */
#define PROFILE_MEASURES 20

/* Begins zeroed. */
struct profile {
    double *value[PROFILE_MEASURES]; /* by updates */
    size_t count, room;
    bool timed; /* whether there is a clock */
};

void profile_clear(struct profile *profile);

/* Adds the last update of a scene. False where memory runs out. */
bool profile_add(struct profile *profile, const pir_scene *scene);

/* Prints an array of JSON: of each part name, unit, mean, 99th percentile, worst. False where memory runs out. */
bool profile_print(FILE *file, const struct profile *profile);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Files of slice --critical: critical maps of a full turn (critical.h), one for each pair of pieces, one after the
 * other: those of the robot's first piece with all obstacles, then those of the next piece.
 */
#ifndef TOOLS_CRITICAL_H
#define TOOLS_CRITICAL_H

#include <stdbool.h>

#include "args.h"

/* --- critical_slice.c --- */

/* Runs slice --critical; what the command ends with. */
int critical_slice(const struct args *args);

/* --- critical_pose.c --- */

/* Whether a file begins as such a file does. */
bool critical_is_file(const char *path);

/* Runs configuration on such a file; what the command ends with. */
int critical_configuration(const struct args *args);

#endif

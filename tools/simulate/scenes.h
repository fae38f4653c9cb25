/* SPDX-License-Identifier: MIT */
/* The scenes that the command knows by name: those of examples/scenes that need no other file. */
#ifndef TOOLS_SIMULATE_SCENES_H
#define TOOLS_SIMULATE_SCENES_H

#include <stdbool.h>

#include <stage.h>

/* Whether a path is `scene:NAME`. */
bool scenes_has_name(const char *path);

/* Reads `scene:NAME`; false after a line in `why`, as of stage_read. */
bool scenes_read(const char *path, struct stage *ret_stage, char why[STAGE_WHY]);

/* Prints the names, each with its title and what there is to see. */
bool scenes_list(bool as_json);

#endif

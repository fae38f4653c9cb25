/* SPDX-License-Identifier: MIT */
/* The subcommands. Each runs with its arguments and returns how the command ends: EXIT_BAD_INPUT after a complaint. */
#ifndef TOOLS_CMD_H
#define TOOLS_CMD_H

#include "args.h"

int cmd_cgm(const struct args *args);
int cmd_configuration(const struct args *args);
int cmd_decompose(const struct args *args);
int cmd_distance(const struct args *args);
int cmd_help(const struct args *args);
int cmd_info(const struct args *args);
int cmd_query(const struct args *args);
int cmd_replay(const struct args *args);
int cmd_shape(const struct args *args);
int cmd_simplify(const struct args *args);
int cmd_simulate(const struct args *args);
int cmd_slice(const struct args *args);
int cmd_sum(const struct args *args);
int cmd_track(const struct args *args);
int cmd_view(const struct args *args);

#endif

/* SPDX-License-Identifier: MIT */
/* A subcommand: `SUBCOMMAND(sum) {` defines the function cmd_sum, which the table in command_table.c names. */
#ifndef TOOLS_CMD_H
#define TOOLS_CMD_H

#include "args.h"

/* The function runs with its arguments, `args`, and returns how the command ends: EXIT_BAD_INPUT after a complaint. */
#define SUBCOMMAND(name)                                                                                               \
    int cmd_##name(const struct args *args);                                                                           \
    int cmd_##name(const struct args *args)

#endif

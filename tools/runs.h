/* SPDX-License-Identifier: MIT */
/*
 * What runs each subcommand. There are two programs of one table of subcommands. `pirouette` has those that the core
 * library serves, and starts in a millisecond. `pirouette-slices` has all: what reads and makes slices needs HDF5 and
 * MPI, whose own libraries take tens of milliseconds to load. The first hands its arguments over to the second where it
 * has no run (hand_over.h).
 */
#ifndef TOOLS_RUNS_H
#define TOOLS_RUNS_H

#include "args.h"
#include "command.h"

/* By the place in command_table; NULL: the other program has it. */
extern int (*const command_runs[COMMAND_COUNT])(const struct args *args);

#endif

/* SPDX-License-Identifier: MIT */
/* The subcommand `plan` as one of several processes. */
#ifndef TOOLS_PLAN_MOTIONS_H
#define TOOLS_PLAN_MOTIONS_H

#include <pirouette/plan.h>

#include "args.h"

/* Runs the subcommand: how it ends. Processes but the first say nothing and write no file. */
int plan_by(const struct args *args, const pir_plan_ranks *ranks);

#endif

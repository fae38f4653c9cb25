/* SPDX-License-Identifier: MIT */
/* The subcommands of `pirouette-slices`: all. */
#include "runs.h"

#include "cmd.h"

int (*const command_runs[COMMAND_COUNT])(const struct args *) = {
    [COMMAND_INFO] = cmd_info,         [COMMAND_CGM] = cmd_cgm,
    [COMMAND_SHAPE] = cmd_shape,       [COMMAND_SUM] = cmd_sum,
    [COMMAND_TRACK] = cmd_track,       [COMMAND_QUERY] = cmd_query,
    [COMMAND_SLICE] = cmd_slice,       [COMMAND_CONFIGURATION] = cmd_configuration,
    [COMMAND_VIEW] = cmd_view,         [COMMAND_DECOMPOSE] = cmd_decompose,
    [COMMAND_SIMPLIFY] = cmd_simplify, [COMMAND_SIMULATE] = cmd_simulate,
    [COMMAND_REPLAY] = cmd_replay,     [COMMAND_HELP] = cmd_help,
    [COMMAND_DISTANCE] = cmd_distance,
};

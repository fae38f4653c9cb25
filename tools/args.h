/* SPDX-License-Identifier: MIT */
/*
 * The arguments of a subcommand: positional ones in order, options by name, values checked as they are read.
 *
 * An option's value follows as `--opt value` or `--opt=value` and may begin with a minus sign either way. `--` ends the
 * options. An option is given once. Every function that returns false has complained on stderr.
 */
#ifndef TOOLS_ARGS_H
#define TOOLS_ARGS_H

#include <stdbool.h>
#include <stdint.h>

#include "command.h"

#define ARGS_OPTIONS_MAX    32
#define ARGS_POSITIONAL_MAX 4096

struct args {
    const struct command *command;
    const char *positional[ARGS_POSITIONAL_MAX];
    size_t positional_count;
    /* By row of the command's table: "" for an option without value, NULL when absent. */
    const char *value[ARGS_OPTIONS_MAX];
    bool help; /* --help was given; what stands after it was not read */
};

/* Sorts `argv`, what stands after the subcommand's name, into `args`. */
bool args_parse(const struct command *command, int argc, char *const *argv, struct args *args);

/* The value of option `name`, one of the command's table, or NULL when it was not given. */
const char *args_value(const struct args *args, const char *name);

bool args_has(const struct args *args, const char *name);

/* A whole number between `least` and `most`; *number stays when the option was not given. */
bool args_count(const struct args *args, const char *name, uint64_t least, uint64_t most, uint64_t *number);

/* Exactly `count` finite numbers between commas; `numbers` stay when the option was not given. */
bool args_numbers(const struct args *args, const char *name, size_t count, double *numbers);

/* One of the words in `choices`, which ends with NULL; *choice, an index, stays when the option was not given. */
bool args_choice(const struct args *args, const char *name, const char *const *choices, int *choice);

#endif

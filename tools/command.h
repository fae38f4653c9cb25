/* SPDX-License-Identifier: MIT */
/*
 * What a subcommand is: a name, what it takes, how it runs. main.c holds the table of all; each stands in its own cmd_*.c.
 */
#ifndef TOOLS_COMMAND_H
#define TOOLS_COMMAND_H

#include <stddef.h>

struct args;

/* How the command ends. */
enum { EXIT_DONE = 0, EXIT_CHECK_FAILED = 1, EXIT_BAD_INPUT = 2 };

struct option {
    const char *name;  /* with its dashes; NULL ends a table */
    const char *value; /* how help shows its value; NULL for an option that takes none */
    const char *help;
};

/* Rows that every table ends with. */
#define COMMON_OPTIONS                                                                                                 \
    {"--json", NULL, "print one JSON object"}, {"--help", NULL, "print this help"}, {                                  \
        NULL, NULL, NULL                                                                                               \
    }

struct command {
    const char *name;
    const char *positional[3]; /* names of its positional arguments, then NULL */
    size_t required;           /* how many of them must be there */
    const char *summary;       /* one line */
    const char *details;       /* more lines for its help; NULL for none */
    const struct option *options;
    int (*run)(const struct args *args);
};

extern const struct command cmd_cgm, cmd_info, cmd_query, cmd_shape, cmd_sum, cmd_track;

#endif

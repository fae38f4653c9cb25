/* SPDX-License-Identifier: MIT */
/*
 * A subcommand: its name, its arguments, its text. All subcommands stand in one table, command_table.c. The parser
 * of arguments, `--help`, the manual pages and the completion of shells read that table, so all of them agree. A
 * subcommand runs in a cmd_*.c of its own.
 */
#ifndef TOOLS_COMMAND_H
#define TOOLS_COMMAND_H

#include <stdbool.h>
#include <stddef.h>

/* How the command ends. */
enum { EXIT_DONE = 0, EXIT_CHECK_FAILED = 1, EXIT_BAD_INPUT = 2 };

struct option {
    const char *name; /* with its dashes, or several names with ", " between them; NULL ends a list of options */
    /* How help shows its value, "a|b" where it is one of two words; NULL for an option that takes none. */
    const char *value;
    const char *help;
};

struct example {
    const char *line; /* what follows `pirouette`; NULL ends a list of examples */
    const char *what;
};

/* The most examples that a subcommand has, and the end of their list. */
#define COMMAND_EXAMPLES 5

struct args;
typedef int command_run(const struct args *args);

struct command {
    const char *name;
    command_run *run;          /* NULL: the other program has it */
    bool has_ranks;            /* whether the other program has it for ranks of MPI */
    const char *positional[3]; /* names of its positional arguments, then NULL; the last may end in "..." and repeat */
    size_t required;           /* how many of them must be there */
    const char *summary;       /* one line */
    const char *details;       /* one paragraph for its help; NULL for none */
    const struct option *options;
    struct example examples[COMMAND_EXAMPLES];
};

/* The subcommands in the order in which help lists them; a row without a name ends them. */
extern const struct command command_table[];

/* The options that stand before a subcommand. */
extern const struct option command_options[];

/* Texts on the command: its purpose, its models, its exit status. */
extern const char command_about[], command_models[], command_exit[];

/* Whether a positional argument of this name may be given more than once. */
bool positional_repeats(const char *name);

/* NULL when no subcommand has this name. */
const struct command *command_find(const char *name);

/* Whether `length` characters of `text` are one of the option's names. */
bool option_is(const struct option *option, const char *text, size_t length);

#endif

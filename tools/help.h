/* SPDX-License-Identifier: MIT */
/* The help of the command and of its subcommands on stdout, from the table in command.h. */
#ifndef TOOLS_HELP_H
#define TOOLS_HELP_H

#include "command.h"

/* Prints the general help, with a line for each subcommand. */
void help_print(void);

/* Prints the help of one subcommand. */
void help_print_command(const struct command *command);

#endif

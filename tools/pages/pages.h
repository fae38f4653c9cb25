/* SPDX-License-Identifier: MIT */
/*
 * The pages that are made from the table of subcommands while the project is built: manual pages and the completion of
 * bash. A small program writes them. It is built for the building machine, from command_table.c alone.
 */
#ifndef TOOLS_PAGES_H
#define TOOLS_PAGES_H

#include <stdio.h>

#include "../command.h"

/* The kind of word of a positional argument: "model", "shape" (the name of a built-in one), "subcommand" or "file". */
const char *page_argument_kind(const char *name);

/* pirouette.1, or pirouette-NAME.1 where a subcommand is given. */
void page_write_manual(FILE *file, const struct command *command);

/* The script that bash reads, with its fixed part from the file `script`; false when that cannot be read. */
bool page_write_completion(FILE *file, const char *script);

#endif

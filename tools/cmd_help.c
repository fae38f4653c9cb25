/* SPDX-License-Identifier: MIT */
/* help SUBCOMMAND prints what SUBCOMMAND --help does. */
#include "cmd.h"
#include "command.h"
#include "help.h"
#include "message.h"

SUBCOMMAND(help) {
    const char *name = args->positional_count > 0 ? args->positional[0] : NULL;
    const struct command *command = name ? command_find(name) : NULL;
    if (name && !command)
        return complain("help: unknown subcommand '%s'; see pirouette --help", name);
    if (command)
        help_print_command(command);
    else
        help_print();
    return EXIT_DONE;
}

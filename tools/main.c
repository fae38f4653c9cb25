/* SPDX-License-Identifier: MIT */
/*
 * The `pirouette` command: finds the subcommand in the table of command.h and hands it its arguments. What needs slices
 * runs in another program (command_table.c).
 */
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <pirouette/version.h>

#include "args.h"
#include "command.h"
#include "hand_over.h"
#include "help.h"
#include "interrupt.h"
#include "launched.h"
#include "message.h"

static int run_command(const struct command *command, int argc, char *const *argv) {
    struct args args;
    if (!args_parse(command, argc, argv, &args))
        return EXIT_BAD_INPUT;
    if (args.help) {
        help_print_command(command);
        return EXIT_DONE;
    }
    return command->run(&args);
}

/* Whether `text` is the option of this name, which stands before a subcommand. */
static bool is_option(const char *text, const char *name) {
    for (const struct option *option = command_options; option->name; option++)
        if (option_is(option, text, strlen(text)))
            return option_is(option, name, strlen(name));
    return false;
}

static int run(int argc, char *const *argv) {
    if (argc < 2)
        return complain("no subcommand; usage: pirouette SUBCOMMAND [ARGUMENT...], see pirouette --help");
    if (is_option(argv[1], "--help")) {
        help_print();
        return EXIT_DONE;
    }
    if (is_option(argv[1], "--version")) {
        say("pirouette %s\n", pir_version());
        return EXIT_DONE;
    }
    const struct command *command = command_find(argv[1]);
    if (!command)
        return complain("unknown %s '%s'; see pirouette --help", argv[1][0] == '-' ? "option" : "subcommand", argv[1]);
    if (!command->run || (command->has_ranks && launched_by_mpi()))
        return hand_over(argv);
    return run_command(command, argc - 2, argv + 2);
}

/* Sees to it that no file that is opened gets the number of a standard stream that was closed before the start. */
static void hold_standard_streams(void) {
    for (int stream = 0; stream < 3; stream++)
        if (fcntl(stream, F_GETFD) < 0)
            open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY); // so that what uses it fails, as before
}

int main(int argc, char **argv) {
    static char printed[1 << 16], complained[1 << 15];
    hold_standard_streams();
    // help, which is shorter, is then written at once, so that a failure is told with its reason
    if (!isatty(STDOUT_FILENO))
        setvbuf(stdout, printed, _IOFBF, sizeof printed);
    // a line is written at once, not by characters, between which what other processes say would come
    setvbuf(stderr, complained, _IOLBF, sizeof complained);
    // A reader that goes away is a failed write, to be told like any other; so is a limit on the size of files.
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    interrupt_watch();
    int status = run(argc, argv);
    if (status != EXIT_BAD_INPUT && !stdout_arrived())
        status = EXIT_BAD_INPUT;
    interrupt_end();
    return status;
}

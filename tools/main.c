/* SPDX-License-Identifier: MIT */
/*
 * The `pirouette` command: finds the subcommand in a table and hands it its arguments. What a subcommand is stands in
 * command.h.
 */
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include <pirouette/version.h>

#include "args.h"
#include "command.h"
#include "message.h"

static const struct command *const commands[] = {&cmd_info, &cmd_cgm, &cmd_shape, &cmd_sum, &cmd_track, &cmd_query};

#define COMMAND_COUNT (sizeof commands / sizeof commands[0])

static const struct command *find_command(const char *name) {
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(commands[i]->name, name) == 0)
            return commands[i];
    return NULL;
}

static void print_help(void) {
    printf("usage: pirouette SUBCOMMAND [ARGUMENT...]\n\n"
           "Exact Minkowski sums of convex polyhedra, kept up to date while one of them rotates.\n\nsubcommands:\n");
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        printf("  %-8s %s\n", commands[i]->name, commands[i]->summary);
    printf("\n"
           "pirouette SUBCOMMAND --help tells more, pirouette --version the version. A MODEL, P or Q is a file (.off, "
           ".obj,\n"
           ".stl, .ply) or shape:NAME for a built-in one; its convex hull is taken.\n"
           "Exit status: 0 done; 1 a check that was asked for failed; 2 bad usage or bad input, told in one line on "
           "stderr.\n");
}

static int run_command(const struct command *command, int argc, char *const *argv) {
    struct args args;
    if (!args_parse(command, argc, argv, &args))
        return EXIT_BAD_INPUT;
    if (args.help) {
        args_print_help(command);
        return EXIT_DONE;
    }
    return command->run(&args);
}

static int run(int argc, char *const *argv) {
    if (argc < 2)
        return complain("no subcommand; usage: pirouette SUBCOMMAND [ARGUMENT...], see pirouette --help");
    if (strcmp(argv[1], "--help") == 0) {
        print_help();
        return EXIT_DONE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("pirouette %s\n", pir_version());
        return EXIT_DONE;
    }
    const struct command *command = find_command(argv[1]);
    if (!command)
        return complain("unknown %s '%s'; see pirouette --help", argv[1][0] == '-' ? "option" : "subcommand", argv[1]);
    return run_command(command, argc - 2, argv + 2);
}

int main(int argc, char **argv) {
    // A reader that goes away is a failed write, to be told like any other.
    signal(SIGPIPE, SIG_IGN);
    int status = run(argc, argv);
    if (status != EXIT_BAD_INPUT && !stdout_arrived())
        status = EXIT_BAD_INPUT;
    return status;
}

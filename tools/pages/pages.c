/* SPDX-License-Identifier: MIT */
/*
 * write_pages SCRIPT FILE...: writes each FILE by what its name asks for: `pirouette.1`, `pirouette-SUBCOMMAND.1`, or
 * `pirouette`, the completion, which ends with SCRIPT. A page of an unknown subcommand, and a subcommand without a
 * page, end the build.
 */
#include "pages.h"

#include <stdlib.h>
#include <string.h>

static const char *base_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Whether the subcommand's manual page has this name. */
static bool is_page_of(const struct command *command, const char *name) {
    char page[64];
    snprintf(page, sizeof page, "pirouette-%s.1", command->name);
    return strcmp(page, name) == 0;
}

/* The subcommand whose manual page has this name. */
static const struct command *command_of_page(const char *name) {
    for (const struct command *command = command_table; command->name; command++)
        if (is_page_of(command, name))
            return command;
    return NULL;
}

static int fail(const char *what, const char *which) {
    fprintf(stderr, "write_pages: %s %s\n", what, which);
    return EXIT_FAILURE;
}

static int write_page(const char *path, const char *script) {
    const char *name = base_name(path);
    bool general = strcmp(name, "pirouette.1") == 0, completion = strcmp(name, "pirouette") == 0;
    const struct command *command = command_of_page(name);
    if (!general && !completion && !command)
        return fail("no subcommand has the page", name);
    FILE *file = fopen(path, "w");
    if (!file)
        return fail("cannot open", path);
    bool written = true;
    if (completion)
        written = page_write_completion(file, script);
    else
        page_write_manual(file, command);
    written = !ferror(file) && written;
    if (fclose(file) != 0 || !written)
        return fail("cannot write", path);
    return EXIT_SUCCESS;
}

int main(int argc, char **argv) {
    for (int i = 2; i < argc; i++)
        if (write_page(argv[i], argv[1]) != EXIT_SUCCESS)
            return EXIT_FAILURE;
    for (const struct command *command = command_table; command->name; command++) {
        int i = 2;
        while (i < argc && !is_page_of(command, base_name(argv[i])))
            i++;
        if (i == argc)
            return fail("tools/meson.build asks for no page of the subcommand", command->name);
    }
    return EXIT_SUCCESS;
}

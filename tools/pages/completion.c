/* SPDX-License-Identifier: MIT */
/*
 * The completion of bash: two functions from the table, which say what a subcommand takes and what an option's value
 * is; then the fixed part of the script, completion.bash.
 */
#include "pages.h"

#include <string.h>

const char *page_argument_kind(const char *name) {
    static const char *const kinds[][2] = {
        {"MODEL", "model"},           {"P", "model"},     {"Q", "model"},           {"NAME", "shape"},
        {"SUBCOMMAND", "subcommand"}, {"ROBOT", "model"}, {"OBSTACLE...", "model"}, {"PIECES", "model"},
    };
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (strcmp(kinds[i][0], name) == 0)
            return kinds[i][1];
    return "file";
}

/* Prints the kind of an option's value: a file, a folder, one of the words in small letters, or else a text. */
static void print_value_kind(FILE *file, const char *value) {
    if (strncmp(value, "FILE", 4) == 0 || strncmp(value, "DIR", 3) == 0) {
        fputs(*value == 'F' ? "file" : "folder", file);
        return;
    }
    bool words = false;
    while (*value) {
        size_t length = strcspn(value, "|");
        if (strspn(value, "abcdefghijklmnopqrstuvwxyz-") == length) {
            fprintf(file, "%s %.*s", words ? "" : "words", (int)length, value);
            words = true;
        }
        value += length;
        value += strspn(value, "|");
    }
    if (!words)
        fputs("text", file);
}

/* The option's names between blanks; or, for a `case` of a subcommand and an option, each after the subcommand's. */
static void print_names(FILE *file, const struct option *option, const char *subcommand) {
    for (const char *name = option->name; *name;) {
        int length = (int)strcspn(name, ",");
        if (subcommand)
            fprintf(file, "%s'%s %.*s'", name == option->name ? "" : " | ", subcommand, length, name);
        else
            fprintf(file, "%s%.*s", name == option->name ? "" : " ", length, name);
        name += length;
        name += strspn(name, ", ");
    }
}

static void print_options(FILE *file, const struct option *options) {
    fputs(" options=(", file);
    for (const struct option *option = options; option->name; option++) {
        fputs(option == options ? "" : " ", file);
        print_names(file, option, NULL);
    }
    fputc(')', file);
}

/* _pirouette_takes sets `options` and `arguments`, the kinds of positional ones, for the subcommand $1. */
static void print_takes(FILE *file) {
    fputs("_pirouette_takes() {\n    options=() arguments=()\n    case $1 in\n    '')", file);
    print_options(file, command_options);
    fputs(" ;;\n", file);
    for (const struct command *command = command_table; command->name; command++) {
        fprintf(file, "    %s)", command->name);
        print_options(file, command->options);
        fputs(" arguments=(", file);
        for (size_t k = 0; command->positional[k]; k++)
            fprintf(file, "%s%s", k ? " " : "", page_argument_kind(command->positional[k]));
        fputs(") ;;\n", file);
    }
    fputs("    esac\n}\n\n", file);
}

/* _pirouette_value sets `value` to the kind of value of the option $2 of subcommand $1, to
   nothing where it has none. */
static void print_values(FILE *file) {
    fputs("_pirouette_value() {\n    value=\n    case \"$1 $2\" in\n", file);
    for (const struct command *command = command_table; command->name; command++) {
        for (const struct option *option = command->options; option->name; option++) {
            if (!option->value)
                continue;
            fputs("    ", file);
            print_names(file, option, command->name);
            fputs(") value='", file);
            print_value_kind(file, option->value);
            fputs("' ;;\n", file);
        }
    }
    fputs("    esac\n}\n\n", file);
}

/* Copies a whole file; false when it cannot be read. */
static bool copy_file(FILE *to, const char *path) {
    FILE *from = fopen(path, "r");
    if (!from)
        return false;
    for (int c = fgetc(from); c != EOF; c = fgetc(from))
        fputc(c, to);
    bool whole = !ferror(from);
    fclose(from);
    return whole;
}

bool page_write_completion(FILE *file, const char *script) {
    fputs("# shellcheck shell=bash disable=SC2034\n"
          "# The completion of bash for pirouette, made from the table that `pirouette help` prints.\n\n"
          "_pirouette_subcommands='",
          file);
    for (const struct command *command = command_table; command->name; command++)
        fprintf(file, "%s%s", command > command_table ? " " : "", command->name);
    fputs("'\n\n", file);
    print_takes(file);
    print_values(file);
    return copy_file(file, script);
}

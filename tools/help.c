/* SPDX-License-Identifier: MIT */
/* Help: the table's text in lines of at most 80 columns, as terminals are at least. */
#include "help.h"

#include <stdio.h>
#include <string.h>

#define COLUMNS 80
/* Where the text of an option and of a subcommand begins. */
#define OPTION_INDENT  28
#define SUMMARY_INDENT 17

/* Prints the words of a text, the cursor being at column `at`; lines after the first begin at column `indent`. */
static void print_wrapped(const char *text, size_t at, size_t indent) {
    bool first = true;
    while (*text) {
        size_t length = strcspn(text, " ");
        if (!first && at + 1 + length > COLUMNS) {
            printf("\n%*s", (int)indent, "");
            at = indent;
        } else if (!first) {
            putchar(' ');
            at++;
        }
        printf("%.*s", (int)length, text);
        at += length;
        text += length;
        text += strspn(text, " ");
        first = false;
    }
    putchar('\n');
}

/* `left`, then the text in the column at `indent`; on the next line where `left` reaches into it. */
static void print_entry(const char *left, const char *text, size_t indent) {
    size_t at = (size_t)printf("  %s", left);
    if (at + 1 > indent) {
        putchar('\n');
        at = 0;
    }
    printf("%*s", (int)(indent - at), "");
    print_wrapped(text, indent, indent);
}

static void print_options(const struct option *options) {
    printf("\noptions:\n");
    for (const struct option *option = options; option->name; option++) {
        char left[64];
        snprintf(left, sizeof left, "%s%s%s", option->name, option->value ? " " : "",
                 option->value ? option->value : "");
        print_entry(left, option->help, OPTION_INDENT);
    }
}

void help_print(void) {
    printf("usage: pirouette SUBCOMMAND [ARGUMENT...]\n\n");
    print_wrapped(command_about, 0, 0);
    printf("\nsubcommands:\n");
    for (const struct command *command = command_table; command->name; command++)
        print_entry(command->name, command->summary, SUMMARY_INDENT);
    print_options(command_options);
    printf("\npirouette help SUBCOMMAND tells more.\n\n");
    print_wrapped(command_models, 0, 0);
    putchar('\n');
    print_wrapped(command_exit, (size_t)printf("Exit status: "), 0);
}

void help_print_command(const struct command *command) {
    printf("usage: pirouette %s", command->name);
    for (size_t i = 0; command->positional[i]; i++)
        printf(i < command->required ? " %s" : " [%s]", command->positional[i]);
    printf(" [OPTION...]\n\n");
    print_wrapped(command->summary, 0, 0);
    if (command->details) {
        putchar('\n');
        print_wrapped(command->details, 0, 0);
    }
    print_options(command->options);
    printf("\nexamples:\n");
    for (const struct example *example = command->examples; example->line; example++) {
        printf("  pirouette %s\n      ", example->line);
        print_wrapped(example->what, 6, 6);
    }
}

/* SPDX-License-Identifier: MIT */
/* Manual pages in the man macros of roff. */
#include "pages.h"

#include <ctype.h>
#include <string.h>

#include <pirouette/version.h>

/* Characters that mean something else to roff, and how it is told to show them as they stand. */
static const struct {
    char plain;
    const char *roff;
} escapes[] = {{'\\', "\\e"}, {'-', "\\-"}, {'\'', "\\(aq"}, {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"}};

/* Prints a text so that roff shows it as it stands. A dot at the beginning would be a request. */
static void print_text(FILE *file, const char *text) {
    if (*text == '.')
        fputs("\\&", file);
    for (; *text; text++) {
        const char *roff = NULL;
        for (size_t i = 0; i < sizeof escapes / sizeof escapes[0]; i++)
            if (escapes[i].plain == *text)
                roff = escapes[i].roff;
        if (roff)
            fputs(roff, file);
        else
            fputc(*text, file);
    }
}

/* A text between a font's request and the return to the plain font: 'B' bold, 'I' italic. */
static void print_in_font(FILE *file, char font, const char *text) {
    fprintf(file, "\\f%c", font);
    print_text(file, text);
    fputs("\\fR", file);
}

static void print_paragraph(FILE *file, const char *text) {
    fputs(".PP\n", file);
    print_text(file, text);
    fputc('\n', file);
}

/* The heading, and the line from which `man -k` finds the page. */
static void print_head(FILE *file, const struct command *command) {
    char name[64], title[64];
    snprintf(name, sizeof name, "pirouette%s%s", command ? "-" : "", command ? command->name : "");
    size_t length = strlen(name);
    for (size_t i = 0; i <= length; i++)
        title[i] = (char)toupper((unsigned char)name[i]);
    fputs(".TH ", file);
    print_text(file, title);
    fprintf(file, " 1 \"\" \"pirouette %s\" \"User Commands\"\n.SH NAME\n", PIR_VERSION_STRING);
    print_text(file, name);
    fputs(" \\- ", file);
    print_text(file, command ? command->summary : "exact Minkowski sums of rotating convex polyhedra");
    fputs("\n.SH SYNOPSIS\n", file);
}

static void print_synopsis(FILE *file, const struct command *command) {
    print_in_font(file, 'B', "pirouette ");
    print_in_font(file, 'B', command->name);
    for (size_t i = 0; command->positional[i]; i++) {
        fputs(i < command->required ? " " : " [", file);
        print_in_font(file, 'I', command->positional[i]);
        fputs(i < command->required ? "" : "]", file);
    }
    fputs(" [\\fIOPTION\\fR...]\n", file);
}

static void print_options(FILE *file, const struct option *options) {
    fputs(".SH OPTIONS\n", file);
    for (const struct option *option = options; option->name; option++) {
        fputs(".TP\n", file);
        print_in_font(file, 'B', option->name);
        if (option->value) {
            fputc(' ', file);
            print_in_font(file, 'I', option->value);
        }
        fputc('\n', file);
        print_text(file, option->help);
        fputc('\n', file);
    }
}

static void print_examples(FILE *file, const struct command *command) {
    fputs(".SH EXAMPLES\n", file);
    for (const struct example *example = command->examples; example->line; example++) {
        fputs(".PP\n.nf\n", file);
        print_in_font(file, 'B', "pirouette ");
        print_in_font(file, 'B', example->line);
        fputs("\n.fi\n.RS 4\n", file);
        print_text(file, example->what);
        fputs("\n.RE\n", file);
    }
}

static void print_exit_status(FILE *file) {
    fputs(".SH EXIT STATUS\n", file);
    print_text(file, command_exit);
    fputc('\n', file);
}

static void write_general(FILE *file) {
    print_head(file, NULL);
    fputs("\\fBpirouette\\fR \\fISUBCOMMAND\\fR [\\fIARGUMENT\\fR...]\n.SH DESCRIPTION\n", file);
    print_text(file, command_about);
    fputc('\n', file);
    print_paragraph(file, command_models);
    fputs(".SH SUBCOMMANDS\n", file);
    for (const struct command *command = command_table; command->name; command++) {
        fputs(".TP\n\\fBpirouette\\-", file);
        print_text(file, command->name);
        fputs("\\fR(1)\n", file);
        print_text(file, command->summary);
        fputc('\n', file);
    }
    print_options(file, command_options);
    print_exit_status(file);
}

void page_write_manual(FILE *file, const struct command *command) {
    if (!command) {
        write_general(file);
        return;
    }
    print_head(file, command);
    print_synopsis(file, command);
    fputs(".SH DESCRIPTION\n", file);
    print_text(file, command->details ? command->details : command->summary);
    fputc('\n', file);
    if (command->positional[0] && strcmp(page_argument_kind(command->positional[0]), "model") == 0)
        print_paragraph(file, command_models);
    print_options(file, command->options);
    print_examples(file, command);
    print_exit_status(file);
    fputs(".SH SEE ALSO\n\\fBpirouette\\fR(1)\n", file);
}

/* SPDX-License-Identifier: MIT */
/* Messages: lines on standard output, and the one line on stderr that says what went wrong, where and why. */
#ifndef TOOLS_MESSAGE_H
#define TOOLS_MESSAGE_H

#include <stdbool.h>

#include <pirouette/base.h>

#include "command.h"

/* Prints `pirouette: ` and the text as one line on stderr, whatever characters went into it; returns EXIT_BAD_INPUT. */
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
int complain(const char *format, ...);

/* Complains of what a library call told: the report's text, or `where` and the status in words when it left none. */
int complain_status(const char *where, pir_status status, const pir_report *report);

/*
 * Prints on standard output, whatever characters went into the text: one line where the format ends in a newline, else
 * part of a line. All that subcommands tell in words goes through here.
 */
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
void say(const char *format, ...);

/* Prints a text on standard output as it is. */
void put_out(const char *text);

/* Flushes stdout; complains and returns false when what was printed did not arrive. */
bool stdout_arrived(void);

#endif

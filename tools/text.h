/* SPDX-License-Identifier: MIT */
/* Numbers and names as people and other programs read them. A name may hold any bytes but zero. */
#ifndef TOOLS_TEXT_H
#define TOOLS_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define TEXT_NUMBER 32

/* The bytes of the character at `text` in UTF-8; 0 where none is there, as at the end of the text. */
size_t text_character(const char *text);

/* Room for what text_shown gives. */
#define TEXT_SHOWN 24

/*
 * The character at *text as people are shown it, and moves on: as it is where it can be seen and leaves the order of
 * what is round it alone, else its bytes, each as \xNN. False at the end.
 */
bool text_shown(const char **text, char ret_shown[TEXT_SHOWN]);

/* Prints a text as people are shown it into a file of XML, between two tags. */
void text_print_xml(FILE *file, const char *text);

/*
 * A double with the fewest of 15 to 17 digits that read back as itself. One beyond all doubles is told in words, in
 * which no number stands alone.
 */
void text_double(double value, char ret_text[TEXT_NUMBER]);

/* A time in nanoseconds with three digits and a unit that suits: ns, us, ms, s. */
void text_time(double nanoseconds, char ret_text[TEXT_NUMBER]);

/* Prints how far something extends along an axis, as a line of a table. */
void text_print_range(const char *axis, double low, double high);

#endif

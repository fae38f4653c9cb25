/* SPDX-License-Identifier: MIT */
/* Numbers as people and other programs read them. */
#ifndef TOOLS_TEXT_H
#define TOOLS_TEXT_H

#define TEXT_NUMBER 32

/* A finite double with the fewest of 15 to 17 digits that read back as itself. */
void text_double(double value, char ret_text[TEXT_NUMBER]);

/* A time in nanoseconds with three digits and a unit that suits: ns, us, ms, s. */
void text_time(double nanoseconds, char ret_text[TEXT_NUMBER]);

/* Prints how far something extends along an axis, as a line of a table. */
void text_print_range(const char *axis, double low, double high);

#endif

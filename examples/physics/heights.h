/* SPDX-License-Identifier: MIT */
/* Heights from files: a table of numbers, or a PNG in grey. */
#ifndef PHYSICS_HEIGHTS_H
#define PHYSICS_HEIGHTS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Rows of heights, the first at y = 0; NaN where there is none. */
struct heights {
    double *at;
    uint32_t columns, rows;
};

#define HEIGHTS_WHY 200

/*
 * Reads a table: a row a line, numbers apart by blanks or commas, `nan` for none. Empty lines and those that begin with
 * # are passed over; a field that is empty is refused. False after a line without the file's name was left in `why`; so
 * for the others.
 */
bool heights_read_table(FILE *file, struct heights *ret_heights, char why[HEIGHTS_WHY]);

/* Reads a PNG of 8 or 16 bits, whose black is 0 and white 1; a colour counts by its luminance. */
bool heights_read_png(FILE *file, struct heights *ret_heights, char why[HEIGHTS_WHY]);

/* Room for so many; false where memory runs out. */
bool heights_reserve(struct heights *heights, uint32_t columns, uint32_t rows);

void heights_clear(struct heights *heights);

#endif

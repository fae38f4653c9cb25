/* SPDX-License-Identifier: MIT */
/* A double in decimal. */
#ifndef PIR_POLYTOPE_WRITE_WRITE_NUMBER_H
#define PIR_POLYTOPE_WRITE_WRITE_NUMBER_H

#include <stdio.h>

/* The double with the fewest digits that read back as itself, then the character `end`. In the locale "C" alone. */
void pir_write_number(FILE *file, double value, char end);

#endif

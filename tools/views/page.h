/* SPDX-License-Identifier: MIT */
/* Slices as one page of HTML that needs nothing else: their differences, with a slider over the rotations. */
#ifndef TOOLS_VIEWS_PAGE_H
#define TOOLS_VIEWS_PAGE_H

#include <stdio.h>

#include "slices.h"

/* Writes the page to an open file. False after a complaint; whether what was written arrived is the caller's to see. */
bool page_write(FILE *file, const struct slices *slices);

#endif

/* SPDX-License-Identifier: MIT */
/* Pixels as a PNG file, by libpng. */
#ifndef TOOLS_PIXELS_PNG_FILE_H
#define TOOLS_PIXELS_PNG_FILE_H

#include <stdio.h>

#include "pixels/pixels.h"

/* False when out of memory or where libpng fails; the caller notices a stream in error. */
bool png_write(const struct pixels *pixels, FILE *stream);

#endif

/* SPDX-License-Identifier: MIT */
/* See png_file.h. libpng's simplified interface takes a whole picture in memory. */
#include "pixels/png_file.h"

#include <png.h>
#include <stdlib.h>

bool png_write(const struct pixels *pixels, FILE *stream) {
    uint8_t *bytes = malloc(3 * pixels->width * pixels->height);
    if (!bytes)
        return false;
    for (size_t row = 0; row < pixels->height; row++)
        pixels_row(pixels, row, bytes + 3 * pixels->width * row);
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)pixels->width,
                       .height = (png_uint_32)pixels->height,
                       .format = PNG_FORMAT_RGB};
    const bool good = png_image_write_to_stdio(&image, stream, 0, bytes, 0, NULL);
    png_image_free(&image);
    free(bytes);
    return good;
}

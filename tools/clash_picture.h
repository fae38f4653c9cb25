/* SPDX-License-Identifier: MIT */
/* The picture of a clash run: all solids as wires, those that clash in the colour of what they do. */
#ifndef TOOLS_CLASH_PICTURE_H
#define TOOLS_CLASH_PICTURE_H

#include <stdbool.h>
#include <stddef.h>

#include <pirouette/clash.h>

/* A solid that verdicts are on. */
struct clash_body {
    char *name;
    pir_solid *solid;
    pir_clash_body *body;
};

/* A verdict; `minor`: it is a clash within the tolerance that was given. */
struct clash_found {
    pir_clash_pair pair;
    pir_clash_verdict verdict;
    bool minor;
};

/* Writes an SVG file. False after a complaint. */
bool clash_picture_write(const char *path, const struct clash_body *bodies, size_t count,
                         const struct clash_found *found, size_t found_count);

#endif

/* SPDX-License-Identifier: MIT */
/* See file_name.h. */
#include "polytope/file/file_name.h"

#include <string.h>

/* The longest part of a path that a report repeats. */
#define SHORT_NAME 96

const char *pir_short_name(const char *path) {
    size_t length = strlen(path);
    return length > SHORT_NAME ? path + length - SHORT_NAME : path;
}

enum pir_file_type pir_file_type_named(const char *name) {
    static const char *const names[] = {
        [PIR_FILE_OFF] = "off", [PIR_FILE_OBJ] = "obj", [PIR_FILE_STL] = "stl",
        [PIR_FILE_PLY] = "ply", [PIR_FILE_SVG] = "svg",
    };
    char lower[4] = "";
    for (size_t i = 0; i < 3 && name[i]; i++)
        lower[i] = name[i] >= 'A' && name[i] <= 'Z' ? (char)(name[i] - 'A' + 'a') : name[i];
    for (size_t type = PIR_FILE_OFF; type < sizeof names / sizeof *names; type++)
        if (strlen(name) == 3 && strcmp(lower, names[type]) == 0)
            return (enum pir_file_type)type;
    return PIR_FILE_UNKNOWN;
}

enum pir_file_type pir_file_type_of(const char *path) {
    const char *dot = strrchr(path, '.');
    return dot ? pir_file_type_named(dot + 1) : PIR_FILE_UNKNOWN;
}

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

const char *pir_format_of(const char *path) {
    const char *dot = strrchr(path, '.');
    return dot ? dot + 1 : "";
}

bool pir_is_format(const char *format, const char *name) {
    size_t i = 0;
    while (name[i] && (format[i] >= 'A' && format[i] <= 'Z' ? format[i] - 'A' + 'a' : format[i]) == name[i])
        i++;
    return !name[i] && !format[i];
}

enum pir_file_type pir_file_type_named(const char *name) {
    static const char *const names[] = {
        [PIR_FILE_OFF] = "off", [PIR_FILE_OBJ] = "obj", [PIR_FILE_STL] = "stl",
        [PIR_FILE_PLY] = "ply", [PIR_FILE_SVG] = "svg",
    };
    for (size_t type = PIR_FILE_OFF; type < sizeof names / sizeof *names; type++)
        if (pir_is_format(name, names[type]))
            return (enum pir_file_type)type;
    return PIR_FILE_UNKNOWN;
}

enum pir_file_type pir_file_type_of(const char *path) {
    return pir_file_type_named(pir_format_of(path));
}

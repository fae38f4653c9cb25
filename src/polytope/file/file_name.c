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

enum pir_file_type pir_file_type_of(const char *path, char ret_ending[4]) {
    size_t length = strlen(path);
    ret_ending[0] = '\0';
    if (length < 4 || path[length - 4] != '.')
        return PIR_FILE_UNKNOWN;
    for (size_t i = 0; i < 4; i++) {
        char c = path[length - 3 + i];
        ret_ending[i] = c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
    }
    if (strcmp(ret_ending, "off") == 0)
        return PIR_FILE_OFF;
    if (strcmp(ret_ending, "svg") == 0)
        return PIR_FILE_SVG;
    if (strcmp(ret_ending, "obj") == 0 || strcmp(ret_ending, "stl") == 0 || strcmp(ret_ending, "ply") == 0)
        return PIR_FILE_ASSIMP;
    return PIR_FILE_UNKNOWN;
}

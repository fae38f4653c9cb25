/* SPDX-License-Identifier: MIT */
/* File names: the format by the ending, and the name in reports. */
#ifndef PIR_POLYTOPE_FILE_FILE_NAME_H
#define PIR_POLYTOPE_FILE_FILE_NAME_H

#include <stdbool.h>
#include <stddef.h>

/* The largest file or text that is read: 2 GiB. Below it, lines, vertices and facets all count in 32 bits. */
#define PIR_FILE_SIZE_MAX ((size_t)1 << 31)

/* Which writer a file has. */
enum pir_file_type { PIR_FILE_UNKNOWN, PIR_FILE_OFF, PIR_FILE_OBJ, PIR_FILE_STL, PIR_FILE_PLY, PIR_FILE_SVG };

/* The type of that name: "off", "obj", "stl", "ply" or "svg", in either case. */
enum pir_file_type pir_file_type_named(const char *name);

/* The ending of a path, without its dot; empty where there is none. */
const char *pir_format_of(const char *path);

/* Whether `format` is `name`, which is in small letters, in either case. */
bool pir_is_format(const char *format, const char *name);

/* The type by the ending of a path. */
enum pir_file_type pir_file_type_of(const char *path);

/* The last part of a path, short enough to leave room for what went wrong. */
const char *pir_short_name(const char *path);

#endif

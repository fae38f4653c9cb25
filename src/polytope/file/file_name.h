/* SPDX-License-Identifier: MIT */
/* File names: the format by the ending, and the name in reports. */
#ifndef PIR_POLYTOPE_FILE_FILE_NAME_H
#define PIR_POLYTOPE_FILE_FILE_NAME_H

#include <stddef.h>

/* The largest file or text that is read: 2 GiB. Below it, lines, vertices and facets all count in 32 bits. */
#define PIR_FILE_SIZE_MAX ((size_t)1 << 31)

/* Which reader and writer a file has. */
enum pir_file_type { PIR_FILE_UNKNOWN, PIR_FILE_OFF, PIR_FILE_ASSIMP, PIR_FILE_SVG };

/* The type by the ending, in either case; ret_ending gets it in lower case without the dot. */
enum pir_file_type pir_file_type_of(const char *path, char ret_ending[4]);

/* The last part of a path, short enough to leave room for what went wrong. */
const char *pir_short_name(const char *path);

#endif

/* SPDX-License-Identifier: MIT */
/* Where a path leads, for those who put another file in the place of one. */
#ifndef PIR_POLYTOPE_FILE_TARGET_H
#define PIR_POLYTOPE_FILE_TARGET_H

#include <stdbool.h>

/* The longest path that POSIX systems take, its final zero included. */
#define PIR_PATH_SIZE 4096

/*
 * The path to which `path` leads through links, whether it is there or not. False, with errno set, for a circle or
 * too long a name.
 */
bool pir_follow_links(const char *path, char ret_target[PIR_PATH_SIZE]);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * A file that is complete or absent: written beside its path and renamed when all of it is down. It is opened before a long
 * run, so that a path that cannot be written is known at once. Functions that return false have complained.
 */
#ifndef TOOLS_FILE_H
#define TOOLS_FILE_H

#include <stdbool.h>
#include <stdio.h>

struct output_file {
    FILE *stream; /* NULL when not open */
    char *path, *temporary;
};

bool output_open(struct output_file *file, const char *path);

/* Closes the stream and gives the file its name. */
bool output_commit(struct output_file *file);

/* Removes what is not committed; a file that is not open, or zeroed, is accepted. */
void output_discard(struct output_file *file);

/* `folder`/`name`, to be freed; NULL, with a complaint, when out of memory. */
char *path_join(const char *folder, const char *name);

/* Makes `folder` unless it is there. */
bool folder_make(const char *folder);

#endif

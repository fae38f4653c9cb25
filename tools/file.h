/* SPDX-License-Identifier: MIT */
/*
 * Files that the command writes. A regular file is complete or as it was before: it is written under another name in
 * its folder and renamed when all of it is down, and keeps the permissions that a file of its name had. Links are
 * followed and stay. A device or a FIFO is opened and written to, "-" is standard output. A file is opened before a
 * long run, so that a path that cannot be written is known at once. Functions that return false have complained.
 *
 * Runs that write one file at the same time have temporary files of their own: each puts a whole file there, and the
 * last one stays. What a run leaves that was killed is removed by the next one that writes the same file.
 */
#ifndef TOOLS_FILE_H
#define TOOLS_FILE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct output_sink;

struct output_file {
    FILE *stream;             /* NULL when not open */
    struct output_sink *sink; /* what the stream ends in, and why that failed */
    const char *path;         /* as it was given, for complaints; the caller's */
    char *target;             /* what links lead to; NULL where it is written to as it stands */
    char *temporary;          /* in the folder of the target; NULL likewise */
};

/* `path` must outlive the file. */
bool output_open(struct output_file *file, const char *path);

/* Lets a file that has been opened under one name take the place of another in its folder. False after a complaint. */
bool output_lead_to(struct output_file *file, const char *path);

/* Closes the stream and gives the file its name. */
bool output_commit(struct output_file *file);

/* Whether a write to the stream of an open file has failed, which is then complained of. */
bool output_failed(struct output_file *file);

/*
 * For who writes to places in a regular file, rather than to its stream: after the first failure nothing is written.
 * Bytes behind the end are read as zeros; false where they cannot be read.
 */
void output_write_at(struct output_file *file, const void *data, size_t size, uint64_t at);
bool output_read_at(struct output_file *file, void *data, size_t size, uint64_t at);
void output_cut(struct output_file *file, uint64_t size);
uint64_t output_size(struct output_file *file);

/* Removes what is not committed; a file that is not open, or zeroed, is accepted. */
void output_discard(struct output_file *file);

/* Whether `path` is "-" or names the file that standard output goes to. Nothing else is printed there then. */
bool output_is_stdout(const char *path);

/*
 * Whether `path` is written to as it stands, so that no ending has to tell its format: standard output, a device, a
 * FIFO.
 */
bool output_is_stream(const char *path);

/* Whether two outputs would be one file or stream, by whatever names; devices such as /dev/null can be given twice. */
bool output_same(const char *path, const char *other);

/* Whether `path` ends in `ending`, in either case; something stands before it. */
bool output_ends_in(const char *path, const char *ending);

/* `folder`/`name`, to be freed; NULL, with a complaint, when out of memory. */
char *path_join(const char *folder, const char *name);

/* Makes `folder` unless it is there. */
bool folder_make(const char *folder);

/*
 * Makes a folder of files that belong together unless it is there. Keeps other runs from writing into it until
 * folder_leave, as far as its file system has locks.
 */
bool folder_take(const char *folder, int *ret_lock);

/* A folder that was not taken, as a zeroed lock says, is accepted. */
void folder_leave(int lock);

#endif

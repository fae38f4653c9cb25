/* SPDX-License-Identifier: MIT */
/* Files that are complete or as they were before; see file.h. */
#include "file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "interrupt.h"
#include "message.h"

/* The longest path that POSIX systems take, its final zero included. */
#define PATH_SIZE 4096

/* Links that are followed before they count as a circle. */
#define LINKS_MOST 40

/* Names tried for a temporary file; others may be of a process that had the same number. */
#define TEMPORARY_NAMES 100

static const char *name_of(const char *path) {
    return strcmp(path, "-") == 0 ? "standard output" : path;
}

static bool complain_file(const char *path, const char *doing) {
    complain("%s: cannot %s: %s", name_of(path), doing, strerror(errno ? errno : EIO));
    return false;
}

/* --- where a path leads --- */

bool output_is_stdout(const char *path) {
    struct stat there, standard;
    if (strcmp(path, "-") == 0)
        return true;
    if (stat(path, &there) != 0 || fstat(STDOUT_FILENO, &standard) != 0)
        return false;
    // devices that are no terminal, such as /dev/null, can be written to twice
    bool apart = S_ISCHR(there.st_mode) && !isatty(STDOUT_FILENO);
    return !apart && there.st_dev == standard.st_dev && there.st_ino == standard.st_ino;
}

bool output_is_stream(const char *path) {
    struct stat there;
    return output_is_stdout(path) || (stat(path, &there) == 0 && !S_ISREG(there.st_mode));
}

bool output_ends_in(const char *path, const char *ending) {
    size_t length = strlen(path), own = strlen(ending);
    return length > own && strcasecmp(path + length - own, ending) == 0;
}

/*
 * What `path` leads to when links are followed, whether it is there or not, to be freed. NULL, with errno set, for a
 * circle.
 */
static char *follow_links(const char *path) {
    char next[PATH_SIZE], *target = strdup(path);
    for (int links = 0; target && links < LINKS_MOST; links++) {
        ssize_t size = readlink(target, next, sizeof next);
        if (size < 0)
            return target;
        // a relative link starts from the folder that it stands in
        const char *slash = next[0] == '/' ? NULL : strrchr(target, '/');
        size_t folder = slash ? (size_t)(slash + 1 - target) : 0;
        char *longer = malloc(folder + (size_t)size + 1);
        if (longer)
            snprintf(longer, folder + (size_t)size + 1, "%.*s%.*s", (int)folder, target, (int)size, next);
        free(target);
        target = longer;
    }
    errno = target ? ELOOP : ENOMEM;
    free(target);
    return NULL;
}

/* --- opening --- */

static void forget(struct output_file *file) {
    interrupt_keep(file->temporary);
    free(file->target);
    free(file->temporary);
    *file = (struct output_file){0};
}

/* A new file in the folder of the target. */
static FILE *open_beside(struct output_file *file) {
    const char *slash = strrchr(file->target, '/');
    int folder = slash ? (int)(slash + 1 - file->target) : 0;
    size_t room = (size_t)folder + sizeof ".pirouette--" + 3 * sizeof(long) + 3 * sizeof(int);
    file->temporary = malloc(room);
    for (int i = 0; file->temporary && i < TEMPORARY_NAMES; i++) {
        snprintf(file->temporary, room, "%.*s.pirouette-%ld-%d", folder, file->target, (long)getpid(), i);
        FILE *stream = interrupt_create(file->temporary);
        if (stream || errno != EEXIST)
            return stream;
    }
    return NULL;
}

/* A file that takes the target's place at the end. */
static FILE *open_replacement(struct output_file *file) {
    struct stat old;
    file->target = follow_links(file->path);
    if (!file->target)
        return NULL;
    bool there = stat(file->target, &old) == 0;
    if (there && access(file->target, W_OK) != 0)
        return NULL;
    FILE *stream = open_beside(file);
    if (stream && there)
        fchmod(fileno(stream), old.st_mode & 07777);
    return stream;
}

bool output_open(struct output_file *file, const char *path) {
    *file = (struct output_file){.path = path};
    errno = 0;
    if (path[0] == '\0')
        errno = ENOENT;
    else if (output_is_stdout(path))
        file->stream = stdout;
    else if (output_is_stream(path))
        file->stream = fopen(path, "wb");
    else
        file->stream = open_replacement(file);
    if (file->stream)
        return true;
    complain_file(path, "write");
    forget(file);
    return false;
}

/* --- closing --- */

bool output_commit(struct output_file *file) {
    errno = 0;
    bool good = fflush(file->stream) == 0 && !ferror(file->stream);
    if (file->stream != stdout)
        good = fclose(file->stream) == 0 && good;
    if (file->temporary)
        good = good && rename(file->temporary, file->target) == 0;
    if (!good)
        complain_file(file->path, "write");
    if (file->temporary && !good)
        remove(file->temporary);
    forget(file);
    return good;
}

void output_discard(struct output_file *file) {
    if (!file->stream)
        return;
    if (file->stream != stdout)
        fclose(file->stream);
    if (file->temporary)
        remove(file->temporary);
    forget(file);
}

/* --- folders --- */

char *path_join(const char *folder, const char *name) {
    size_t length = strlen(folder) + 1 + strlen(name) + 1;
    char *path = malloc(length);
    if (path)
        snprintf(path, length, "%s/%s", folder, name);
    else
        complain("%s: out of memory", name);
    return path;
}

bool folder_make(const char *folder) {
    if (mkdir(folder, 0777) == 0)
        return true;
    if (errno != EEXIST)
        return complain_file(folder, "make the folder");
    struct stat about;
    if (stat(folder, &about) != 0)
        return complain_file(folder, "look at the folder");
    errno = ENOTDIR;
    return S_ISDIR(about.st_mode) || complain_file(folder, "write into it");
}

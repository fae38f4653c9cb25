/* SPDX-License-Identifier: MIT */
/* Files that are complete or absent; see file.h. */
#include "file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "message.h"

/* Room for ".tmp" and the digits of a process id. */
#define SUFFIX_LENGTH 32

static bool complain_file(const char *path, const char *doing) {
    complain("%s: cannot %s: %s", path, doing, strerror(errno ? errno : EIO));
    return false;
}

static void forget(struct output_file *file) {
    free(file->path);
    free(file->temporary);
    *file = (struct output_file){0};
}

bool output_open(struct output_file *file, const char *path) {
    size_t length = strlen(path) + 1;
    *file = (struct output_file){.path = malloc(length), .temporary = malloc(length + SUFFIX_LENGTH)};
    if (!file->path || !file->temporary) {
        forget(file);
        complain("%s: out of memory", path);
        return false;
    }
    memcpy(file->path, path, length);
    snprintf(file->temporary, length + SUFFIX_LENGTH, "%s.tmp%ld", path, (long)getpid());
    file->stream = fopen(file->temporary, "wx");
    if (!file->stream) {
        forget(file);
        return complain_file(path, "write");
    }
    return true;
}

bool output_commit(struct output_file *file) {
    errno = 0;
    bool good = fflush(file->stream) == 0 && !ferror(file->stream);
    good = fclose(file->stream) == 0 && good;
    good = good && rename(file->temporary, file->path) == 0;
    if (!good) {
        complain_file(file->path, "write");
        remove(file->temporary);
    }
    forget(file);
    return good;
}

void output_discard(struct output_file *file) {
    if (!file->stream)
        return;
    fclose(file->stream);
    remove(file->temporary);
    forget(file);
}

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

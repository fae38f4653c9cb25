/* SPDX-License-Identifier: MIT */
/*
 * Files that are complete or as they were before; see file.h.
 *
 * A temporary file is locked while it is written, so that what a run has left that was killed is told from what another
 * run is writing. Its name is one of a few for each target: a run takes the first that is free, and removes what others
 * have left under the rest. Where a file system has no locks, a name is free that no file has.
 */
#define _GNU_SOURCE /* fopencookie */
#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "interrupt.h"
#include "message.h"

/* The longest path that POSIX systems take, its final zero included. */
#define PATH_SIZE 4096

/* Links that are followed before they count as a circle. */
#define LINKS_MOST 40

/* Temporary files of one target that runs may have at the same time. */
#define TEMPORARY_NAMES 8

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
    return output_is_stdout(path) || (stat(path, &there) == 0 && !S_ISREG(there.st_mode) && !S_ISDIR(there.st_mode));
}

bool output_ends_in(const char *path, const char *ending) {
    size_t length = strlen(path), own = strlen(ending);
    return length > own && strcasecmp(path + length - own, ending) == 0;
}

/*
 * The path at the end of the links that begin at `path`, to be freed; nothing need be there. NULL, with errno set, for
 * a circle.
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

/* The last part of a path; the folder is what stands before it. */
static const char *name_in(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Whether two paths, links followed, lead to one name in one folder. */
static bool is_same_name(const char *path, const char *other) {
    struct stat folder[2];
    const char *const paths[2] = {path, other};
    for (int k = 0; k < 2; k++) {
        char text[PATH_SIZE] = ".";
        size_t length = (size_t)(name_in(paths[k]) - paths[k]);
        if (length >= sizeof text)
            return false;
        if (length > 0)
            snprintf(text, sizeof text, "%.*s", (int)length, paths[k]);
        if (stat(text, &folder[k]) != 0)
            return false;
    }
    return folder[0].st_dev == folder[1].st_dev && folder[0].st_ino == folder[1].st_ino &&
           strcmp(name_in(path), name_in(other)) == 0;
}

bool output_same(const char *path, const char *other) {
    struct stat there[2];
    if (output_is_stdout(path) || output_is_stdout(other))
        return output_is_stdout(path) && output_is_stdout(other);
    const bool are = stat(path, &there[0]) == 0 && stat(other, &there[1]) == 0;
    if (are && (S_ISCHR(there[0].st_mode) || S_ISCHR(there[1].st_mode)))
        return false;
    if (are && S_ISFIFO(there[0].st_mode) && there[0].st_dev == there[1].st_dev && there[0].st_ino == there[1].st_ino)
        return true;
    char *target = follow_links(path), *second = target ? follow_links(other) : NULL;
    bool same = second && is_same_name(target, second);
    free(target);
    free(second);
    return same;
}

/* --- what streams end in --- */

struct output_sink {
    int descriptor;
    int error; /* of the first write that failed; nothing is written after it */
};

static ssize_t sink_write(void *cookie, const char *data, size_t size) {
    struct output_sink *sink = cookie;
    size_t done = 0;
    while (done < size && sink->error == 0) {
        ssize_t put = write(sink->descriptor, data + done, size - done);
        if (put < 0 && errno != EINTR)
            sink->error = errno;
        done += put > 0 ? (size_t)put : 0;
    }
    errno = sink->error;
    return sink->error == 0 ? (ssize_t)done : 0;
}

void output_write_at(struct output_file *file, const void *data, size_t size, uint64_t at) {
    struct output_sink *sink = file->sink;
    for (size_t done = 0; done < size && sink->error == 0;) {
        ssize_t put = pwrite(sink->descriptor, (const char *)data + done, size - done, (off_t)(at + done));
        if (put < 0 && errno != EINTR)
            sink->error = errno;
        done += put > 0 ? (size_t)put : 0;
    }
}

bool output_read_at(struct output_file *file, void *data, size_t size, uint64_t at) {
    memset(data, 0, size);
    for (size_t done = 0; done < size;) {
        ssize_t got = pread(file->sink->descriptor, (char *)data + done, size - done, (off_t)(at + done));
        if (got == 0)
            return true;
        if (got < 0 && errno != EINTR)
            return false;
        done += got > 0 ? (size_t)got : 0;
    }
    return true;
}

void output_cut(struct output_file *file, uint64_t size) {
    struct output_sink *sink = file->sink;
    if (sink->error == 0 && ftruncate(sink->descriptor, (off_t)size) != 0)
        sink->error = errno;
}

uint64_t output_size(struct output_file *file) {
    struct stat about;
    return fstat(file->sink->descriptor, &about) == 0 ? (uint64_t)about.st_size : 0;
}

/* Closes what the sink had open, but for standard output. Some systems tell of a full disk only here. */
static void sink_close(struct output_sink *sink) {
    if (sink->descriptor > STDERR_FILENO && close(sink->descriptor) != 0 && sink->error == 0)
        sink->error = errno;
    sink->descriptor = -1;
}

/* A stream into the descriptor, which is closed where there can be none. */
static FILE *open_stream(struct output_file *file, int descriptor) {
    if (descriptor < 0)
        return NULL;
    file->sink = malloc(sizeof *file->sink);
    if (file->sink) {
        *file->sink = (struct output_sink){descriptor, 0};
        file->stream = fopencookie(file->sink, "wb", (cookie_io_functions_t){.write = sink_write});
    }
    if (file->stream && isatty(descriptor))
        setvbuf(file->stream, NULL, _IOLBF, BUFSIZ);
    if (!file->stream && descriptor > STDERR_FILENO)
        close(descriptor);
    return file->stream;
}

/* --- opening --- */

static void forget(struct output_file *file) {
    interrupt_keep(file->temporary);
    free(file->target);
    free(file->temporary);
    free(file->sink);
    *file = (struct output_file){0};
}

static bool leads_to(const char *path, int descriptor) {
    struct stat named, opened;
    return stat(path, &named) == 0 && fstat(descriptor, &opened) == 0 && named.st_dev == opened.st_dev &&
           named.st_ino == opened.st_ino;
}

/* Removes a temporary file that no one has locked. False where one stays. */
static bool clear_left(const char *path) {
    int descriptor = open(path, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
        return errno == ENOENT;
    bool left = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    bool gone = left && (!leads_to(path, descriptor) || unlink(path) == 0);
    close(descriptor);
    return gone;
}

/* Makes and locks a temporary file; -1 where another process has taken it for one that was left. */
static int make_temporary(char *path) {
    int descriptor = interrupt_create(path);
    if (descriptor < 0)
        return -1;
    bool locked = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    if (locked ? leads_to(path, descriptor) : errno != EWOULDBLOCK)
        return descriptor;
    interrupt_keep(path);
    close(descriptor);
    errno = EEXIST;
    return -1;
}

/* The number of a target's name, for the names of its temporary files, which may not be longer. */
static uint64_t number_of(const char *name) {
    uint64_t hash = 0xcbf29ce484222325;
    for (; *name; name++)
        hash = (hash ^ (unsigned char)*name) * 0x100000001b3;
    return hash;
}

/* A new file in the folder of the target, by its descriptor. */
static int open_beside(struct output_file *file) {
    const char *name = name_in(file->target);
    int folder = (int)(name - file->target), descriptor = -1, error = EEXIST;
    size_t room = (size_t)folder + sizeof ".pirouette--" + 16 + 3 * sizeof(int);
    char *path = malloc(room);
    file->temporary = malloc(room);
    for (int i = 0; path && file->temporary && i < TEMPORARY_NAMES; i++) {
        snprintf(path, room, "%.*s.pirouette-%016" PRIx64 "-%d", folder, file->target, number_of(name), i);
        if (!clear_left(path) || descriptor >= 0 || error != EEXIST)
            continue;
        memcpy(file->temporary, path, room);
        descriptor = make_temporary(file->temporary);
        error = descriptor < 0 ? errno : 0;
    }
    errno = path && file->temporary ? error : ENOMEM;
    free(path);
    return descriptor;
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
    errno = EISDIR;
    if (there && S_ISDIR(old.st_mode))
        return NULL;
    int descriptor = open_beside(file);
    if (descriptor >= 0 && there)
        fchmod(descriptor, old.st_mode & 07777);
    return open_stream(file, descriptor);
}

bool output_open(struct output_file *file, const char *path) {
    *file = (struct output_file){.path = path};
    errno = 0;
    if (path[0] == '\0')
        errno = ENOENT;
    else if (output_is_stdout(path))
        open_stream(file, STDOUT_FILENO);
    else if (output_is_stream(path))
        open_stream(file, open(path, O_WRONLY | O_TRUNC | O_CLOEXEC));
    else
        open_replacement(file);
    if (file->stream)
        return true;
    complain_file(path, "write");
    if (file->temporary)
        remove(file->temporary);
    forget(file);
    return false;
}

/* --- closing --- */

bool output_failed(struct output_file *file) {
    if (fflush(file->stream) == 0 && !ferror(file->stream) && file->sink->error == 0)
        return false;
    errno = file->sink->error;
    return !complain_file(file->path, "write");
}

/* Whether all that was written is down. The descriptor of a temporary file, which has its lock, stays open. */
static bool is_down(struct output_file *file) {
    bool good = fclose(file->stream) == 0 && file->sink->error == 0;
    if (!file->temporary) {
        sink_close(file->sink);
        return good && file->sink->error == 0;
    }
    int second = dup(file->sink->descriptor);
    if (second < 0 || close(second) != 0)
        file->sink->error = file->sink->error ? file->sink->error : errno;
    return good && file->sink->error == 0;
}

bool output_lead_to(struct output_file *file, const char *path) {
    char *target = follow_links(path);
    if (!target)
        return !complain_file(path, "write");
    free(file->target);
    file->target = target;
    return true;
}

bool output_commit(struct output_file *file) {
    bool good = is_down(file);
    errno = file->sink->error;
    if (good && file->temporary)
        good = rename(file->temporary, file->target) == 0;
    if (!good)
        complain_file(file->path, "write");
    if (file->temporary && !good)
        remove(file->temporary);
    sink_close(file->sink);
    forget(file);
    return good;
}

void output_discard(struct output_file *file) {
    if (!file->stream)
        return;
    // what is still in the stream is not wanted where it can be taken back
    if (file->temporary && file->sink->error == 0)
        file->sink->error = ECANCELED;
    fclose(file->stream);
    if (file->temporary)
        remove(file->temporary);
    sink_close(file->sink);
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

bool folder_take(const char *folder, int *ret_lock) {
    *ret_lock = 0;
    if (!folder_make(folder))
        return false;
    int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        return complain_file(folder, "open the folder");
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        complain("%s: cannot write into it: another run does", folder);
        close(descriptor);
        return false;
    }
    *ret_lock = descriptor;
    return true;
}

void folder_leave(int lock) {
    if (lock > STDERR_FILENO)
        close(lock);
}

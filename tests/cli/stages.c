/* SPDX-License-Identifier: MIT */
/*
 * Preloaded into the command, so that it ends, or finds no locks, between two steps of its work on files:
 *
 *     PIROUETTE_STAGE=N     the N-th call that changes a file, counted from 1, is not made: the process is killed
 *     PIROUETTE_SIGNAL=S    by signal S (9)
 *     PIROUETTE_NO_LOCKS=1  flock fails, as it does where a file system has no locks
 */
#define _GNU_SOURCE      /* RTLD_NEXT */
#undef _FILE_OFFSET_BITS /* which would give open64 and its like the names of open and its like */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static void step(void) {
    static atomic_int steps;
    const char *stage = getenv("PIROUETTE_STAGE"), *number = getenv("PIROUETTE_SIGNAL");
    if (stage && atomic_fetch_add(&steps, 1) + 1 == atoi(stage))
        kill(getpid(), number ? atoi(number) : SIGKILL);
}

/* The function of this name that comes next. POSIX has dlsym give functions as objects. */
static void *next(const char *name) {
    void *function = dlsym(RTLD_NEXT, name);
    if (!function)
        abort();
    return function;
}

#define CALL(result, name, parameters, arguments)                                                                      \
    result name parameters {                                                                                           \
        result(*call) parameters;                                                                                      \
        *(void **)&call = next(#name);                                                                                 \
        step();                                                                                                        \
        return call arguments;                                                                                         \
    }

CALL(int, rename, (const char *from, const char *to), (from, to))
CALL(int, unlink, (const char *path), (path))
CALL(int, remove, (const char *path), (path))
CALL(int, mkdir, (const char *path, mode_t mode), (path, mode))
CALL(int, chmod, (const char *path, mode_t mode), (path, mode))
CALL(int, fchmod, (int descriptor, mode_t mode), (descriptor, mode))
CALL(int, ftruncate, (int descriptor, off_t size), (descriptor, size))
CALL(int, ftruncate64, (int descriptor, off64_t size), (descriptor, size))
CALL(int, fsync, (int descriptor), (descriptor))
CALL(int, fdatasync, (int descriptor), (descriptor))
CALL(ssize_t, pwrite, (int descriptor, const void *data, size_t size, off_t at), (descriptor, data, size, at))
CALL(ssize_t, pwrite64, (int descriptor, const void *data, size_t size, off64_t at), (descriptor, data, size, at))

ssize_t write(int descriptor, const void *data, size_t size) {
    ssize_t (*call)(int, const void *, size_t);
    *(void **)&call = next("write");
    if (descriptor > STDERR_FILENO)
        step();
    return call(descriptor, data, size);
}

int flock(int descriptor, int operation) {
    int (*call)(int, int);
    *(void **)&call = next("flock");
    step();
    if (!getenv("PIROUETTE_NO_LOCKS"))
        return call(descriptor, operation);
    errno = ENOLCK;
    return -1;
}

#define OPEN(name)                                                                                                     \
    int name(const char *path, int flags, ...) {                                                                       \
        int (*call)(const char *, int, ...);                                                                           \
        va_list arguments;                                                                                             \
        va_start(arguments, flags);                                                                                    \
        const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;                                           \
        va_end(arguments);                                                                                             \
        *(void **)&call = next(#name);                                                                                 \
        if (flags & O_CREAT)                                                                                           \
            step();                                                                                                    \
        return call(path, flags, mode);                                                                                \
    }

OPEN(open)
OPEN(open64)

/* SPDX-License-Identifier: MIT */
/*
 * The lock is that of flock, which belongs to the open file: no descriptor closed elsewhere in the process drops it.
 * The file is removed while the lock is held. So whoever gets the lock looks whether the name still leads to the
 * file that it has opened, and else begins again.
 */
#include "cspace/store/job_lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/report.h"
#include "polytope/file/file_name.h"

/* How often the file may be removed by others while the lock is taken. */
#define TRIES_MOST 1000

/* Room for the text in the file: who holds the lock. */
#define WHO_SIZE 128

enum taken { TAKEN, HELD_BY_ANOTHER, GONE, NO_LOCKS };

static bool leads_to(const char *path, int descriptor) {
    struct stat named, opened;
    return stat(path, &named) == 0 && fstat(descriptor, &opened) == 0 && named.st_dev == opened.st_dev &&
           named.st_ino == opened.st_ino;
}

/* Opens the file, or makes it. -1 with errno set; that is EAGAIN where the file went in between. */
static int open_file(const char *path, bool *ret_made) {
    int descriptor = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    *ret_made = descriptor >= 0;
    if (*ret_made || errno != EEXIST)
        return descriptor;
    descriptor = open(path, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0 && errno == ENOENT)
        errno = EAGAIN;
    return descriptor;
}

static enum taken take(const char *path, int descriptor) {
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0)
        return errno == EWOULDBLOCK ? HELD_BY_ANOTHER : NO_LOCKS;
    return leads_to(path, descriptor) ? TAKEN : GONE;
}

/* Says who holds the lock. A disk that is full only keeps that from being said. */
static void write_who(int descriptor) {
    char host[64] = "", who[WHO_SIZE];
    if (gethostname(host, sizeof host - 1) != 0 || host[0] == '\0')
        snprintf(host, sizeof host, "this machine");
    int length = snprintf(who, sizeof who, "process %ld on %s\n", (long)getpid(), host);
    if (ftruncate(descriptor, 0) == 0 && pwrite(descriptor, who, (size_t)length, 0) < length)
        errno = 0;
}

static void read_who(int descriptor, char ret_who[WHO_SIZE]) {
    ssize_t size = pread(descriptor, ret_who, WHO_SIZE - 1, 0);
    ret_who[size > 0 ? size : 0] = '\0';
    ret_who[strcspn(ret_who, "\n")] = '\0';
    for (const char *c = ret_who; *c; c++)
        if (*c < ' ' || *c > '~')
            size = 0;
    if (size <= 0 || strncmp(ret_who, "process ", 8) != 0)
        snprintf(ret_who, WHO_SIZE, "another process");
}

static pir_status fail_held(const char *file, const pir_job_lock *lock, enum taken taken, pir_report *report) {
    char who[WHO_SIZE];
    read_who(lock->descriptor, who);
    if (taken == HELD_BY_ANOTHER)
        return pir_fail(report, PIR_ERR_FILE, "%s: %s is making it", pir_short_name(file), who);
    return pir_fail(report, PIR_ERR_FILE,
                    "%s: %s has left it or is at work, and this file system has no locks; remove it when no run is",
                    pir_short_name(lock->path), who);
}

/* Takes the lock by its path. */
static pir_status take_path(pir_job_lock *lock, const char *file, pir_report *report) {
    errno = EAGAIN;
    for (int tries = 0; tries < TRIES_MOST && errno == EAGAIN; tries++) {
        bool made;
        lock->descriptor = open_file(lock->path, &made);
        if (lock->descriptor < 0)
            continue;
        enum taken taken = take(lock->path, lock->descriptor);
        if (taken == TAKEN || (taken == NO_LOCKS && made)) {
            write_who(lock->descriptor);
            return PIR_OK;
        }
        pir_status status = taken == GONE ? PIR_OK : fail_held(file, lock, taken, report);
        close(lock->descriptor);
        if (status != PIR_OK)
            return status;
        errno = EAGAIN;
    }
    return pir_fail(report, PIR_ERR_FILE, "%s: cannot write: %s", pir_short_name(lock->path), strerror(errno));
}

pir_status pir_job_lock_take(pir_job_lock *lock, const char *file, const pir_allocator *allocator, pir_report *report) {
    *lock = (pir_job_lock){.descriptor = -1, .path_size = strlen(file) + sizeof ".lock"};
    lock->path = PIR_NEW(allocator, char, lock->path_size);
    if (!lock->path)
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", pir_short_name(file));
    snprintf(lock->path, lock->path_size, "%s.lock", file);
    pir_status status = take_path(lock, file, report);
    if (status != PIR_OK) {
        PIR_FREE(allocator, lock->path, lock->path_size);
        *lock = (pir_job_lock){.descriptor = -1};
    }
    return status;
}

void pir_job_lock_drop(pir_job_lock *lock, const pir_allocator *allocator) {
    if (!lock->path)
        return;
    if (leads_to(lock->path, lock->descriptor))
        unlink(lock->path);
    close(lock->descriptor);
    PIR_FREE(allocator, lock->path, lock->path_size);
    *lock = (pir_job_lock){.descriptor = -1};
}

/* SPDX-License-Identifier: MIT */
/*
 * The lock of a job: a file beside the one that is made, which says who makes it. The system drops the lock when its
 * holder ends, however that ends, so what a run leaves that was killed is taken over by the next one.
 */
#ifndef PIR_CSPACE_STORE_JOB_LOCK_H
#define PIR_CSPACE_STORE_JOB_LOCK_H

#include <pirouette/base.h>

#include "base/memory.h"

/* Not held where `path` is NULL. */
typedef struct pir_job_lock {
    int descriptor;
    char *path;
    size_t path_size;
} pir_job_lock;

/*
 * Takes the lock of `file`, or fails at once where another job has it, in this process or in another one. Where the
 * file system has no locks, the lock is held by whoever made its file, and a file that stands there already is left to
 * the caller. Errors: PIR_ERR_FILE, PIR_ERR_MEMORY.
 */
pir_status pir_job_lock_take(pir_job_lock *lock, const char *file, const pir_allocator *allocator, pir_report *report);

/* Removes the file, and drops the lock. One that is not held is accepted. */
void pir_job_lock_drop(pir_job_lock *lock, const pir_allocator *allocator);

#endif

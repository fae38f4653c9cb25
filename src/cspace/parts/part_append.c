/* SPDX-License-Identifier: MIT */
/* The part that a process appends to. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

#include "base/report.h"
#include "cspace/parts/part_file.h"
#include "polytope/file/file_places.h"

/* Seconds between the moments when what was written is made to reach the disk. */
#define SYNC_EVERY 2.0

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec / 1e9;
}

static pir_status fail_part(const pir_part *part, const char *what, pir_report *report) {
    return pir_fail(report, PIR_ERR_FILE, "%s: cannot %s: %s", part->path, what, strerror(errno));
}

/*
 * One process at a time appends to a part. Where the file system has no locks, the lock of the job and the numbers of
 * its parts keep processes apart.
 */
static bool take_lock(int descriptor) {
    return flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

/* The end of the last unit that is whole, of the part's own; writes the header where there is none. */
static pir_status find_end(pir_part *part, const pir_parts *parts, pir_report *report) {
    pir_part_header header;
    part->end = sizeof header;
    if (pir_read_at(part->descriptor, &header, sizeof header, 0) != PIR_OK) {
        header = (pir_part_header){PIR_PART_MAGIC, parts->plan->hash};
        if (ftruncate(part->descriptor, 0) == 0 && pir_write_at(part->descriptor, &header, sizeof header, 0))
            return PIR_OK;
        return fail_part(part, "write", report);
    }
    if (header.magic != PIR_PART_MAGIC || header.plan != parts->plan->hash)
        return pir_fail(report, PIR_ERR_FORMAT, "%s: it is of another job", part->path);
    pir_unit unit;
    if (!pir_unit_init(&unit, parts->plan->slices_per_unit, &parts->allocator))
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", part->path);
    pir_status status = PIR_OK;
    while ((status = pir_unit_read(part->descriptor, part->end, parts->plan, &unit)) == PIR_OK) {
        pir_unit_header whole = pir_unit_header_of(&unit, pir_sections_of(parts->plan));
        part->end += sizeof whole + pir_unit_body(&whole, pir_sections_of(parts->plan));
    }
    pir_unit_finish(&unit, &parts->allocator);
    if (status != PIR_ERR_FORMAT)
        return pir_fail(report, status, "%s: cannot read: %s", part->path, pir_status_text(status));
    return ftruncate(part->descriptor, (off_t)part->end) == 0 ? PIR_OK : fail_part(part, "cut", report);
}

pir_status pir_part_open(pir_part *part, const pir_parts *parts, uint32_t number, pir_report *report) {
    *part =
        (pir_part){.descriptor = -1, .sections = pir_sections_of(parts->plan), .path_size = strlen(parts->file) + 32};
    part->path = PIR_NEW(&parts->allocator, char, part->path_size);
    if (!part->path)
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", parts->file);
    snprintf(part->path, part->path_size, "%s.part%u", parts->file, (unsigned)number);
    part->descriptor = open(part->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (part->descriptor < 0)
        return fail_part(part, "open", report);
    if (!take_lock(part->descriptor))
        return pir_fail(report, PIR_ERR_FILE, "%s: another process is writing to it", part->path);
    part->synced = seconds_now();
    return find_end(part, parts, report);
}

pir_status pir_part_append(pir_part *part, const pir_unit *unit, pir_report *report) {
    pir_unit_header header = pir_unit_header_of(unit, part->sections);
    uint64_t at = part->end;
    bool written = pir_write_at(part->descriptor, &header, sizeof header, at);
    at += sizeof header;
    for (int s = 0; written && s < PIR_UNIT_SECTION_COUNT; s++)
        if (part->sections & 1u << s) {
            size_t size = unit->slices * sizeof *unit->count[s];
            written = pir_write_at(part->descriptor, unit->count[s], size, at);
            at += size;
        }
    for (int s = 0; written && s < PIR_UNIT_SECTION_COUNT; s++) {
        written = pir_write_at(part->descriptor, unit->packed[s].data, unit->packed[s].used, at);
        at += unit->packed[s].used;
    }
    double now = seconds_now();
    if (written && now - part->synced > SYNC_EVERY) {
        written = fdatasync(part->descriptor) == 0;
        part->synced = seconds_now();
    }
    if (!written) {
        pir_status status = fail_part(part, "write", report);
        if (ftruncate(part->descriptor, (off_t)part->end) != 0)
            return fail_part(part, "write, nor cut off what was written", report);
        return status;
    }
    part->end = at;
    return PIR_OK;
}

pir_status pir_part_close(pir_part *part, const pir_allocator *allocator, pir_report *report) {
    pir_status status = PIR_OK;
    // what was written last may still have to reach the disk: a loss of power costs no more than it did before
    if (part->descriptor >= 0 && close(part->descriptor) != 0)
        status = fail_part(part, "close", report);
    if (part->path)
        PIR_FREE(allocator, part->path, part->path_size);
    *part = (pir_part){.descriptor = -1};
    return status;
}

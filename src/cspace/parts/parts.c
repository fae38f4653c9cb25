/* SPDX-License-Identifier: MIT */
/* All parts of a job: found in the folder of its file, read, removed. */
#include "cspace/parts/parts.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/report.h"
#include "cspace/parts/chunks.h"
#include "cspace/parts/part_file.h"
#include "polytope/file/file_name.h"
#include "polytope/file/file_places.h"
#include "polytope/file/target.h"

/* At most what a chunk takes in the file's index. */
#define INDEX_BYTES 96

bool pir_parts_init(pir_parts *parts, const pir_plan *plan, const char *file) {
    *parts = (pir_parts){.allocator = plan->allocator, .plan = plan, .file = file};
    parts->unit = PIR_ZEROED(&parts->allocator, pir_unit_place, plan->units);
    return parts->unit != NULL;
}

void pir_parts_finish(pir_parts *parts) {
    if (parts->unit)
        PIR_FREE(&parts->allocator, parts->unit, parts->plan->units);
    *parts = (pir_parts){0};
}

static const char *name_in(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* The number of the part that a name in the folder is, or -1. */
static int64_t part_number(const char *file, const char *name) {
    size_t length = strlen(name_in(file));
    if (strncmp(name, name_in(file), length) != 0 || strncmp(name + length, ".part", 5) != 0)
        return -1;
    const char *digits = name + length + 5;
    if (*digits < '0' || *digits > '9' || strlen(digits) > 9)
        return -1;
    char *end;
    long number = strtol(digits, &end, 10);
    return *end == '\0' ? number : -1;
}

static bool is_assembling(const char *file, const char *name) {
    size_t length = strlen(name_in(file));
    return strncmp(name, name_in(file), length) == 0 &&
           strncmp(name + length, PIR_ASSEMBLING, strlen(PIR_ASSEMBLING)) == 0;
}

/* Calls `visit` for all that is left beside the file, by path and number of the part, or -1, until one fails. */
static pir_status each_left(const pir_parts *parts, pir_report *report, void *context,
                            pir_status (*visit)(void *context, const char *path, int64_t number, pir_report *report)) {
    char folder[PIR_PATH_SIZE] = ".", path[PIR_PATH_SIZE];
    size_t length = (size_t)(name_in(parts->file) - parts->file);
    if (strlen(parts->file) + 32 > sizeof path)
        return pir_fail(report, PIR_ERR_FILE, "slices: a path that is too long");
    if (length > 0)
        snprintf(folder, sizeof folder, "%.*s", (int)length, parts->file);
    DIR *entries = opendir(folder);
    if (!entries)
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot open the folder: %s", pir_short_name(parts->file),
                        strerror(errno));
    pir_status status = PIR_OK;
    for (struct dirent *entry; status == PIR_OK && (entry = readdir(entries));) {
        int64_t number = part_number(parts->file, entry->d_name);
        if (number < 0 && !is_assembling(parts->file, entry->d_name))
            continue;
        if (length + strlen(entry->d_name) >= sizeof path)
            continue;
        snprintf(path, sizeof path, "%.*s%s", (int)length, parts->file, entry->d_name);
        status = visit(context, path, number, report);
    }
    closedir(entries);
    return status;
}

/* --- reading --- */

struct parts_scan {
    pir_parts *parts;
    pir_unit unit;
};

void pir_parts_note(pir_parts *parts, const pir_unit *unit, uint32_t number, uint64_t at) {
    pir_unit_place *place = &parts->unit[unit->number];
    if (place->part != 0)
        return;
    *place = (pir_unit_place){number + 1, at};
    parts->done++;
    parts->done_slices += unit->slices;
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        parts->done_bytes += unit->packed[s].used + INDEX_BYTES * pir_chunks_of(s, pir_unit_elements(unit, s));
}

static pir_status scan_part(void *context, const char *path, int64_t number, pir_report *report) {
    struct parts_scan *scan = context;
    const pir_plan *plan = scan->parts->plan;
    if (number < 0)
        return PIR_OK;
    scan->parts->found++;
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot open: %s", pir_short_name(path), strerror(errno));
    pir_part_header header;
    pir_status status = pir_read_at(descriptor, &header, sizeof header, 0);
    if (status == PIR_OK && (header.magic != PIR_PART_MAGIC || header.plan != plan->hash)) {
        close(descriptor);
        return pir_fail(report, PIR_ERR_FORMAT, "%s: it is of another job; without resuming it is removed",
                        pir_short_name(path));
    }
    // a part that ends within its header has no unit yet
    for (uint64_t at = sizeof header; status == PIR_OK;) {
        status = pir_unit_read(descriptor, at, plan, &scan->unit);
        if (status != PIR_OK)
            break;
        pir_parts_note(scan->parts, &scan->unit, (uint32_t)number, at);
        pir_unit_header whole = pir_unit_header_of(&scan->unit, pir_sections_of(plan));
        at += sizeof whole + pir_unit_body(&whole, pir_sections_of(plan));
    }
    close(descriptor);
    if (status == PIR_ERR_FORMAT)
        return PIR_OK;
    return pir_fail(report, status, "%s: cannot read: %s", pir_short_name(path), pir_status_text(status));
}

pir_status pir_parts_scan(pir_parts *parts, pir_report *report) {
    struct parts_scan scan = {.parts = parts};
    memset(parts->unit, 0, parts->plan->units * sizeof *parts->unit);
    parts->done = parts->done_slices = parts->done_bytes = parts->found = 0;
    pir_status status;
    if (pir_unit_init(&scan.unit, parts->plan->slices_per_unit, &parts->allocator))
        status = each_left(parts, report, &scan, scan_part);
    else
        status = pir_fail(report, PIR_ERR_MEMORY, "slices: out of memory");
    pir_unit_finish(&scan.unit, &parts->allocator);
    return status;
}

pir_status pir_parts_read(const pir_parts *parts, uint64_t number, pir_unit *unit, pir_report *report) {
    const pir_unit_place *place = &parts->unit[number];
    char path[PIR_PATH_SIZE];
    snprintf(path, sizeof path, "%s.part%u", parts->file, (unsigned)(place->part - 1));
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot open: %s", pir_short_name(path), strerror(errno));
    pir_status status = pir_unit_read(descriptor, place->at, parts->plan, unit);
    close(descriptor);
    if (status == PIR_OK && unit->number != number)
        status = PIR_ERR_FORMAT;
    return status == PIR_OK
               ? PIR_OK
               : pir_fail(report, status, "%s: cannot read: %s", pir_short_name(path), pir_status_text(status));
}

/* --- removing --- */

static pir_status remove_left(void *context, const char *path, int64_t number, pir_report *report) {
    const unsigned *kinds = context;
    if (!(*kinds & (number < 0 ? PIR_LEFT_ASSEMBLING : PIR_LEFT_PARTS)))
        return PIR_OK;
    if (unlink(path) != 0 && errno != ENOENT)
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot remove: %s", pir_short_name(path), strerror(errno));
    return PIR_OK;
}

pir_status pir_parts_remove(const pir_parts *parts, unsigned kinds, pir_report *report) {
    return each_left(parts, report, &kinds, remove_left);
}

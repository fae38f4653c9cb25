/* SPDX-License-Identifier: MIT */
/* Reading a whole file. */
#include "polytope/file/file_bytes.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "base/report.h"
#include "polytope/file/file_name.h"

static pir_status fail_file(pir_report *report, const char *path, const char *doing, int error) {
    return pir_fail(report, PIR_ERR_FILE, "%s: cannot %s: %s", pir_short_name(path), doing, strerror(error));
}

/* Reads an open stream to its end; `expected` is a guess at its size. */
static pir_status read_stream(FILE *file, size_t expected, const char *path, const pir_allocator *allocator,
                              pir_report *report, struct pir_read_bytes *bytes) {
    for (;;) {
        // Room for at least one byte more, which a read at the end leaves empty.
        if (bytes->size == bytes->capacity) {
            size_t capacity = bytes->capacity ? 2 * bytes->capacity : expected + 1;
            char *data = PIR_RESIZE(allocator, bytes->data, bytes->capacity, capacity);
            if (!data)
                return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", pir_short_name(path));
            bytes->data = data;
            bytes->capacity = capacity;
        }
        errno = 0;
        bytes->size += fread(bytes->data + bytes->size, 1, bytes->capacity - bytes->size, file);
        if (ferror(file))
            return fail_file(report, path, "read", errno);
        if (bytes->size > PIR_FILE_SIZE_MAX)
            return pir_fail(report, PIR_ERR_LIMIT, "%s: larger than 2 GiB", pir_short_name(path));
        if (feof(file))
            return PIR_OK;
    }
}

pir_status pir_file_read(const char *path, const pir_allocator *allocator, pir_report *report,
                         struct pir_read_bytes *bytes) {
    FILE *file = fopen(path, "rb");
    if (!file)
        return fail_file(report, path, "open", errno);
    pir_status status;
    struct stat about;
    if (fstat(fileno(file), &about) != 0)
        status = fail_file(report, path, "read", errno);
    else if (S_ISDIR(about.st_mode))
        status = fail_file(report, path, "read", EISDIR);
    else if (S_ISREG(about.st_mode) && (uintmax_t)about.st_size > PIR_FILE_SIZE_MAX)
        status = pir_fail(report, PIR_ERR_LIMIT, "%s: larger than 2 GiB", pir_short_name(path));
    else
        status =
            read_stream(file, S_ISREG(about.st_mode) ? (size_t)about.st_size : 4096, path, allocator, report, bytes);
    fclose(file);
    return status;
}

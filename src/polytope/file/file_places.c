/* SPDX-License-Identifier: MIT */
/* Bytes at places of a file: see file_places.h. */
#include "polytope/file/file_places.h"

#include <errno.h>
#include <unistd.h>

pir_status pir_read_at(int descriptor, void *data, size_t size, uint64_t at) {
    for (size_t got = 0; got < size;) {
        const ssize_t n = pread(descriptor, (char *)data + got, size - got, (off_t)(at + got));
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return n < 0 ? PIR_ERR_FILE : PIR_ERR_FORMAT;
        got += (size_t)n;
    }
    return PIR_OK;
}

bool pir_write_at(int descriptor, const void *data, size_t size, uint64_t at) {
    for (size_t done = 0; done < size;) {
        const ssize_t n = pwrite(descriptor, (const char *)data + done, size - done, (off_t)(at + done));
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        done += (size_t)n;
    }
    return true;
}

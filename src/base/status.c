/* SPDX-License-Identifier: MIT */
/* The texts of statuses, and the version. */
#include <pirouette/base.h>
#include <pirouette/version.h>

const char *pir_status_text(pir_status status) {
    switch (status) {
    case PIR_OK:
        return "ok";
    case PIR_ERR_ARGUMENT:
        return "bad argument";
    case PIR_ERR_NOT_FINITE:
        return "not a finite number";
    case PIR_ERR_ZERO_QUATERNION:
        return "zero quaternion";
    case PIR_ERR_MEMORY:
        return "out of memory";
    case PIR_ERR_EMPTY:
        return "empty input";
    case PIR_ERR_FILE:
        return "file cannot be opened, read or written";
    case PIR_ERR_FORMAT:
        return "broken file format";
    case PIR_ERR_NOT_CLOSED:
        return "facets do not close";
    case PIR_ERR_NOT_CONVEX:
        return "not convex";
    case PIR_ERR_LIMIT:
        return "too large";
    case PIR_ERR_NOT_BUILT:
        return "not in this build";
    case PIR_ERR_REGION:
        return "not with a region";
    case PIR_ERR_VERSION:
        return "of another version";
    case PIR_ERR_INTERNAL:
        return "the result failed the library's own check";
    }
    return "unknown status";
}

const char *pir_version(void) {
    return PIR_VERSION_STRING;
}

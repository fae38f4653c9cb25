/* SPDX-License-Identifier: MIT */
/* Status texts and reports. */
#include "base/report.h"

#include <stdarg.h>
#include <stdio.h>

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
    case PIR_ERR_UNSUPPORTED:
        return "not in this build";
    }
    return "unknown status";
}

pir_status pir_fail(pir_report *report, pir_status status, const char *format, ...) {
    if (report) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(report->text, sizeof report->text, format, arguments);
        va_end(arguments);
        // one line, whatever file name or library message went into it
        for (char *c = report->text; *c; c++)
            if (*c == '\n' || *c == '\r')
                *c = ' ';
        report->status = status;
    }
    return status;
}

const char *pir_version(void) {
    return PIR_VERSION_STRING;
}

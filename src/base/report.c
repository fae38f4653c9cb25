/* SPDX-License-Identifier: MIT */
/* See report.h. */
#include "base/report.h"

#include <stdarg.h>
#include <stdio.h>

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

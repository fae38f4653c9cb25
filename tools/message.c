/* SPDX-License-Identifier: MIT */
/* Reports of what went wrong, one line of stderr each. */
#include "message.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

int complain(const char *format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    // an argument or file name may hold anything
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            *c = ' ';
    fprintf(stderr, "pirouette: %s\n", text);
    return EXIT_BAD_INPUT;
}

int complain_status(const char *where, pir_status status, const pir_report *report) {
    if (report && report->text[0])
        return complain("%s", report->text);
    return complain("%s: %s", where, pir_status_text(status));
}

bool stdout_arrived(void) {
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout))
        return true;
    complain("standard output: cannot write: %s", strerror(errno ? errno : EIO));
    return false;
}

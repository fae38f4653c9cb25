/* SPDX-License-Identifier: MIT */
/* Lines of text; see message.h. */
#include "message.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "text.h"

/* The longest text of one call, of which two names may take most; what goes beyond is cut off. */
#define TEXT_SIZE 16384

/* Why the first write to standard output failed that did, or 0. */
static int output_error;

static void note_failure(void) {
    if (ferror(stdout) && output_error == 0)
        output_error = errno;
}

/* Prints a text as people are shown it. */
static void print_shown(FILE *file, const char *text) {
    for (char shown[TEXT_SHOWN]; text_shown(&text, shown);)
        fputs(shown, file);
}

int complain(const char *format, ...) {
    char text[TEXT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fputs("pirouette: ", stderr);
    print_shown(stderr, text);
    fputs("\n", stderr);
    return EXIT_BAD_INPUT;
}

void say(const char *format, ...) {
    char text[TEXT_SIZE];
    size_t length = strlen(format);
    const bool ends = length > 0 && format[length - 1] == '\n';
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    length = strlen(text);
    if (ends && length > 0 && text[length - 1] == '\n')
        text[length - 1] = '\0';
    errno = 0;
    print_shown(stdout, text);
    if (ends)
        fputs("\n", stdout);
    note_failure();
}

void put_out(const char *text) {
    errno = 0;
    fputs(text, stdout);
    note_failure();
}

int complain_status(const char *where, pir_status status, const pir_report *report) {
    if (report && report->text[0])
        return complain("%s", report->text);
    return complain("%s: %s", where, pir_status_text(status));
}

bool stdout_arrived(void) {
    errno = 0;
    const bool flushed = fflush(stdout) == 0;
    note_failure();
    if (flushed && !ferror(stdout))
        return true;
    complain("standard output: cannot write: %s", strerror(output_error ? output_error : EIO));
    return false;
}

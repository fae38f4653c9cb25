/* SPDX-License-Identifier: MIT */
/* Standard input; see input.h. */
#include "input.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "message.h"

/* Room to begin with, and the most that is read: what the library reads of a file. */
#define ROOM_FIRST 65536
#define SIZE_MOST  ((size_t)1 << 31)

static bool taken;

bool input_is_stdin(const char *path) {
    return strcmp(path, "-") == 0;
}

bool input_take(void) {
    if (taken)
        complain("'-' is given twice, and " INPUT_NAME " is read once");
    bool first = !taken;
    taken = true;
    return first;
}

/* All of standard input, to be freed; its size to *ret_size. */
static char *read_all(size_t *ret_size) {
    char *text = NULL;
    size_t size = 0, room = 0;
    while (!feof(stdin)) {
        if (size == room) {
            room = room ? 2 * room : ROOM_FIRST;
            char *longer = size < SIZE_MOST ? realloc(text, room) : NULL;
            if (!longer) {
                complain(INPUT_NAME ": %s", size < SIZE_MOST ? "out of memory" : "larger than 2 GiB");
                break;
            }
            text = longer;
        }
        size += fread(text + size, 1, room - size, stdin);
        if (ferror(stdin)) {
            complain(INPUT_NAME ": cannot read: %s", strerror(errno));
            break;
        }
    }
    if (feof(stdin)) {
        *ret_size = size;
        return text;
    }
    free(text);
    return NULL;
}

bool input_begin_model(pir_file_bytes *ret_file) {
    size_t size;
    char *text = input_take() ? read_all(&size) : NULL;
    if (text)
        *ret_file = (pir_file_bytes){text, size, INPUT_NAME, "off"};
    return text != NULL;
}

pir_status input_end_model(const pir_file_bytes *file, pir_status status, const pir_report *report) {
    if (status != PIR_OK)
        complain_status(INPUT_NAME, status, report);
    free((void *)file->bytes);
    return status;
}

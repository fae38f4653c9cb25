/* SPDX-License-Identifier: MIT */
/* Bytes that are appended to, numbers of few bytes, and bytes as text. */
#ifndef TOOLS_VIEWS_BYTES_H
#define TOOLS_VIEWS_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <pirouette/base.h>

struct bytes {
    uint8_t *at; /* free() releases it */
    size_t size, room;
    bool failed; /* memory ran out once; what was appended then is missing */
};

void bytes_add(struct bytes *bytes, const void *from, size_t size);

/* The number in 7 bits a byte, the least significant first, 128 added to all bytes but the last. */
void bytes_add_number(struct bytes *bytes, uint64_t number);

/* The coordinates as floats, the least significant byte first. */
void bytes_add_vec(struct bytes *bytes, pir_vec3 v);

/* Prints a text of JSON that no HTML ends. */
void bytes_print_text(FILE *file, const char *text);

/* Prints the bytes in base 64. */
void bytes_print(FILE *file, const void *from, size_t size);

#endif

/* SPDX-License-Identifier: MIT */
/* Files of models, as bytes in memory, and random changes to them, each repeated by its random numbers. */
#ifndef PIR_FUZZ_MUTATE_H
#define PIR_FUZZ_MUTATE_H

#include <stddef.h>
#include <stdint.h>

#include "support/random.h"

struct file_bytes {
    uint8_t *data; /* from malloc */
    size_t size, capacity;
};

/* Appends printf-formatted text, or `size` bytes as they are; ends the program when out of memory. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void file_print(struct file_bytes *file, const char *format, ...);
void file_append(struct file_bytes *file, const void *bytes, size_t size);

/* A copy, to be freed. */
struct file_bytes file_copy(const struct file_bytes *file);

/*
 * One to four random changes: of bits, bytes, 32-bit words, tokens and lines; parts cut off, left out, doubled or
 * exchanged; a part of `other` put in. The result is at most 64 bytes and a part of `other` longer for each change, or
 * twice as long.
 */
void mutate_file(test_random *random, struct file_bytes *file, const struct file_bytes *other);

#endif

/* SPDX-License-Identifier: MIT */
/* See mutate.h. Every change is a splice: bytes from `at` on are replaced by others. */
#include "fuzz/mutate.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz/input.h"

/* The longest part that is doubled, exchanged or taken from another file. */
#define PART_MAX 256

/* Words that readers of models know, and numbers at the edges of what they hold. */
static const char *const words[] = {
    "nan",
    "inf",
    "-inf",
    "1e999",
    "1e-999",
    "-0",
    "0",
    "1",
    "-1",
    "2",
    "3",
    "255",
    "256",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "-2147483648",
    "18446744073709551616",
    "99999999999999999999999",
    "1000000000",
    "1/3",
    "1/0",
    "0x1p3",
    "1e",
    ".",
    "-",
    "+",
    "1.5.2",
    "1,5",
    "1//1",
    "1/1/1",
    "-1/-1/-1",
    "#",
    "\\",
    "\\\n",
    "\"",
    "\r\n",
    "\n",
    "\n\n",
    " ",
    "\t",
    "OFF",
    "COFF",
    "BINARY",
    "ply",
    "format",
    "format ascii 1.0\n",
    "format binary_little_endian 1.0\n",
    "format binary_big_endian 1.0\n",
    "format ascii 2.0\n",
    "comment",
    "obj_info",
    "end_header",
    "end_header\n",
    "\nend_header\r",
    "element",
    "element vertex 4\n",
    "element vertex 1000000000\n",
    "element vertex -1\n",
    "element face 0\n",
    "element face 4294967295\n",
    "element edge 7\n",
    "property float x\n",
    "property double y\n",
    "property uchar red\n",
    "property list uchar int vertex_indices\n",
    "property list float double vertex_indices\n",
    "property list int int vertex_index\n",
    "property list uchar uchar stuff\n",
    "solid",
    "solid x\n",
    "endsolid",
    "facet",
    "facet normal 0 0 1\n",
    "outer loop\n",
    "vertex",
    "vertex 1 2 3\n",
    "endloop\n",
    "endfacet\n",
    "v",
    "v 1 2 3\n",
    "v 1 2 3 4\n",
    "v 1 2 3 0.1 0.2 0.3\n",
    "vt",
    "vn",
    "f",
    "f 1 2 3\n",
    "f 1 2 3 4 5 6 7 8\n",
    "f -1 -2 -3\n",
    "f 0 1 2\n",
    "f 1/1 2/1 3/1\n",
    "f 1//1 2//1 3//1\n",
    "l 1 2\n",
    "p 1\n",
    "o",
    "g",
    "s off\n",
    "usemtl",
    "mtllib x.mtl\n",
    "mtllib",
    "curv 0 1 1 2\n",
    "call x.obj\n",
    "vp 1 2\n",
};

static const uint32_t numbers[] = {0,          1,          2,          3,          0x7f,       0x80,       0xff,
                                   0x100,      0xffff,     0x10000,    0x7fffffff, 0x80000000, 0xffffffff, 0x7f800000,
                                   0xff800000, 0x7fc00000, 0x7f7fffff, 0x00000001, 0x3f800000, 0x40000000};

#define WORD_COUNT   (sizeof words / sizeof *words)
#define NUMBER_COUNT (sizeof numbers / sizeof *numbers)

/* Replaces `out` bytes at `at` by `in` bytes, which are none of the file's own. */
static void splice(struct file_bytes *file, size_t at, size_t out, const void *bytes, size_t in) {
    size_t capacity = file->size - out + in + 1;
    uint8_t *data = malloc(capacity);
    fuzz_require(data != NULL, "there is memory");
    memcpy(data, file->data, at);
    if (in > 0)
        memcpy(data + at, bytes, in);
    memcpy(data + at + in, file->data + at + out, file->size - at - out);
    free(file->data);
    *file = (struct file_bytes){data, capacity - 1, capacity};
}

void file_append(struct file_bytes *file, const void *bytes, size_t size) {
    if (file->capacity - file->size < size + 1) {
        size_t capacity = 2 * file->size + size + 64;
        uint8_t *data = realloc(file->data, capacity);
        fuzz_require(data != NULL, "there is memory");
        file->data = data;
        file->capacity = capacity;
    }
    memcpy(file->data + file->size, bytes, size);
    file->size += size;
}

void file_print(struct file_bytes *file, const char *format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fuzz_require(length >= 0 && (size_t)length < sizeof text, "the text is short");
    file_append(file, text, (size_t)length);
}

struct file_bytes file_copy(const struct file_bytes *file) {
    struct file_bytes copy = {0};
    file_append(&copy, file->data, file->size);
    return copy;
}

/* --- parts --- */

struct part {
    size_t at, size;
};

static size_t below(test_random *random, size_t limit) {
    return limit > 0 ? test_random_below(random, (uint32_t)limit) : 0;
}

/* Some bytes, PART_MAX at most. */
static struct part random_part(test_random *random, const struct file_bytes *file) {
    size_t at = below(random, file->size), rest = file->size - at;
    return (struct part){at, rest > 0 ? 1 + below(random, rest < PART_MAX ? rest : PART_MAX) : 0};
}

/* The bytes around a random place that `ends` does not name, with the one that ends them when `whole`. */
static struct part part_between(test_random *random, const struct file_bytes *file, const char *ends, int whole) {
    size_t at = below(random, file->size), end = at;
    while (at > 0 && !strchr(ends, file->data[at - 1]))
        at--;
    while (end < file->size && !strchr(ends, file->data[end]))
        end++;
    return (struct part){at, end - at + (whole && end < file->size)};
}

/* --- changes --- */

static void change_bytes(test_random *random, struct file_bytes *file) {
    for (size_t left = 1 + below(random, 4); left > 0 && file->size > 0; left--) {
        size_t at = below(random, file->size);
        if (below(random, 2))
            file->data[at] ^= (uint8_t)(1u << below(random, 8));
        else
            file->data[at] = (uint8_t)test_random_bits(random);
    }
}

/* A number of 32 bits over the bytes at a random place, either end first. */
static void change_word(test_random *random, struct file_bytes *file) {
    uint32_t number = numbers[below(random, NUMBER_COUNT)];
    if (file->size < 4)
        return;
    size_t at = below(random, file->size - 3), reversed = below(random, 2);
    for (size_t k = 0; k < 4; k++)
        file->data[at + k] = (uint8_t)(number >> (8 * (reversed ? 3 - k : k)));
}

static void change_token(test_random *random, struct file_bytes *file) {
    const char *word = words[below(random, WORD_COUNT)];
    struct part token = part_between(random, file, " \t\r\n", 0);
    if (below(random, 4) == 0)
        token.size = 0; // put in before it
    splice(file, token.at, token.size, word, strlen(word));
}

static void add_word(test_random *random, struct file_bytes *file) {
    const char *word = words[below(random, WORD_COUNT)];
    size_t line = part_between(random, file, "\r\n", 1).at;
    splice(file, line, 0, word, strlen(word));
}

static void leave_out(test_random *random, struct file_bytes *file, struct part part) {
    (void)random;
    splice(file, part.at, part.size, NULL, 0);
}

/* Puts a part of `from` at a random place, up to 64 times over. */
static void put_in(test_random *random, struct file_bytes *file, const struct file_bytes *from, struct part part) {
    size_t times = below(random, 8) ? 1 : 1 + below(random, 64);
    struct file_bytes copies = {0};
    for (size_t i = 0; i < times && copies.size <= file->size; i++)
        file_append(&copies, from->data + part.at, part.size);
    size_t at = below(random, 2) && from == file ? part.at : below(random, file->size + 1);
    splice(file, at, 0, copies.data, copies.size);
    free(copies.data);
}

static void put_over(test_random *random, struct file_bytes *file, const struct file_bytes *other) {
    struct part part = random_part(random, other);
    size_t at = below(random, file->size), room = file->size - at;
    if (part.size > 0)
        memcpy(file->data + at, other->data + part.at, part.size < room ? part.size : room);
}

static void mutate_once(test_random *random, struct file_bytes *file, const struct file_bytes *other) {
    switch (below(random, 14)) {
    case 0:
    case 1:
        change_bytes(random, file);
        break;
    case 2:
        change_word(random, file);
        break;
    case 3:
    case 4:
    case 5:
        change_token(random, file);
        break;
    case 6:
        add_word(random, file);
        break;
    case 7:
        leave_out(random, file, random_part(random, file));
        break;
    case 8:
        leave_out(random, file, part_between(random, file, "\n", 1));
        break;
    case 9:
        put_in(random, file, file, part_between(random, file, "\n", 1));
        break;
    case 10:
        put_in(random, file, file, random_part(random, file));
        break;
    case 11:
        put_in(random, file, other, random_part(random, other));
        break;
    case 12:
        put_over(random, file, other);
        break;
    default:
        file->size = below(random, file->size + 1);
        break;
    }
}

void mutate_file(test_random *random, struct file_bytes *file, const struct file_bytes *other) {
    // half of them one change, to come far into the readers
    for (size_t left = below(random, 2) ? 1 : 1 + below(random, 4); left > 0; left--)
        mutate_once(random, file, other);
}

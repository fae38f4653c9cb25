/* SPDX-License-Identifier: MIT */
#include "bytes.h"

#include <stdlib.h>
#include <string.h>

#include "../text.h"

void bytes_add(struct bytes *bytes, const void *from, size_t size) {
    if (bytes->room - bytes->size < size) {
        size_t room = 2 * bytes->room + size + 64;
        uint8_t *grown = realloc(bytes->at, room);
        if (!grown) {
            bytes->failed = true;
            return;
        }
        bytes->at = grown;
        bytes->room = room;
    }
    if (size)
        memcpy(bytes->at + bytes->size, from, size);
    bytes->size += size;
}

void bytes_add_number(struct bytes *bytes, uint64_t number) {
    uint8_t digits[10];
    size_t count = 0;
    for (; number >= 128; number >>= 7)
        digits[count++] = (uint8_t)(number | 128);
    digits[count++] = (uint8_t)number;
    bytes_add(bytes, digits, count);
}

void bytes_add_vec(struct bytes *bytes, pir_vec3 v) {
    const float values[3] = {(float)v.x, (float)v.y, (float)v.z};
    for (int i = 0; i < 3; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        const uint8_t four[4] = {(uint8_t)bits, (uint8_t)(bits >> 8), (uint8_t)(bits >> 16), (uint8_t)(bits >> 24)};
        bytes_add(bytes, four, sizeof four);
    }
}

void bytes_print_text(FILE *file, const char *text) {
    fputc('"', file);
    while (*text) {
        const size_t length = text_character(text);
        if (length == 0)
            fputs("\\ufffd", file);
        else if (strchr("\"\\<>&", *text) || (unsigned char)*text < ' ')
            fprintf(file, "\\u%04x", (unsigned)(unsigned char)*text);
        else
            fwrite(text, 1, length, file);
        text += length > 0 ? length : 1;
    }
    fputc('"', file);
}

void bytes_print(FILE *file, const void *from, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t *at = from;
    for (size_t i = 0; i < size; i += 3) {
        size_t count = size - i < 3 ? size - i : 3;
        uint32_t three =
            (uint32_t)at[i] << 16 | (count > 1 ? (uint32_t)at[i + 1] << 8 : 0) | (count > 2 ? at[i + 2] : 0);
        char text[4];
        for (size_t k = 0; k < 4; k++)
            text[k] = k <= count ? digits[three >> (18 - 6 * k) & 63] : '=';
        fwrite(text, 1, sizeof text, file);
    }
}

/* SPDX-License-Identifier: MIT */
/* Numbers and names as text. */
#include "text.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "message.h"

/* The bytes of a character by its first one, and the least number that needs so many; 0 for none. */
static size_t length_of(unsigned char first, uint32_t *ret_least) {
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const size_t length = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
    *ret_least = least[length];
    return length;
}

/* The bytes of the character at `text`, and its number; 0 where there is none. */
static size_t read_character(const char *text, uint32_t *ret_number) {
    const unsigned char *at = (const unsigned char *)text;
    uint32_t least, number;
    const size_t length = at[0] ? length_of(at[0], &least) : 0;
    if (length == 0)
        return 0;
    number = length == 1 ? at[0] : at[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if (at[i] >> 6 != 2)
            return 0;
        number = number << 6 | (at[i] & 0x3f);
    }
    *ret_number = number;
    return number < least || number > 0x10ffff || (number >= 0xd800 && number < 0xe000) ? 0 : length;
}

size_t text_character(const char *text) {
    uint32_t number;
    return read_character(text, &number);
}

/* Whether a character controls how others are shown, ends a line or is none: such are not printed as they are. */
static bool is_control(uint32_t number) {
    static const uint32_t ranges[][2] = {{0, 0x1f},        {0x7f, 0x9f},     {0x61c, 0x61c},   {0x200e, 0x200f},
                                         {0x2028, 0x202e}, {0x2066, 0x2069}, {0xfeff, 0xfeff}, {0xfff9, 0xfffb}};
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (number >= ranges[i][0] && number <= ranges[i][1])
            return true;
    return (number & 0xfffe) == 0xfffe;
}

bool text_shown(const char **text, char ret_shown[TEXT_SHOWN]) {
    uint32_t number = 0;
    if (**text == '\0')
        return false;
    size_t length = read_character(*text, &number);
    if (length > 0 && !is_control(number)) {
        memcpy(ret_shown, *text, length);
        ret_shown[length] = '\0';
        *text += length;
        return true;
    }
    if (length == 0)
        length = 1;
    for (size_t i = 0; i < length; i++)
        snprintf(ret_shown + 4 * i, TEXT_SHOWN - 4 * i, "\\x%02x", (unsigned)(unsigned char)(*text)[i]);
    *text += length;
    return true;
}

void text_print_xml(FILE *file, const char *text) {
    for (char shown[TEXT_SHOWN]; text_shown(&text, shown);)
        fputs(shown[0] == '<' ? "&lt;" : shown[0] == '>' ? "&gt;" : shown[0] == '&' ? "&amp;" : shown, file);
}

void text_double(double value, char ret_text[TEXT_NUMBER]) {
    if (!isfinite(value)) {
        snprintf(ret_text, TEXT_NUMBER, "%s", isnan(value) ? "none" : value > 0 ? "above 1.79e308" : "below -1.79e308");
        return;
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(ret_text, TEXT_NUMBER, "%.*g", digits, value);
        if (strtod(ret_text, NULL) == value)
            return;
    }
}

void text_time(double nanoseconds, char ret_text[TEXT_NUMBER]) {
    static const char *const units[] = {"ns", "us", "ms", "s"};
    int unit = 0;
    // 999.5 would print as 1000
    while (nanoseconds >= 999.5 && unit < 3) {
        nanoseconds /= 1000;
        unit++;
    }
    int decimals = unit == 0 || nanoseconds >= 99.95 ? 0 : nanoseconds >= 9.995 ? 1 : 2;
    snprintf(ret_text, TEXT_NUMBER, "%.*f %s", decimals, nanoseconds, units[unit]);
}

void text_print_range(const char *axis, double low, double high) {
    char from[TEXT_NUMBER], to[TEXT_NUMBER];
    text_double(low, from);
    text_double(high, to);
    say("  %-10s %s to %s\n", axis, from, to);
}

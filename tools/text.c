/* SPDX-License-Identifier: MIT */
/* Numbers as text. */
#include "text.h"

#include <stdio.h>
#include <stdlib.h>

void text_double(double value, char ret_text[TEXT_NUMBER]) {
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
    printf("  %-10s %s to %s\n", axis, from, to);
}

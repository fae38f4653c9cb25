/* SPDX-License-Identifier: MIT */
/* See write_number.h. */
#include "polytope/write/write_number.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

void pir_write_number(FILE *file, double value, char end) {
    char text[32];
    // %g drops zeros at the end, so 15 digits show no more than are needed, but below DBL_MIN
    for (int digits = fabs(value) < DBL_MIN ? 1 : DBL_DIG; digits <= DBL_DECIMAL_DIG; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    fprintf(file, "%s%c", text, end);
}

/* SPDX-License-Identifier: MIT */
/* See options.h. */
#include "base/options.h"

#include <stdalign.h>
#include <string.h>

#include <pirouette/version.h>

#include "base/report.h"

/* No struct of options is larger, in bytes: a greater size was never set, and what stands there is not read. */
#define SIZE_MOST 4096

/* Whether a struct can have that size: a first field, at least one more, and no more than the most. */
static bool is_size(size_t size) {
    return size > sizeof size && size % alignof(size_t) == 0 && size <= SIZE_MOST;
}

static bool is_zero(const unsigned char *bytes, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (bytes[i] != 0)
            return false;
    return true;
}

pir_status pir_options_take(const char *name, const void *options, void *used, pir_report *const *report) {
    if (!options)
        return PIR_OK;
    size_t size, known;
    memcpy(&size, options, sizeof size);
    memcpy(&known, used, sizeof known);
    if (!is_size(size))
        return pir_fail(report ? *report : NULL, PIR_ERR_ARGUMENT, "%s: its size is %zu: begin with %s_default()", name,
                        size, name);
    memcpy(used, options, size < known ? size : known);
    memcpy(used, &known, sizeof known);
    if (size > known && !is_zero((const unsigned char *)options + known, size - known))
        return pir_fail(report ? *report : NULL, PIR_ERR_VERSION,
                        "%s: it has %zu bytes, and not zero in those after the %zu that version %s knows", name, size,
                        known, PIR_VERSION_STRING);
    return PIR_OK;
}

/* SPDX-License-Identifier: MIT */
/*
 * Structs of options whose caller was built with the headers of another version.
 *
 * The first field of each is a size_t, the size of the struct in the caller's headers: its `_default` function is
 * inline, so that the compiler of the caller sets it.
 *
 * Invariant: a version adds fields at the end alone, none of them in what was padding, and leaves no padding behind
 * them. So the struct of an older version is the beginning of that of a newer one.
 */
#ifndef PIR_BASE_OPTIONS_H
#define PIR_BASE_OPTIONS_H

#include <pirouette/base.h>

/*
 * Reads the caller's `options`, a struct called `name` of any size, into `used`, which holds the defaults as this
 * version has it, its own size first. NULL leaves the defaults. So do fields that a smaller struct lacks; those of a
 * larger one that this version does not know must be zero.
 *
 * report  NULL, or where the report is that a failure fills, which may be one that the options name.
 *
 * PIR_ERR_ARGUMENT (a size that no struct has, 0 among them), PIR_ERR_VERSION.
 */
pir_status pir_options_take(const char *name, const void *options, void *used, pir_report *const *report);

#endif

/* SPDX-License-Identifier: MIT */
/* Filling a pir_report: one line that says what, where and why. */
#ifndef PIR_BASE_REPORT_H
#define PIR_BASE_REPORT_H

#include <pirouette/base.h>

/* Writes the printf-formatted text and the status into `report`, which may be NULL; returns `status`. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
pir_status
pir_fail(pir_report *report, pir_status status, const char *format, ...);

#endif

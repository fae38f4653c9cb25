/* SPDX-License-Identifier: MIT */
/* The plain version of the loops, and the choice among versions. */
#include "query/depth/scan.h"

#define SCAN_TARGET
#define SCAN_WIDTH 2
#define SCAN_NAME  pir_scan_plain
#define SCAN_TEXT  "plain"
#include "query/depth/scan_body.h"

const pir_scan *pir_scan_version(unsigned index) {
    if (index == 0)
        return &pir_scan_plain;
#if PIR_HAVE_X86_SCAN
    if (index == 1 && __builtin_cpu_supports("avx2"))
        return &pir_scan_avx2;
#endif
    return NULL;
}

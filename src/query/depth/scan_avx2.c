/* SPDX-License-Identifier: MIT */
/* The loops for AVX2. */
#include "query/depth/scan.h"

#if PIR_HAVE_X86_SCAN
#define SCAN_TARGET __attribute__((target("avx2")))
#define SCAN_WIDTH  4
#define SCAN_NAME   pir_scan_avx2
#define SCAN_TEXT   "AVX2"
#include "query/depth/scan_body.h"
#else
typedef int pir_no_avx2; // a file holds at least a declaration
#endif

/* SPDX-License-Identifier: MIT */
/* Which versions of the loops this build has. */
#ifndef PIR_QUERY_PLANES_SCAN_VERSIONS_H
#define PIR_QUERY_PLANES_SCAN_VERSIONS_H

#include "query/planes/scan.h"

extern const pir_scan pir_scan_plain;

#if defined(__x86_64__) && defined(__GNUC__)
#define PIR_HAVE_X86_SCAN 1
extern const pir_scan pir_scan_avx2;
#endif

#endif

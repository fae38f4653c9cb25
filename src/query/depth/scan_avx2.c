/* SPDX-License-Identifier: MIT */
/* The loops over planes for AVX2. */
#define PIR_LANES_AVX2 1
#include "query/depth/scan_body.h"

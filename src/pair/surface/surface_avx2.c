/* SPDX-License-Identifier: MIT */
/* A surface's loops for AVX2. */
#define PIR_LANES_AVX2 1
#include "pair/surface/surface_body.h"

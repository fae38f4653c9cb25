/* SPDX-License-Identifier: MIT */
/* The loops over axes for AVX2. */
#define PIR_LANES_AVX2 1
#include "pair/axes/axes_body.h"

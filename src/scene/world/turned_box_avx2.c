/* SPDX-License-Identifier: MIT */
/* The box of turned points for AVX2. */
#define PIR_LANES_AVX2 1
#include "scene/world/turned_box_body.h"

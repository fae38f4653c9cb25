/* SPDX-License-Identifier: MIT */
/* A surface's loops for any processor. */
#include "pair/surface/surface_body.h"

/* SPDX-License-Identifier: MIT */
/* The loops over axes for any processor. */
#include "pair/axes/axes_body.h"

/* SPDX-License-Identifier: MIT */
/* The loops over planes for any processor. */
#include "query/depth/scan_body.h"

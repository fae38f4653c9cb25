/* SPDX-License-Identifier: MIT */
/* The box of turned points for any processor. */
#include "scene/world/turned_box_body.h"

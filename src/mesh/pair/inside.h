/* SPDX-License-Identifier: MIT */
/* Whether a point, or a whole part, is within a closed mesh. */
#ifndef PIR_MESH_PAIR_INSIDE_H
#define PIR_MESH_PAIR_INSIDE_H

#include "mesh/pair/mesh_frame.h"

/* Whether any part of one mesh (0: P) is within the other, where both are closed and share no point. */
bool pir_is_inside(pir_mesh_frame *frame, int side);

#endif

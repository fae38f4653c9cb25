/* SPDX-License-Identifier: MIT */
/*
 * All rotations, divided into boxes.
 *
 * A rotation is a quaternion of any length and either sign. Divided by its largest component it lies on a face of the
 * cube [−1, 1]⁴ where that is 1, which is a chart: [−1, 1]³. A box is a part of a chart that halvings make, with
 * corners that doubles have exactly: coordinates are integers of 2^-20. The boxes of a level cover all rotations, and
 * two share rotations exactly where their products of four intervals meet, one of them mirrored or not.
 *
 * From level 1 on a box is within an octant of its chart, so two quaternions of it have a product of 1 at least.
 */
#ifndef PIR_PLAN_ROTATIONS_ROTATION_BOX_H
#define PIR_PLAN_ROTATIONS_ROTATION_BOX_H

#include "plan/turn_bodies.h"

#define PIR_ROTATION_LEVELS 18
#define PIR_ROTATION_ROOTS  32 /* boxes of level 1 */

typedef struct pir_rotation_box {
    uint8_t chart, level; /* which of x, y, z, w is 1; 2^level intervals a coordinate */
    uint32_t at[3];       /* of the other components, in the order of x, y, z, w */
} pir_rotation_box;

/* The box of level 1 by its number. */
pir_rotation_box pir_rotation_box_root(uint32_t number);

/* The eighth of a box by its number. */
pir_rotation_box pir_rotation_box_child(pir_rotation_box box, uint32_t number);

/* The intervals of all four components, in 2^-20. */
void pir_rotation_box_bounds(pir_rotation_box box, int32_t ret_low[4], int32_t ret_high[4]);

/* Whether two boxes share a rotation. */
bool pir_rotation_boxes_touch(pir_rotation_box a, pir_rotation_box b);

/* Whether a box has a rotation, or nearly: all that have it are said to. */
bool pir_rotation_box_has(pir_rotation_box box, pir_quat q);

/* The corners, and the middle of them. */
pir_plan_turns pir_rotation_box_corners(pir_rotation_box box);
pir_quat pir_rotation_box_middle(pir_rotation_box box);

#endif

/* SPDX-License-Identifier: MIT */
/* Whether the surface of a body crosses itself; it may touch itself. */
#ifndef PIR_SOLID_BODY_CROSSING_H
#define PIR_SOLID_BODY_CROSSING_H

#include "solid/body/solid_body.h"

/* PIR_ERR_FORMAT, reported with the two facets, and where it can be with an edge, where it does. */
pir_status pir_shell_body_check_crossing(pir_shell_body *body);

/* Whether a point in the plane of a part lies in it, its boundary included. */
bool pir_shell_body_part_holds(pir_shell_body *body, uint32_t part, uint32_t point);

/* Whether a point is a corner of a part. */
bool pir_shell_body_part_has(const pir_shell_body *body, uint32_t part, uint32_t point);

/* The side of a part's plane on which a point lies. */
int pir_shell_body_part_side(pir_shell_body *body, uint32_t part, uint32_t point);

#endif

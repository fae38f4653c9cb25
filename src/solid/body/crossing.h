/* SPDX-License-Identifier: MIT */
/* Whether the surface of a body meets itself anywhere but along its edges and at its vertices. */
#ifndef PIR_SOLID_BODY_CROSSING_H
#define PIR_SOLID_BODY_CROSSING_H

#include "solid/body/solid_body.h"

/* PIR_ERR_FORMAT, reported with the two facets and a place, where it does. */
pir_status pir_body_check_crossing(pir_body *body);

/* Whether a point in the plane of a part lies in it, its boundary included. */
bool pir_body_part_holds(pir_body *body, uint32_t part, uint32_t point);

#endif

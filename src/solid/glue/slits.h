/* SPDX-License-Identifier: MIT */
/* Facets with holes as one loop of corners: a slit joins each hole to what is round it. */
#ifndef PIR_SOLID_GLUE_SLITS_H
#define PIR_SOLID_GLUE_SLITS_H

#include "solid/glue/facet_loops.h"

/* Adds the facet of an outer loop in the plane of `half`, with the holes in it. */
void pir_loops_add_facet(pir_loop_list *loops, uint32_t half, uint32_t outer);

#endif

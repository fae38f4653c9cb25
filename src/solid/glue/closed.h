/* SPDX-License-Identifier: MIT */
/* The last look at a surface before it is given out: whether it is closed. */
#ifndef PIR_SOLID_GLUE_CLOSED_H
#define PIR_SOLID_GLUE_CLOSED_H

#include "solid/glue/facet_loops.h"

/* A fault of the space where an edge of boundary facets is not walked as often one way as the other, or a facet has
 * fewer than three corners or the same one twice in a row. */
void pir_loops_check_closed(pir_loop_list *loops);

#endif

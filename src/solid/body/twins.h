/* SPDX-License-Identifier: MIT */
/* Which halfedges of a body are two sides of one edge. */
#ifndef PIR_SOLID_BODY_TWINS_H
#define PIR_SOLID_BODY_TWINS_H

#include "solid/body/solid_body.h"

/* Fills twins and edges, whose directions and bends are still to come. Facets have their planes. PIR_ERR_NOT_CLOSED is
 * reported with the edge. */
pir_status pir_shell_body_find_twins(pir_shell_body *body);

#endif

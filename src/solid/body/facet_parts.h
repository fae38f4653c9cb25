/* SPDX-License-Identifier: MIT */
/* Convex parts that cover the facets of a body. */
#ifndef PIR_SOLID_BODY_FACET_PARTS_H
#define PIR_SOLID_BODY_FACET_PARTS_H

#include "solid/body/solid_body.h"

/* Cuts facets by diagonals, then joins what stays convex. False with *ret_facet where a facet's loop crosses itself. */
bool pir_shell_body_cut_parts(pir_shell_body *body, uint32_t *ret_facet);

#endif

/* SPDX-License-Identifier: MIT */
/* Bodies of a page, packed: the points of all pieces, and of each facet how many corners it has and which these are. */
#ifndef TOOLS_VIEWS_FORMS_H
#define TOOLS_VIEWS_FORMS_H

#include <pirouette/pirouette.h>

#include "bytes.h"

/* Adds a piece, whose corners count from *first on, and brings that behind them. */
pir_status forms_add(struct bytes *points, struct bytes *facets, const pir_polytope *piece, uint32_t *first);

/* Prints both as members of an object of JSON that has begun; `facets` has the count of facets first. */
void forms_print(FILE *file, const struct bytes *points, const struct bytes *facets);

#endif

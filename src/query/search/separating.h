/* SPDX-License-Identifier: MIT */
/* A proof that the bodies are apart: see separating.c. */
#ifndef PIR_QUERY_SEARCH_SEPARATING_H
#define PIR_QUERY_SEARCH_SEPARATING_H

#include "query/frame/nearest_vertex.h"
#include "query/planes/group_planes.h"

/* Whether a facet of D at the simplex certainly separates. Then the cache keeps it, if there is one. */
bool pir_prove_outside(const pir_groups *groups, const pir_placement *placement, const pir_simplex *simplex,
                       pir_query_cache *cache);

#endif

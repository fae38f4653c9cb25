/* SPDX-License-Identifier: MIT */
/* The planes of groups, and of the piece that a cache names. */
#ifndef PIR_QUERY_PLANES_GROUP_PLANES_H
#define PIR_QUERY_PLANES_GROUP_PLANES_H

#include <pirouette/query.h>

#include "query/planes/groups.h"

/* Makes the planes of group `g` unless they are there. */
void pir_group_make(pir_groups *groups, uint32_t g);

/* The piece kept in a cache, if it still is one: made into the spare slot, the last. */
bool pir_piece_recall(pir_groups *groups, const pir_query_cache *cache, uint32_t *ret_slot);
void pir_piece_keep(pir_query_cache *cache, pir_piece piece);

#endif

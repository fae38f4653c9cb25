/* SPDX-License-Identifier: MIT */
/* The planes of groups, and the piece that a cache keeps from query to query. */
#ifndef PIR_QUERY_DEPTH_GROUP_PLANES_H
#define PIR_QUERY_DEPTH_GROUP_PLANES_H

#include <pirouette/query.h>

#include "query/depth/groups.h"

/* Makes the planes of group `g`, unless they are there. */
void pir_group_make(pir_groups *groups, uint32_t g);

/* Keeps a piece in a cache. Nothing changes where there is no cache, NULL, or no piece. */
void pir_piece_keep(pir_query_cache *cache, pir_piece piece);

/* The piece that a cache keeps, or a piece beside it where that is gone. False where the cache keeps none. */
bool pir_piece_cached(const pir_groups *groups, const pir_query_cache *cache, pir_piece *ret_piece);

/* The plane of that piece. */
bool pir_piece_recall(const pir_groups *groups, const pir_query_cache *cache, pir_plane *ret_plane);

#endif

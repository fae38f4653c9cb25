/* SPDX-License-Identifier: MIT */
/* The nearest free place, of all or along a direction: see depth_search.c. */
#ifndef PIR_SOLID_DEPTH_DEPTH_SEARCH_H
#define PIR_SOLID_DEPTH_DEPTH_SEARCH_H

#include "solid/depth/free_parts.h"
#include "solid/depth/kept_covers.h"

/* A pair, the plane of a facet, a facet or a part that is still to be looked at, and no nearer than `least`. */
typedef struct pir_depth_item {
    double least;
    enum { PIR_DEPTH_PAIR, PIR_DEPTH_PLANE, PIR_DEPTH_FACET, PIR_DEPTH_PART } kind;
    uint32_t number;
} pir_depth_item;

typedef struct pir_depth_search {
    pir_obstacle obstacle;
    pir_free_parts parts;
    pir_depth_item *heap;
    uint32_t heap_count, heap_room;
    pir_covers covers;
    pir_kept_covers kept;
    pir_facet_key last; /* the facet of the last answer, where there is one */
    bool has_last, coherent;
} pir_depth_search;

/* Where P is free, nearest to where it is: a point of the obstacle, and the least plane that it is on. */
typedef struct pir_depth_found {
    uint32_t plane, point;
} pir_depth_found;

/* False when out of memory; pir_depth_search_finish then frees what is there. */
bool pir_depth_search_init(pir_depth_search *search, const pir_compound *p, const pir_compound *q,
                           const pir_allocator *allocator);
void pir_depth_search_finish(pir_depth_search *search);

/* The nearest free place of all. The insides of the bodies meet. PIR_ERR_MEMORY, PIR_ERR_LIMIT. */
pir_status pir_depth_search_nearest(pir_depth_search *search, const pir_pair_input *input, pir_depth_found *ret_found);

/* The first free place along a direction of the world. Likewise. */
pir_status pir_depth_search_along(pir_depth_search *search, const pir_pair_input *input, pir_vec3 way,
                                  pir_depth_found *ret_found);

#endif

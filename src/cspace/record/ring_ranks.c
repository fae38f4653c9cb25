/* SPDX-License-Identifier: MIT */
/* Ranks of halfedges and guides of facets, each in one pass over the edges. */
#include "cspace/record/ring_ranks.h"

#include "base/layout.h"

static pir_layout layout_of(pir_ring_ranks *ranks) {
    return (pir_layout){{PIR_ROW(ranks->rank, ranks->of->half_count), PIR_ROW(ranks->guide, ranks->of->facet_count)}};
}

static void rank_edges(pir_ring_ranks *ranks, uint32_t *next) {
    const pir_polytope *p = ranks->of;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t half = p->edge_half[e], twin = p->twin[half];
        ranks->rank[half] = next[p->origin[half]]++;
        ranks->rank[twin] = next[p->origin[twin]]++;
    }
}

static void guide_facets(pir_ring_ranks *ranks) {
    const pir_polytope *p = ranks->of;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        uint32_t least = f;
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
            least = p->across[i].facet < least ? p->across[i].facet : least;
        ranks->guide[f] = least < f ? least : PIR_NO_GUIDE;
    }
}

bool pir_ring_ranks_init(pir_ring_ranks *ranks, const pir_polytope *of, const pir_allocator *allocator) {
    *ranks = (pir_ring_ranks){.of = of};
    pir_layout layout = layout_of(ranks);
    uint32_t *next = PIR_ZEROED(allocator, uint32_t, of->vertex_count);
    bool enough = next && pir_layout_new(allocator, &layout);
    if (enough) {
        rank_edges(ranks, next);
        guide_facets(ranks);
    }
    PIR_FREE(allocator, next, of->vertex_count);
    return enough;
}

void pir_ring_ranks_finish(pir_ring_ranks *ranks, const pir_allocator *allocator) {
    if (!ranks->of)
        return;
    pir_layout layout = layout_of(ranks);
    pir_layout_free(allocator, &layout);
}

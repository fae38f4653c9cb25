/* SPDX-License-Identifier: MIT */
/*
 * The order of visits: breadth first from facet 0, but within a part of the facets that grows by blocks of numbers. So
 * what a traversal reads of neighbouring numbers it reads at about the same time, and facets that follow each other
 * seldom wait for one another.
 */
#include "polytope/facet_order.h"

/* How many facets a block has. What a rebuild reads of so many stays in a cache of the second level. */
#define BLOCK 1024

/* The facets seen so far. */
struct facets_seen {
    bool *is; /* per facet */
    uint32_t count;
};

static void see(pir_polytope *p, struct facets_seen *seen, uint32_t f, uint32_t beside) {
    p->visit[seen->count++] = (pir_visit){f, beside};
    p->beside[f] = beside;
    seen->is[f] = true;
}

/* A facet beside f that has been seen, of those below `limit`; or f. */
static uint32_t seen_beside(const pir_polytope *p, const struct facets_seen *seen, uint32_t f, uint32_t limit) {
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
        if (p->across[i].facet < limit && seen->is[p->across[i].facet])
            return p->across[i].facet;
    return f;
}

static void order(pir_polytope *p, struct facets_seen *seen) {
    see(p, seen, 0, 0);
    for (uint32_t first = 0, next = 0, limit; first < p->facet_count; first = limit) {
        limit = p->facet_count - first > BLOCK ? first + BLOCK : p->facet_count;
        for (uint32_t f = first; f < limit; f++) {
            uint32_t beside = seen->is[f] ? f : seen_beside(p, seen, f, first);
            if (beside != f)
                see(p, seen, f, beside);
        }
        for (; next < seen->count; next++) {
            uint32_t f = p->visit[next].facet;
            for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
                if (p->across[i].facet < limit && !seen->is[p->across[i].facet])
                    see(p, seen, p->across[i].facet, f);
        }
    }
}

bool pir_order_facets(pir_polytope *p) {
    const pir_allocator *a = &p->allocator;
    struct facets_seen seen = {PIR_ZEROED(a, bool, p->facet_count), 0};
    if (seen.is && p->facet_count > 0)
        order(p, &seen);
    PIR_FREE(a, seen.is, p->facet_count);
    return seen.is != NULL;
}

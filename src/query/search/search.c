/* SPDX-License-Identifier: MIT */
/* Memory of searches: see search.h. */
#include "query/search/search.h"

static pir_layout layout_of(pir_search *search) {
    uint32_t count = search->groups.count;
    return (pir_layout){{PIR_ROW(search->slack, count), PIR_ROW(search->looked, count)}};
}

bool pir_search_init(pir_search *search, const pir_allocator *allocator, pir_exact *exact, const pir_pairing *pairing) {
    search->groups.frame = exact->frame;
    search->groups.exact = exact;
    search->groups.pairing = pairing;
    bool done = pir_groups_init(&search->groups, allocator);
    pir_layout layout = layout_of(search);
    done = pir_layout_new(allocator, &layout) && done;
    return pir_bounds_init(&search->bounds, allocator, &search->groups) && done;
}

void pir_search_finish(pir_search *search, const pir_allocator *allocator) {
    pir_layout layout = layout_of(search);
    pir_layout_free(allocator, &layout);
    pir_bounds_finish(&search->bounds, allocator, &search->groups);
    pir_groups_finish(&search->groups, allocator);
}

void pir_search_fill(pir_search *search) {
    pir_groups_fill(&search->groups);
    pir_bounds_fill(&search->bounds, &search->groups);
}

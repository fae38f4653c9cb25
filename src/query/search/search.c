/* SPDX-License-Identifier: MIT */
/* Memory of searches: see search.h. */
#include "query/search/search.h"

void pir_search_init(pir_search *search, pir_exact *exact, const pir_pairing *pairing) {
    search->groups.frame = exact->frame;
    search->groups.exact = exact;
    search->groups.pairing = pairing;
    for (unsigned i = 0; pir_scan_version(i); i++)
        search->groups.scan = pir_scan_version(i);
}

void pir_search_add_rows(pir_search *search, pir_layout *layout) {
    uint32_t count = search->groups.count;
    pir_groups_add_rows(&search->groups, layout);
    pir_bounds_add_rows(&search->bounds, &search->groups, layout);
    pir_layout_add(layout, (pir_layout_row)PIR_ROW(search->slack, count));
    pir_layout_add(layout, (pir_layout_row)PIR_ROW(search->looked, count));
}

void pir_search_fill(pir_search *search) {
    pir_groups_fill(&search->groups);
    pir_bounds_fill(&search->bounds, &search->groups);
}

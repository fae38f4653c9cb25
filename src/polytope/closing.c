/* SPDX-License-Identifier: MIT */
/*
 * Whether facets close: sort their edges by both ends with two stable counting passes, O(edges + vertices) for any number of facets
 * at a vertex; equal edges then stand together, in the order of the file, and there must be two of each.
 */
#include "polytope/closing.h"

#include <stdbool.h>
#include <string.h>

#include "base/memory.h"
#include "base/report.h"

/* One stable counting pass: `from` to `into`, by one end; `starts` has room for vertex_count + 1. */
static void counting_pass(const struct pir_facet_edge *from, struct pir_facet_edge *into, size_t count, bool by_high,
                          size_t *starts, uint32_t vertex_count) {
    memset(starts, 0, ((size_t)vertex_count + 1) * sizeof *starts);
    for (size_t i = 0; i < count; i++)
        starts[(by_high ? from[i].high : from[i].low) + 1]++;
    for (size_t v = 0; v < vertex_count; v++)
        starts[v + 1] += starts[v];
    for (size_t i = 0; i < count; i++)
        into[starts[by_high ? from[i].high : from[i].low]++] = from[i];
}

/* The offence on the earliest line among the sorted edges: one that is alone, or the third of its kind. */
static pir_status report_open_edge(const struct pir_facet_edge *edges, size_t count, const char *name,
                                   pir_report *report) {
    const struct pir_facet_edge *worst = NULL;
    bool alone = false;
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && edges[end].low == edges[i].low && edges[end].high == edges[i].high;)
            end++;
        if (end - i == 2)
            continue;
        const struct pir_facet_edge *offence = end - i == 1 ? &edges[i] : &edges[i + 2];
        if (!worst || offence->line < worst->line) {
            worst = offence;
            alone = end - i == 1;
        }
    }
    if (!worst)
        return PIR_OK;
    return pir_fail(report, PIR_ERR_NOT_CLOSED, "%s:%u: the facets do not close: edge %u-%u is on %s", name,
                    (unsigned)worst->line, (unsigned)worst->low, (unsigned)worst->high,
                    alone ? "this facet only" : "two facets before this one");
}

pir_status pir_check_closing(struct pir_facet_edge *edges, size_t count, uint32_t vertex_count,
                             const pir_allocator *allocator, const char *name, pir_report *report) {
    if (count == 0)
        return PIR_OK;
    pir_status status;
    size_t start_count = (size_t)vertex_count + 1;
    struct pir_facet_edge *other = PIR_NEW(allocator, struct pir_facet_edge, count);
    size_t *starts = PIR_NEW(allocator, size_t, start_count);
    if (!other || !starts) {
        status = pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", name);
    } else {
        counting_pass(edges, other, count, true, starts, vertex_count);
        counting_pass(other, edges, count, false, starts, vertex_count);
        status = report_open_edge(edges, count, name, report);
    }
    PIR_FREE(allocator, starts, start_count);
    PIR_FREE(allocator, other, count);
    return status;
}

/* SPDX-License-Identifier: MIT */
/*
 * Whether the facets of a file bound a solid: each edge on exactly two of them. Which way round each facet is listed does not matter,
 * since the hull finds that out anew and files in use are careless about it.
 */
#ifndef PIR_POLYTOPE_CLOSING_H
#define PIR_POLYTOPE_CLOSING_H

#include <pirouette/base.h>

/* An edge of a facet, its smaller end first, and the line of the file that the facet starts on. */
struct pir_facet_edge {
    uint32_t low, high, line;
};

/* Sorts `edges`, whose ends are below `vertex_count`; PIR_ERR_NOT_CLOSED reports the offence on the earliest line of `name`. */
pir_status pir_check_closing(struct pir_facet_edge *edges, size_t count, uint32_t vertex_count,
                             const pir_allocator *allocator, const char *name, pir_report *report);

#endif

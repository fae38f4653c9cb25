/* SPDX-License-Identifier: MIT */
/* The shells of a body's surface: how many, how they lie in each other, the volume and the genus; and what is counted
 * once coplanar neighbours are one facet. */
#ifndef PIR_SOLID_BODY_SHELLS_H
#define PIR_SOLID_BODY_SHELLS_H

#include "solid/body/solid_body.h"

typedef struct pir_shell_body_counts {
    uint32_t vertices, edges, facets; /* as given */
    uint32_t merged_vertices, merged_edges, merged_facets;
    uint32_t reflex_edges; /* merged ones */
    uint32_t shells;
    int64_t genus; /* of all shells together */
} pir_shell_body_counts;

/*
 * Fills *ret_counts, and ret_six_volume, initialised, with six times the volume in units of the points. PIR_ERR_FORMAT,
 * reported with a facet, where a shell is inside out, holds no volume, or lies doubly over another.
 */
pir_status pir_shell_body_check_shells(pir_shell_body *body, pir_shell_body_counts *ret_counts, mpz_ptr ret_six_volume);

#endif

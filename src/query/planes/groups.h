/* SPDX-License-Identifier: MIT */
/*
 * The pieces of the sum's pairing in groups of neighbours, and their planes.
 *
 * A group of P's holds some facets of P, the edges whose left facet is one of them, and the edge pairs of those
 * edges. It also lists the facets at the far ends of its edges, because its bounds need them. A group of Q's holds
 * some facets of Q. Groups of Q begin at a whole block of lanes, behind empty groups, so that all groups of a block
 * are of one body.
 *
 * The planes of a group are made when they are asked for, and stay until pir_groups_forget.
 */
#ifndef PIR_QUERY_PLANES_GROUPS_H
#define PIR_QUERY_PLANES_GROUPS_H

#include "dymsum/pairing/pairing.h"
#include "query/decide/piece_plane.h"
#include "query/planes/scan.h"

typedef struct pir_group {
    /* its parts of the lists; facets past own_end are neighbours, which only its bound needs */
    bool of_q;
    uint32_t middle; /* the facet that its other facets are nearest to */
    uint32_t facets, own_end, facets_end, edges, edges_end;
    /* its planes, which are made where stamp is that of the groups; padded to whole blocks */
    uint64_t stamp;
    uint32_t start, count;
    uint64_t sieved; /* the stamp at which it was sieved last */
} pir_group;

/* The facets and edges of all groups, group after group, with their coordinates in their bodies' frames. */
typedef struct pir_group_lists {
    uint32_t *facet, facet_count;
    pir_lanes facet_normal;
    double *facet_offset;
    uint32_t *edge, edge_count;
    uint32_t *edge_left, *edge_right; /* the places of an edge's facets in the list of its group */
    pir_lanes edge_direction, edge_origin;
} pir_group_lists;

/* Work space for one group: its edges rotated, and vectors of its planes. */
typedef struct pir_group_work {
    pir_lanes direction, origin;
    pir_lanes vector[3];
    uint32_t edges, capacity;
} pir_group_work;

typedef struct pir_groups {
    const pir_frame *frame;
    pir_exact *exact;
    const pir_pairing *pairing;
    const pir_scan *scan;
    uint64_t stamp; /* changes with every rotation, and whenever planes are forgotten */
    pir_group *at;
    /* groups of P from 0, groups of Q from first_of_q; each followed by empty ones up to whole lanes */
    uint32_t count, of_p, of_q, first_of_q;
    pir_group_lists list;
    pir_group_work work;
    pir_planes planes;
} pir_groups;

/*
 * Makes the memory and the groups, which depend on normals alone. frame, exact and pairing must be set. False when
 * out of memory; pir_groups_finish then frees what is there.
 */
bool pir_groups_init(pir_groups *groups, const pir_allocator *allocator);
void pir_groups_finish(pir_groups *groups, const pir_allocator *allocator);

/* Fills in what depends on the frame's coordinates. */
void pir_groups_fill(pir_groups *groups);

/* Makes room for the planes of the present pairing: PIR_ERR_MEMORY. */
pir_status pir_groups_reserve(pir_groups *groups, const pir_allocator *allocator);

/* Forgets all planes and everything else that is known for the present stamp. */
static inline void pir_groups_forget(pir_groups *groups) {
    groups->stamp++;
    groups->planes.used = 0;
}

/* The piece of a facet of P, and of a facet of Q, in the pairing. */
static inline pir_piece pir_piece_fv(const pir_groups *groups, uint32_t f) {
    return (pir_piece){PIR_FACET_FV, f, groups->pairing->fv[f]};
}

static inline pir_piece pir_piece_vf(const pir_groups *groups, uint32_t g) {
    return (pir_piece){PIR_FACET_VF, groups->pairing->vf[g], g};
}

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The facets and edges of one body in groups of neighbours, with their coordinates in the body's frame, and a cap for
 * each group (bounds.c).
 *
 * A group of P's holds some facets of P and the edges whose left facet is one of them. It also lists the facets at the
 * far ends of its edges, because its bounds need them. A group of Q's holds some facets of Q. The last groups are
 * empty, so that there are whole lanes of groups.
 *
 * All of this depends on one polytope, its part and the exponent of its frame. So it is made when it is first asked
 * for, stays with the polytope (polytope/attachment.h), and is shared by all queries and threads. Which facets are
 * neighbours depends on normals alone, which are the same at every scale: the groups of a scaled body are copied.
 */
#ifndef PIR_QUERY_DEPTH_GROUP_LISTS_H
#define PIR_QUERY_DEPTH_GROUP_LISTS_H

#include "polytope/attachment.h"
#include "query/frame/frame.h"
#include "query/frame/lanes.h"

/* Facets in a whole number of lanes. */
static inline uint32_t pir_whole_lanes(uint32_t count) {
    return (count + PIR_SCAN_LANES - 1) / PIR_SCAN_LANES * PIR_SCAN_LANES;
}

/* The parts of the lists that are one group's; facets past own_end are neighbours, which only its bound needs. */
typedef struct pir_group_range {
    uint32_t middle; /* the facet that its other facets are nearest to */
    uint32_t facets, own_end, facets_end, edges, edges_end;
} pir_group_range;

typedef struct pir_group_lists {
    pir_attachment attachment;
    const pir_polytope *polytope;
    bool of_q;
    uint32_t used, count; /* groups, and with those that are empty */
    pir_group_range *at;
    uint32_t *facet, facet_count, facet_capacity;
    pir_lanes facet_normal;
    double *facet_offset;
    uint32_t *edge, edge_count;
    uint32_t *edge_left, *edge_right; /* the places of an edge's facets in the list of its group */
    pir_lanes edge_direction, edge_origin;
    pir_lanes cap_axis, cap_corner;
    double *cap_cosine, *cap_sine; /* of the angle of the cap */
} pir_group_lists;

/*
 * The groups of a body, whose polytope is `p`, in the frame of an exponent, as P or as Q. `like` has the same groups,
 * of the same body at another scale, or is NULL. PIR_ERR_MEMORY.
 */
pir_status pir_group_lists_of(pir_polytope *p, const pir_body *body, int exponent, bool of_q,
                              const pir_group_lists *like, const pir_group_lists **ret_lists);

#endif

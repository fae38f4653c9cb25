/* SPDX-License-Identifier: MIT */
/*
 * The inside of a live mesh.
 *
 * Facet slots have the numbers of the sum's certificates: facets of P, then facets of Q, then crossings by slot. Each
 * has a fixed place for its corners: as many as its facet has, four for a crossing.
 *
 * Invariants after a refresh:
 *   - fv, vf, edge and half are the sum's; fv and vf are PIR_NO_SLOT, edge is PIR_NO_CROSSING, in an empty slot;
 *   - the corners of each slot that is not empty name the vertex slots of its pairs.
 */
#ifndef PIR_DYMSUM_LIVE_LIVE_MESH_H
#define PIR_DYMSUM_LIVE_LIVE_MESH_H

#include <pirouette/live_mesh.h>

#include "dymsum/live/live_pairs.h"
#include "dymsum/live/live_vertices.h"
#include "dymsum/view.h"

/* How many of each there are, as long as the mesh lives. */
typedef struct pir_live_sizes {
    uint32_t facets_p, facets_q, vertices_p;
    uint32_t corners_fixed; /* before the first crossing's */
} pir_live_sizes;

/* Arrays that grow with the sum's room for crossings. */
typedef struct pir_live_slots {
    uint32_t capacity, used; /* crossings */
    uint32_t *edge, *half;   /* per crossing */
    uint32_t *corner;        /* corners_fixed, then four a crossing */
    uint32_t *rewritten;     /* room for every facet slot */
    uint64_t *dirty;         /* a bit for every facet slot, none set between refreshes */
} pir_live_slots;

struct pir_live_mesh {
    pir_sum *sum;               /* a reference */
    const pir_pairing *pairing; /* of the sum */
    pir_allocator allocator;
    pir_live_sizes sizes;
    uint32_t *fv, *vf; /* with edge and half: what the corners were written from */
    pir_vec3 *turned;  /* room for the vertices of P */
    pir_live_slots slots;
    pir_live_vertices vertices;
    pir_live_pairs appeared, disappeared;
    uint32_t rewritten_count;
    uint64_t seen; /* entries of the sum's journal that have been read */
    bool stale;    /* all is to be compared, whatever the journal says */
    pir_cone cone; /* only facets whose normals are in it are held */
};

/* The rotation that the sum shows. */
static inline const pir_mat3 *pir_live_matrix(const pir_live_mesh *live) {
    return &pir_sum_shown_rotation(live->sum)->r;
}

#endif

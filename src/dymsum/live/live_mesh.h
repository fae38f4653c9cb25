/* SPDX-License-Identifier: MIT */
/*
 * The inside of a live mesh.
 *
 * Facet slots are the numbers of the sum's certificates: facets of P, facets of Q, crossings by slot. Each has a fixed
 * place for its corners: as many as its facet has, four for a crossing.
 *
 * Invariants after a refresh:
 *   - fv, vf, edge and half are the sum's; fv and vf are PIR_NO_SLOT, edge is PIR_NO_CROSSING, in an empty slot;
 *   - a vertex slot's `uses` is the number of corners that name it; the free ones are chained through `next_free`;
 *   - the table finds the slot of every pair (vertex of P, vertex of Q) in use, by open addressing; it is at most half
 *     full.
 */
#ifndef PIR_DYMSUM_LIVE_LIVE_MESH_H
#define PIR_DYMSUM_LIVE_LIVE_MESH_H

#include <pirouette/live_mesh.h>

#include "dymsum/view.h"

#define PIR_NO_SLOT UINT32_MAX

/* Vertices in slots, found by pair. */
typedef struct pir_live_vertices {
    uint32_t (*pair)[2];
    uint32_t *uses, *next_free;
    uint32_t *idle; /* slots whose last use went, in this refresh, each once */
    uint8_t *is_idle;
    uint32_t capacity, used, free, idle_count;
    uint32_t *table; /* slots, or PIR_NO_SLOT; twice as many as capacity, a power of two */
} pir_live_vertices;

/* Pairs, as keys that order them by kind, p, q, and for callers. */
typedef struct pir_live_pairs {
    pir_sum_pair *at;
    uint64_t *key, *spare; /* spare: room to sort in */
    uint32_t count, capacity;
} pir_live_pairs;

/*
 * The bits of a feature's number in a key. Polytopes have fewer than 2^32 halfedges, and fewer features than half of
 * that.
 */
#define PIR_LIVE_NUMBER_BITS 31

struct pir_live_mesh {
    pir_sum *sum;               /* a reference */
    const pir_pairing *pairing; /* of the sum */
    pir_allocator allocator;
    uint32_t facets_p, facets_q, vertices_p, corners_fixed; /* corners_fixed: before the first crossing's */
    uint32_t *fv, *vf;                                      /* what the corners were written from */
    uint32_t *edge, *half;
    uint32_t capacity, used; /* crossings */
    uint32_t *corner;        /* corners_fixed + 4 · capacity */
    pir_live_vertices vertices;
    pir_live_pairs appeared, disappeared;
    uint32_t *rewritten, rewritten_count; /* room for every slot */
    uint64_t *dirty;                      /* a bit for every slot, none set between refreshes */
    uint64_t seen;                        /* entries of the sum's journal */
    bool stale;                           /* whatever the journal says, all is to be compared */
    pir_cone cone;                        /* only facets whose normals are in it are held */
    pir_vec3 *turned;                     /* room for the vertices of P */
};

/* The rotation that the sum is seen at. */
static inline const pir_mat3 *pir_live_matrix(const pir_live_mesh *live) {
    return &pir_sum_shown_rotation(live->sum)->r;
}

/* --- live_pairs.c --- */

/* Room for `capacity` pairs at least; false when out of memory, and nothing changes. */
bool pir_live_pairs_reserve(pir_live_pairs *pairs, const pir_allocator *allocator, uint32_t capacity);
void pir_live_pairs_finish(pir_live_pairs *pairs, const pir_allocator *allocator);

/* One more; there must be room. */
static inline void pir_live_pairs_note(pir_live_pairs *pairs, pir_facet_kind kind, uint32_t p, uint32_t q) {
    pairs->key[pairs->count++] = ((uint64_t)kind << PIR_LIVE_NUMBER_BITS | p) << PIR_LIVE_NUMBER_BITS | q;
}

/* When all are noted: sorts both lists, takes out of them what is in both, and writes them out. */
void pir_live_pairs_settle(pir_live_pairs *came, pir_live_pairs *went);

/* --- live_vertices.c --- */

/* Room for `capacity` vertices at least; false when out of memory, and nothing changes. */
bool pir_live_vertices_reserve(pir_live_vertices *vertices, const pir_allocator *allocator, uint32_t capacity);
void pir_live_vertices_finish(pir_live_vertices *vertices, const pir_allocator *allocator);

/* The slot of the pair, used once more; there must be room. */
uint32_t pir_live_vertex_take(pir_live_vertices *vertices, uint32_t p, uint32_t q);

/* Used once less. A slot without uses is kept for whoever takes its pair again, until the sweep empties it. */
void pir_live_vertex_drop(pir_live_vertices *vertices, uint32_t slot);
void pir_live_vertices_sweep(pir_live_vertices *vertices);

#endif

/* SPDX-License-Identifier: MIT */
/**
 * The mesh of a sum that turns, kept up to date: what did not change stays where it is.
 *
 * A live mesh has a facet for every pair of the pairing: an fv pair is a facet of P, a vf pair a facet of Q, an ee pair
 * a parallelogram. Pieces that are coplanar are not merged, as pir_sum_mesh merges them; together they bound the same
 * sum. Facets and vertices live in slots. A pair keeps its slot while updates carry it along, so a refresh rewrites
 * only what changed: slots come and go, and empty ones stay in between. Facet slots: first those of P's facets by
 * number, then those of Q's, then ee pairs.
 *
 * Coordinates and planes are worked out on demand, into memory of the caller's, all in one pass.
 *
 * A live mesh follows one sum and holds a reference to it, so the sum may be destroyed first; both belong to one thread
 * at a time.
 */
#ifndef PIROUETTE_LIVE_MESH_H
#define PIROUETTE_LIVE_MESH_H

#include <pirouette/base.h>
#include <pirouette/mesh.h>
#include <pirouette/sum.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_live_mesh pir_live_mesh;

/** A pair: facet of P and vertex of Q, vertex of P and facet of Q, or edge of P and edge of Q. */
typedef struct pir_sum_pair {
    pir_facet_kind kind; /**< PIR_FACET_FV, PIR_FACET_VF or PIR_FACET_EE */
    uint32_t p, q;       /**< the features' numbers in P and Q */
} pir_sum_pair;

/** A plane normal·x = offset; the normal is outward, of unit length within a few ulp. */
typedef struct pir_plane_equation {
    pir_vec3 normal;
    double offset;
} pir_plane_equation;

/**
 * Makes the live mesh of `sum` as it is now, with the sum's allocator.
 *
 * Cost: O(size of the sum).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_live_mesh_create(const pir_sum *sum, pir_live_mesh **ret_live);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_live_mesh_destroy(pir_live_mesh *live);

/**
 * Brings slots, pairs and corners to the pairing that the sum has now, and rewrites those that have changed. Allocates
 * only while the sum is larger than it has ever been. When the call fails the live mesh stays as it was.
 *
 * Cost: O(changes) where updates have led here since the last refresh and changed at most a thousand slots; O(size of
 * the sum) after a rebuild, and with a region.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_live_mesh_refresh(pir_live_mesh *live);

/**
 * From the next refresh on, holds only the facets whose outward normals, in the frame of Q, are within `half_angle`
 * radians of `axis`. Rounding errs towards holding, by less than 2e-6 radians. Facets that enter or leave the cone
 * count as appeared and disappeared. What the sum keeps does not change.
 *
 * axis        of any length but 0.
 * half_angle  from 0 to π. A greater one is the whole sphere.
 *
 * Cost: O(1); the next refresh takes O(size of the sum).
 *
 * Errors: PIR_ERR_ARGUMENT (an axis of zeros, a negative angle), PIR_ERR_NOT_FINITE.
 */
PIR_API pir_status pir_live_mesh_set_region(pir_live_mesh *live, pir_vec3 axis, double half_angle);

/**
 * From the next refresh on, holds all facets again, as before any region. NULL is accepted.
 *
 * Cost: O(1); the next refresh takes O(size of the sum).
 */
PIR_API void pir_live_mesh_clear_region(pir_live_mesh *live);

/**
 * The pairs that appeared in the last refresh, and those that disappeared; none is in both lists. Sorted by kind, p, q.
 * The one pair of two segments has two facets, and two slots: it appears with the first of them and disappears with the
 * last. Valid until the next refresh.
 *
 * Cost: O(1).
 */
PIR_API const pir_sum_pair *pir_live_mesh_appeared(const pir_live_mesh *live, uint32_t *ret_count);
PIR_API const pir_sum_pair *pir_live_mesh_disappeared(const pir_live_mesh *live, uint32_t *ret_count);

/** The facet slots whose corners the last refresh rewrote or emptied, rising. Valid until the next refresh. O(1). */
PIR_API const uint32_t *pir_live_mesh_rewritten(const pir_live_mesh *live, uint32_t *ret_count);

/** The number of slots, empty ones included. O(1). */
PIR_API uint32_t pir_live_mesh_facet_slots(const pir_live_mesh *live);
PIR_API uint32_t pir_live_mesh_vertex_slots(const pir_live_mesh *live);

/** The pair in a facet slot; false when it is empty. O(1). */
PIR_API bool pir_live_mesh_pair(const pir_live_mesh *live, uint32_t slot, pir_sum_pair *ret_pair);

/** The corners of a facet, vertex slots counter-clockwise from outside; *ret_count is 0 for an empty slot. O(1). */
PIR_API const uint32_t *pir_live_mesh_facet(const pir_live_mesh *live, uint32_t slot, uint32_t *ret_count);

/** The vertices of P and Q in a vertex slot; false when it is empty. O(1). */
PIR_API bool pir_live_mesh_vertex_pair(const pir_live_mesh *live, uint32_t slot, uint32_t ret_pair[2]);

/**
 * Writes the coordinates of all vertex slots, in the frame of Q, at the rotation of the sum now:
 * pir_live_mesh_vertex_slots of them, the same bits as in pir_sum_mesh. Empty slots get those of some point of the sum.
 * The second call rounds each to float.
 *
 * Cost: O(size of the sum).
 */
PIR_API void pir_live_mesh_vertices(pir_live_mesh *live, pir_vec3 *ret_vertices);
PIR_API void pir_live_mesh_vertices_float(pir_live_mesh *live, float (*ret_vertices)[3]);

/**
 * Writes the planes of all facet slots; an empty slot gets zeros. An ee pair of nearly parallel edges has next to no
 * area, and a normal as good as the rounding of its edges' product allows.
 *
 * Cost: O(size of the sum).
 */
PIR_API void pir_live_mesh_planes(pir_live_mesh *live, pir_plane_equation *ret_planes);

#ifdef __cplusplus
}
#endif

#endif

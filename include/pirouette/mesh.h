/* SPDX-License-Identifier: MIT */
/**
 * Meshes: the boundary of a polytope or of a sum, as vertices and maximal convex facets, for drawing and writing.
 *
 * A mesh is immutable and owned by whoever made it. Facets are counter-clockwise from outside, each starts at its
 * smallest vertex; vertices and facets stand in a canonical order that does not depend on how the sum was computed, so
 * two meshes of the same sum are equal array for array. Flat bodies: a polygon has two facets, a segment two vertices
 * and no facet, a point one vertex. Threads may read one mesh together.
 */
#ifndef PIROUETTE_MESH_H
#define PIROUETTE_MESH_H

#include <pirouette/base.h>
#include <pirouette/polytope.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_mesh pir_mesh;

/** Which features of P and Q a facet of the sum came from. */
typedef enum pir_facet_kind {
    PIR_FACET_FV = 0,    /**< a facet of P, a vertex of Q */
    PIR_FACET_VF,        /**< a vertex of P, a facet of Q */
    PIR_FACET_EE,        /**< an edge of each */
    PIR_FACET_MERGED,    /**< several coplanar pieces */
    PIR_FACET_TWO_SIDED, /**< of a sum of open solids: the sum is on both sides */
} pir_facet_kind;

/** Which coordinates a mesh of the sum carries. */
typedef enum pir_precision {
    PIR_DOUBLE = 0, /**< doubles, each within a few ulp of the exact coordinate relative to the size of the operands */
    PIR_EXACT,      /**< the same doubles, and exact rationals beside them (exact.h) */
} pir_precision;

/**
 * The boundary of `polytope`, exact coordinates included; every facet is of kind PIR_FACET_FV, every
 * vertex's pair is (v, 0).
 *
 * Cost: O(n) for n vertices.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_mesh_from_polytope(const pir_polytope *polytope, pir_mesh **ret_mesh);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_mesh_destroy(pir_mesh *mesh);

/** The number of vertices, and of facets. O(1). */
PIR_API uint32_t pir_mesh_vertex_count(const pir_mesh *mesh);
PIR_API uint32_t pir_mesh_edge_count(const pir_mesh *mesh);
PIR_API uint32_t pir_mesh_facet_count(const pir_mesh *mesh);

/** Coordinates in the frame of Q; valid as long as the mesh. O(1). */
PIR_API const pir_vec3 *pir_mesh_vertices(const pir_mesh *mesh);

/** The vertices of P and Q whose sum vertex `vertex` is. O(1). */
PIR_API void pir_mesh_pair(const pir_mesh *mesh, uint32_t vertex, uint32_t ret_pair[2]);

/** The corners of facet `facet`: *ret_count of them, valid as long as the mesh. O(1). */
PIR_API const uint32_t *pir_mesh_facet(const pir_mesh *mesh, uint32_t facet, uint32_t *ret_count);

/** The kind of features that facet `facet` of `mesh` is made of. O(1). */
PIR_API pir_facet_kind pir_mesh_facet_kind(const pir_mesh *mesh, uint32_t facet);

/**
 * The segments that no facet has for a side, two vertices each: only sums of open solids have such (pir_solid_sum).
 * Valid as long as the mesh.
 *
 * ret_count  how many segments there are.
 *
 * Cost: O(1).
 */
PIR_API const uint32_t *pir_mesh_segments(const pir_mesh *mesh, uint32_t *ret_count);

/**
 * The vertices that no facet or segment has: only sums of open solids have such. Valid as long as the mesh.
 *
 * ret_count  how many there are.
 *
 * Cost: O(1).
 */
PIR_API const uint32_t *pir_mesh_points(const pir_mesh *mesh, uint32_t *ret_count);

/** Whether the mesh holds exact coordinates beside the doubles. O(1). */
PIR_API bool pir_mesh_is_exact(const pir_mesh *mesh);

/**
 * Whether both have the same vertices (pairs and doubles, bit for bit) and the same facets. O(n).
 *
 * a, b  two meshes, which may be one.
 */
PIR_API bool pir_mesh_equal(const pir_mesh *a, const pir_mesh *b);

#ifdef __cplusplus
}
#endif

#endif

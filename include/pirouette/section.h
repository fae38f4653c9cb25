/* SPDX-License-Identifier: MIT */
/**
 * Planar sections of meshes: where a plane cuts a polytope or a sum.
 *
 * The section of a convex body is empty, a point, a segment or a convex polygon. Which edges and vertices of the mesh
 * it goes through is decided exactly, also where the plane holds vertices, edges or a facet of the body. The numbers
 * that give the plane are taken as they are, without rounding.
 *
 * A section is immutable and owned by whoever made it; it does not need its mesh any more. Threads may read one
 * section together.
 */
#ifndef PIROUETTE_SECTION_H
#define PIROUETTE_SECTION_H

#include <pirouette/base.h>
#include <pirouette/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_section pir_section;

/**
 * The points x of the body with normal·x = offset, in the frame and unit of length of `mesh`.
 *
 * mesh    holds exact coordinates (pir_mesh_is_exact); pir_mesh_section uses its allocator.
 * normal  finite, of any length but 0.
 * offset  finite; the plane's distance from the origin times the length of `normal`.
 *
 * The corners are counter-clockwise seen from where `normal` points to; no corner is straight. Two corners are a
 * segment, one a point, none an empty section. The order begins at the corner of the smallest edge.
 *
 * Cost: O(n log n) for the n corners of all facets, in exact arithmetic.
 *
 * Errors: PIR_ERR_ARGUMENT (no exact coordinates, a normal of length 0), PIR_ERR_NOT_FINITE, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_mesh_section(const pir_mesh *mesh, pir_vec3 normal, double offset, pir_section **ret_section);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_section_destroy(pir_section *section);

/** How many corners the section has. O(1). */
PIR_API uint32_t pir_section_corner_count(const pir_section *section);

/** The corners, each coordinate the double nearest to the exact one; valid as long as the section. O(1). */
PIR_API const pir_vec3 *pir_section_corners(const pir_section *section);

/**
 * The edge of the mesh that the plane cuts at a corner, by its two vertices, the smaller number first. Both are the
 * same vertex where the plane holds it.
 *
 * corner  a number below pir_section_corner_count.
 *
 * Cost: O(1).
 */
PIR_API void pir_section_edge(const pir_section *section, uint32_t corner, uint32_t ret_edge[2]);

#ifdef __cplusplus
}
#endif

#endif

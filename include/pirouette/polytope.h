/* SPDX-License-Identifier: MIT */
/**
 * Polytopes: bounded convex polyhedra, immutable and shared by reference count.
 *
 * A polytope is the exact convex hull of the points it is made from. Its facets are maximal (coplanar triangles are one
 * facet), its vertices are all extreme, and both facts are decided in exact arithmetic. Flat input is welcome: a
 * polygon is a polytope of dimension 2 whose two facets are its two sides, a segment has dimension 1, a point dimension
 * 0.
 *
 * Frame: body coordinates, right-handed. Facets are listed counter-clockwise seen from outside. Vertices keep the order
 * in which their points were given. Threads may share a polytope; the reference count is atomic.
 */
#ifndef PIROUETTE_POLYTOPE_H
#define PIROUETTE_POLYTOPE_H

#include <pirouette/base.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_polytope pir_polytope;

/** Options of the making of polytopes. */
typedef struct pir_polytope_options {
    size_t size;                    /**< of this struct, which pir_polytope_options_default sets (base.h) */
    const pir_allocator *allocator; /**< NULL for malloc; copied, its context must outlive the polytope */
    /**
     * A length, 0 or more. Where it is not 0, facets of the hull whose corners are within it of one plane become one
     * facet, as far as the polytope stays within this distance of the hull. 0 keeps the exact hull.
     *
     * For bodies that were turned or scaled in doubles before they came here: their flat sides are flat but for
     * rounding, so that each is several facets of the exact hull. A few 1e-15 of the greatest coordinate covers the
     * rounding; 1e-14 of it is a good choice.
     */
    double merge_tolerance;
} pir_polytope_options;

/** malloc, the exact hull. O(1). */
static inline pir_polytope_options pir_polytope_options_default(void) {
    const pir_polytope_options options = {sizeof(pir_polytope_options), NULL, 0};
    return options;
}

/**
 * Makes the exact convex hull of `count` points. Duplicate, interior, coplanar and collinear points are welcome.
 *
 * points   `count` finite points, in any order; copied.
 * options  NULL for the defaults.
 *
 * With a merge tolerance the hull's nearly coplanar facets are merged. Vertices within half the tolerance of the hull
 * of their neighbours are dropped, as points inside an edge or a facet are. The result is a convex polytope, exactly:
 * its facets are planar, its vertices, where merged facets meet, are rational. How far it is from the hull
 * pir_polytope_merge_bound tells. A facet stays as it was where merging it would take a vertex farther than the
 * tolerance, where four or more merged facets meet at a vertex, or where the exact coordinates would take more than
 * 32768 bits: the greater facets are merged first. Polytopes below dimension 3 are not merged.
 *
 * The caller owns one reference to *ret_polytope. Cost: O(n log n) expected for n points (quickhull: Barber, Dobkin,
 * Huhdanpaa, ACM TOMS 22(4), 1996, here with exact orientation signs), plus exact arithmetic where points are nearly
 * coplanar. Where facets merge, arithmetic on numbers whose length grows with the number of vertices of merged facets
 * comes on top. Errors: PIR_ERR_ARGUMENT (a negative tolerance too), PIR_ERR_EMPTY (count 0), PIR_ERR_NOT_FINITE (a
 * point, the tolerance), PIR_ERR_LIMIT (2^30 points or more), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_polytope_create(const pir_vec3 *points, size_t count, const pir_polytope_options *options,
                                       pir_polytope **ret_polytope);

/**
 * A bound on the Hausdorff distance between the polytope and the exact hull of the points it was made from, rounded up
 * and at most the merge tolerance; 0 where nothing was merged or dropped. It follows a polytope that is reflected or
 * scaled. A polytope read from the bytes of a sum is made from its own vertices: 0.
 *
 * Cost: O(1).
 */
PIR_API double pir_polytope_merge_bound(const pir_polytope *polytope);

/**
 * Gives −P, the reflection of `polytope` through the origin, made with the same allocator. Vertex i is minus vertex
 * i. The first call makes it, in O(n), and `polytope` keeps it: later ones cost O(1) and no memory, and give the same
 * object. The caller releases each. Any threads may call at once, where the allocator allows it.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_polytope_reflect(const pir_polytope *polytope, pir_polytope **ret_polytope);

/**
 * Makes factor·P, features under the same numbers, with the same allocator; `factor` is taken exactly. O(n). Errors:
 * PIR_ERR_NOT_FINITE, PIR_ERR_ARGUMENT (not positive), PIR_ERR_LIMIT (a coordinate beyond the doubles), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_polytope_scale(const pir_polytope *polytope, double factor, pir_polytope **ret_polytope);

/** Takes one more reference and returns the polytope. Thread-safe. O(1). */
PIR_API pir_polytope *pir_polytope_retain(pir_polytope *polytope);

/**
 * Gives one reference back; the last one frees. NULL is accepted. Thread-safe. O(1), and for the last reference the
 * time to free it.
 */
PIR_API void pir_polytope_release(pir_polytope *polytope);

/** The dimension of its affine hull, 0 to 3. O(1). */
PIR_API int pir_polytope_dimension(const pir_polytope *polytope);

/**
 * Vertices, edges and facets. A polygon has two facets (its sides); a segment has one edge and none; a point has one
 * vertex.
 *
 * Cost: O(1).
 */
PIR_API uint32_t pir_polytope_vertex_count(const pir_polytope *polytope);
PIR_API uint32_t pir_polytope_edge_count(const pir_polytope *polytope);
PIR_API uint32_t pir_polytope_facet_count(const pir_polytope *polytope);

/** Vertex `vertex`, rounded to the nearest double where the exact coordinate is none. O(1). */
PIR_API pir_vec3 pir_polytope_vertex(const pir_polytope *polytope, uint32_t vertex);

/**
 * The index, in the points it was made from, of the first point that became vertex `vertex`. Where facets were merged
 * that point may be as far from the vertex as pir_polytope_merge_bound.
 *
 * Cost: O(1).
 */
PIR_API uint32_t pir_polytope_source(const pir_polytope *polytope, uint32_t vertex);

/** The two vertices of edge `edge`, the smaller index first. O(1). */
PIR_API void pir_polytope_edge(const pir_polytope *polytope, uint32_t edge, uint32_t ret_vertices[2]);

/** The number of corners of facet `facet`. O(1). */
PIR_API uint32_t pir_polytope_facet_size(const pir_polytope *polytope, uint32_t facet);

/**
 * Writes the corners of facet `facet`, counter-clockwise from outside, to `ret_vertices`, room for
 * pir_polytope_facet_size.
 *
 * Cost: O(size of the facet).
 */
PIR_API void pir_polytope_facet(const pir_polytope *polytope, uint32_t facet, uint32_t *ret_vertices);

/** The outward unit normal of facet `facet`, within 8·2^-53 of the exact direction. O(1). */
PIR_API pir_vec3 pir_polytope_normal(const pir_polytope *polytope, uint32_t facet);

/**
 * Least and greatest coordinates.
 *
 * ret_low, ret_high  the corners of the box with edges along the axes.
 *
 * Cost: O(1).
 */
PIR_API void pir_polytope_bounds(const pir_polytope *polytope, pir_vec3 *ret_low, pir_vec3 *ret_high);

/** The volume, rounded; 0 when flat. O(n). */
PIR_API double pir_polytope_volume(const pir_polytope *polytope);

/**
 * A whole-structure check for tests: rings, twins, loops, Euler's formula, exact strict convexity. true when all hold.
 * O(n).
 */
PIR_API bool pir_polytope_is_valid(const pir_polytope *polytope);

#ifdef __cplusplus
}
#endif

#endif

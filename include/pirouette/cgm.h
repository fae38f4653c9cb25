/* SPDX-License-Identifier: MIT */
/**
 * Cubical Gaussian maps: exact dual representations of polytopes and of their Minkowski sums.
 *
 * The Gaussian map of a polytope divides the sphere of directions by which vertex is extreme: a facet is the point of
 * its outward normal, an edge an arc between two of them, a vertex a convex cell. The cubical map (Fogel and Halperin,
 * Exact and Efficient Construction of Minkowski Sums of Convex Polyhedra with Applications, 2006) projects it from the
 * centre onto the six faces of a cube, where arcs are straight segments: six planar maps, each bounded by a square. The
 * Minkowski sum of polytopes is the overlay of their maps: pir_cgm_overlay. An overlay is such a map again and may be
 * overlaid again.
 *
 * Everything combinatorial is exact, at the exact rotations M(q)/|q|² and without perturbation: arcs that overlap,
 * equal normals, normals on arcs, on cube edges and cube corners are ordinary.
 *
 * Maps are numbered 0 to 5 for the cube faces −x, −y, −z, +x, +y, +z. Vertices, halfedges and faces have numbers
 * that count through all six maps; those of one map are a range. Halfedges 2e and 2e + 1 are twins. Each map's first
 * face is the outer one, beyond its square. A direction on a cube edge is a vertex of two maps, one on a cube corner of
 * three.
 *
 * A map is immutable; threads may read one together.
 */
#ifndef PIROUETTE_CGM_H
#define PIROUETTE_CGM_H

#include <pirouette/base.h>
#include <pirouette/mesh.h>
#include <pirouette/polytope.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_cgm pir_cgm;

/** No feature: a source that has none here, a face beyond none. */
#define PIR_CGM_NONE UINT32_MAX

/**
 * Makes the map of a polytope.
 *
 * polytope   of any dimension; the map takes a reference.
 * rotation   NULL, or the rotation it is turned by, of any length but 0.
 * allocator  NULL for malloc; copied, its context must outlive the map.
 *
 * Release with pir_cgm_release. O(n log n) for n edges, O(n) but for sorting along cube edges. Errors:
 * PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_cgm_create(pir_polytope *polytope, const pir_quat *rotation, const pir_allocator *allocator,
                                  pir_cgm **ret_cgm);

/**
 * Makes the map of the sum: the overlay of `a` and `b`, which may be the same and are not kept. The sources of the
 * result are those of a, then those of b. Uses a's allocator.
 *
 * Cost: O(size of the result) as long as no cell has very many sides: an arc that crosses a cell looks at its sides
 * one by one. Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_cgm_overlay(const pir_cgm *a, const pir_cgm *b, pir_cgm **ret_cgm);

/** Takes one more reference and returns the map. Thread-safe. O(1). */
PIR_API pir_cgm *pir_cgm_retain(const pir_cgm *cgm);

/**
 * Gives a reference back; the last one, those of locators included, frees. Thread-safe. NULL is accepted. O(1), and for
 * the last reference the time to free it.
 */
PIR_API void pir_cgm_release(pir_cgm *cgm);

/**
 * The boundary of the polytope or sum that the map stands for: maximal facets, exact. Of one source it is equal to
 * pir_mesh_from_polytope but for the rotation; of two, P rotated and Q, to pir_sum_mesh. A vertex's pair holds the
 * vertices of the first two sources, the second being 0 where there is one; with more than two sources facet kinds
 * speak of the first two, too.
 *
 * precision  PIR_DOUBLE, or PIR_EXACT for rationals beside the doubles.
 *
 * Cost: O(size of the map).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_cgm_mesh(const pir_cgm *cgm, pir_precision precision, pir_mesh **ret_mesh);

/** The number of sources: 1 for the map of a polytope, the sum of both for an overlay. O(1). */
PIR_API uint32_t pir_cgm_source_count(const pir_cgm *cgm);

/** Source `source`; borrowed. O(1). */
PIR_API const pir_polytope *pir_cgm_source(const pir_cgm *cgm, uint32_t source);

/** The rotation of source `source`, as given; the identity where none was given. O(1). */
PIR_API pir_quat pir_cgm_source_rotation(const pir_cgm *cgm, uint32_t source);

/* --- traversal --- */

/** Vertices, halfedges and faces of one map, the square's and the outer face included, or of all six. */
typedef struct pir_cgm_counts {
    uint32_t vertices, halfedges, faces;
} pir_cgm_counts;

/** The counts of map `map`, 0 to 5, and those of all six maps. O(1). */
PIR_API pir_cgm_counts pir_cgm_map_counts(const pir_cgm *cgm, uint32_t map);
PIR_API pir_cgm_counts pir_cgm_total_counts(const pir_cgm *cgm);

/** The numbers of the first vertex, halfedge and face of map `map`, 0 to 5. O(1). */
PIR_API pir_cgm_counts pir_cgm_map_first(const pir_cgm *cgm, uint32_t map);

/** The name of a map: "-x", "-y", "-z", "+x", "+y", "+z". Static memory. O(1). */
PIR_API const char *pir_cgm_map_name(uint32_t map);

/** Where on the cube a vertex is. */
typedef enum pir_cgm_place {
    PIR_CGM_INTERIOR = 0, /**< within a cube face */
    PIR_CGM_EDGE,         /**< on a cube edge, not at a corner */
    PIR_CGM_CORNER,       /**< at a corner of the cube */
} pir_cgm_place;

typedef struct pir_cgm_vertex_info {
    uint32_t map;
    pir_cgm_place place;
    /** Whether a facet of the polytope or sum has this normal; else an arc meets a cube edge here, or a bare corner. */
    bool real;
    pir_vec3 direction; /**< unit vector, rounded */
    double x, y;        /**< in the square [−1, 1]² of its map, rounded */
    uint32_t half;      /**< a halfedge that leaves it; on the square, the one along it counter-clockwise */
    uint32_t copy;      /**< the same direction in the next map clockwise about it; itself when interior */
} pir_cgm_vertex_info;

typedef struct pir_cgm_halfedge_info {
    uint32_t origin, target;
    uint32_t twin, next; /**< next along the face on its left */
    uint32_t face;       /**< on its left */
    /** For a halfedge along the square, inside it: its opposite in the map beyond the cube edge; else PIR_CGM_NONE. */
    uint32_t beyond;
    bool real; /**< whether an edge of the polytope or sum maps here; else only the square */
} pir_cgm_halfedge_info;

typedef struct pir_cgm_face_info {
    uint32_t map;
    uint32_t half; /**< a halfedge that has it on its left */
    bool outer;    /**< whether it is the outer face of its map */
} pir_cgm_face_info;

/** A vertex, halfedge or face by its number, which must be below the total count. O(1). */
PIR_API pir_cgm_vertex_info pir_cgm_vertex_at(const pir_cgm *cgm, uint32_t vertex);
PIR_API pir_cgm_halfedge_info pir_cgm_halfedge_at(const pir_cgm *cgm, uint32_t halfedge);
PIR_API pir_cgm_face_info pir_cgm_face_at(const pir_cgm *cgm, uint32_t face);

/** The vertex at corner `corner` of map `map`: 0 to 3 in lexicographic order of (x, y). O(1). */
PIR_API uint32_t pir_cgm_corner(const pir_cgm *cgm, uint32_t map, uint32_t corner);

/** The halfedge after `halfedge` clockwise about its origin, within its map. O(1). */
PIR_API uint32_t pir_cgm_clockwise_after(const pir_cgm *cgm, uint32_t halfedge);

/**
 * The feature of source `source` at a feature of the map: the facet with this normal, the edge whose arc runs here, the
 * vertex that is extreme here; PIR_CGM_NONE where it has none, for an outer face, and for the hidden facets of a
 * segment.
 *
 * The feature is given by its number `vertex`, `halfedge` or `face`.
 *
 * Cost: O(1).
 */
PIR_API uint32_t pir_cgm_vertex_facet(const pir_cgm *cgm, uint32_t vertex, uint32_t source);
PIR_API uint32_t pir_cgm_halfedge_edge(const pir_cgm *cgm, uint32_t halfedge, uint32_t source);
PIR_API uint32_t pir_cgm_face_vertex(const pir_cgm *cgm, uint32_t face, uint32_t source);

/**
 * The support plane n·x = offset of the polytope or sum in the direction of a vertex, rounded: *ret_normal is the unit
 * vector, the offset is within a few ulp relative to the size of the sources. exact.h has it exactly.
 *
 * ret_normal, ret_offset  the plane's unit normal and offset.
 *
 * Cost: O(1).
 */
PIR_API void pir_cgm_vertex_plane(const pir_cgm *cgm, uint32_t vertex, pir_vec3 *ret_normal, double *ret_offset);

/* --- where a point is --- */

typedef enum pir_cgm_position {
    PIR_CGM_OUTSIDE = 0,
    PIR_CGM_BOUNDARY,
    PIR_CGM_INSIDE,
} pir_cgm_position;

/** An answer and what proves it. */
typedef struct pir_cgm_location {
    pir_cgm_position position; /**< exact; of the difference's map, inside means that the bodies overlap */
    uint32_t witness; /**< the vertex whose facet the ray from a point inside through the one asked about stabs */
    uint32_t steps;   /**< vertices that the walk went on to */
} pir_cgm_location;

typedef struct pir_cgm_locator pir_cgm_locator;

/**
 * Prepares a map for questions about points: chooses a point inside. The locator holds a reference to the map, which
 * may be destroyed first; it belongs to one thread at a time. O(n). Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_cgm_locator_create(const pir_cgm *cgm, pir_cgm_locator **ret_locator);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_cgm_locator_destroy(pir_cgm_locator *locator);

/**
 * Whether `point`, exactly as given, is inside the polytope or sum, on its boundary or outside (section 4 of Fogel and
 * Halperin). A local walk over the maps, from vertex to neighbouring vertex, on to the facet that the ray from the
 * inner point through `point` stabs.
 *
 * witness   the witness of an earlier answer, where the walk starts, or PIR_CGM_NONE.
 *
 * Bodies without an inside, and those too thin to have a double inside, have all vertices looked at instead; a flat
 * body's points are all on its boundary. Allocates nothing. Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE.
 *
 * locator  that of the map; its owner's thread alone may use it.
 *
 * Cost: O(steps of the walk); O(vertices) for the bodies without an inside.
 */
PIR_API pir_status pir_cgm_locate(pir_cgm_locator *locator, pir_vec3 point, uint32_t witness,
                                  pir_cgm_location *ret_location);

/* --- the rest --- */

/** How its signs were settled while it was made, and the memory it takes. */
typedef struct pir_cgm_statistics {
    uint64_t by_filter, by_exact;
    size_t bytes; /**< of its own arrays, without the polytopes */
} pir_cgm_statistics;

/** The counters of `cgm`. O(1). */
PIR_API pir_cgm_statistics pir_cgm_get_statistics(const pir_cgm *cgm);

/**
 * A whole-structure check for tests: true when every invariant of the six maps holds, geometry in exact arithmetic.
 *
 * Cost: O(n) for n features, with an exact test each.
 */
PIR_API bool pir_cgm_is_valid(const pir_cgm *cgm);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
/**
 * Surfaces of triangles as programs have them: triangle meshes and height fields, and what meets them.
 *
 * A pir_trimesh is a set of triangles. It need not bound anything: T-junctions, duplicate vertices, several shells and
 * triangles that cross are welcome. Triangles of no area, decided exactly, are counted and left out. A pir_height_field
 * is a grid of heights whose triangles are made when they are looked at. Both are immutable, count their references,
 * and keep a static tree of boxes, rounded outward.
 *
 * Whether a ray, a box or a ball meets a triangle, and which triangle is the nearest, is exact for the doubles given;
 * of equals the lowest number is told. Times, points and distances are doubles.
 *
 * Frame: that of the surface, right-handed. A triangle's front is the side from which its corners are
 * counter-clockwise. Unit: that of the coordinates, which are at most 2^60.
 *
 * Threads may read one surface together. Queries allocate nothing. The reference count is atomic.
 */
#ifndef PIROUETTE_TRIMESH_H
#define PIROUETTE_TRIMESH_H

#include <pirouette/base.h>
#include <pirouette/io.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_trimesh pir_trimesh;
typedef struct pir_height_field pir_height_field;

/** The number of no triangle. */
#define PIR_TRIANGLE_NONE UINT32_MAX

/** How the numbers of an array are stored. */
typedef enum pir_number_type {
    PIR_NUMBERS_DOUBLE = 0,
    PIR_NUMBERS_FLOAT,
} pir_number_type;

/** Triangles in memory. All arrays are borrowed for the call; strides are in bytes, 0 where elements touch. */
typedef struct pir_trimesh_arrays {
    const void *vertices; /**< three numbers each */
    pir_number_type vertex_type;
    size_t vertex_stride, vertex_count;
    const uint32_t *triangles; /**< three numbers of vertices each, counter-clockwise from the front */
    size_t triangle_stride, triangle_count;
    const uint32_t *materials; /**< a number of the caller's for each triangle, or NULL for 0 */
    size_t material_stride;
} pir_trimesh_arrays;

typedef struct pir_trimesh_options {
    size_t size;                    /**< of this struct, which pir_trimesh_options_default sets (base.h) */
    const pir_allocator *allocator; /**< NULL for malloc's; copied, its context must outlive the mesh */
    bool two_sided;                 /**< whether its triangles are met from behind as well */
} pir_trimesh_options;

/** malloc's memory, one-sided. O(1). */
static inline pir_trimesh_options pir_trimesh_options_default(void) {
    const pir_trimesh_options options = {sizeof(pir_trimesh_options), NULL, false};
    return options;
}

/**
 * Makes a mesh of arrays, which are copied.
 *
 * options   NULL for the defaults.
 * report    NULL, or filled when the call fails: it names the triangle or the vertex.
 * ret_mesh  the caller owns one reference.
 *
 * Memory: 24 bytes a vertex, 12 bytes a triangle, 4 more with materials, and at most 24 more for the tree.
 *
 * Cost: O(n log n) for n triangles: binned surface area heuristic (Wald, IEEE RT 2007), four children a node.
 *
 * Errors: PIR_ERR_ARGUMENT (NULL arrays, a stride too short, a corner that is no vertex), PIR_ERR_NOT_FINITE,
 * PIR_ERR_EMPTY (no triangle with an area), PIR_ERR_LIMIT (2^29 triangles or vertices, a coordinate beyond 2^60),
 * PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_trimesh_create(const pir_trimesh_arrays *arrays, const pir_trimesh_options *options,
                                      pir_report *report, pir_trimesh **ret_mesh);

/**
 * Reads a mesh from `path`, by its ending (PIR_READ_FORMATS). Facets of more than three corners are cut into
 * triangles, in the order of the file; they may be concave. Rationals of OFF are rounded to the nearest double.
 *
 * options, ret_mesh  as of pir_trimesh_create.
 * report             NULL, or filled when the call fails: it names the line or the facet.
 *
 * Cost: that of pir_trimesh_create, and O(k²) for a concave facet of k corners.
 *
 * Errors: those of reading (pir_polytope_read) and of pir_trimesh_create; PIR_ERR_FORMAT for a facet that
 * crosses itself, PIR_ERR_LIMIT for a concave one of more than 4096 corners.
 */
PIR_API pir_status pir_trimesh_read(const char *path, const pir_trimesh_options *options, pir_report *report,
                                    pir_trimesh **ret_mesh);

/**
 * A mesh from the bytes of a file in memory.
 *
 * file                       the bytes, and their format.
 * options, report, ret_mesh  as of pir_trimesh_read.
 *
 * Cost: as of pir_trimesh_read.
 *
 * Errors as of pir_trimesh_read, without PIR_ERR_FILE.
 */
PIR_API pir_status pir_trimesh_read_bytes(const pir_file_bytes *file, const pir_trimesh_options *options,
                                          pir_report *report, pir_trimesh **ret_mesh);

/** Another reference to `mesh`, which is returned. Thread-safe. O(1). */
PIR_API pir_trimesh *pir_trimesh_retain(pir_trimesh *mesh);

/**
 * Gives back a reference; the last one frees. NULL is accepted. Thread-safe. O(1), and for the last reference the time
 * to free it.
 */
PIR_API void pir_trimesh_release(pir_trimesh *mesh);

/** Counts and properties of a mesh. */
typedef struct pir_trimesh_info {
    uint32_t vertices, triangles; /**< as given */
    uint32_t degenerate;          /**< triangles without an area, which are left out */
    uint32_t parts;               /**< sets of triangles that share no vertex; points at one place are one vertex */
    bool closed;                  /**< whether every edge is on an even number of triangles */
    bool two_sided;
    pir_vec3 low, high; /**< bounds of the triangles that count */
    size_t tree_bytes;  /**< what the mesh takes beside its arrays */
} pir_trimesh_info;

/** Describes the mesh. O(n) for n triangles. */
PIR_API void pir_trimesh_describe(const pir_trimesh *mesh, pir_trimesh_info *ret_info);

/** A triangle as it stands. */
typedef struct pir_triangle_corners {
    pir_vec3 corner[3];
    uint32_t material;
} pir_triangle_corners;

/**
 * Triangle `triangle` as given, one without an area too. Cost: O(1). Errors: PIR_ERR_ARGUMENT (no triangle of the
 * mesh).
 *
 * ret_corners  its corners.
 */
PIR_API pir_status pir_trimesh_triangle(const pir_trimesh *mesh, uint32_t triangle, pir_triangle_corners *ret_corners);

/** A check of the whole tree for tests: every triangle once, every box around what is below it. O(n). */
PIR_API bool pir_trimesh_is_valid(const pir_trimesh *mesh);

/* --- height fields --- */

/**
 * A grid of heights over the plane z = 0. Sample (i, j), 0 ≤ i < columns, 0 ≤ j < rows, is number j·columns + i
 * and stands at (i·step_x, j·step_y, height). Cell (i, j) is number j·(columns − 1) + i. It has two triangles with
 * their front up: 2·cell with the corners (i, j), (i + 1, j), (i + 1, j + 1), and 2·cell + 1 with (i, j), (i + 1,
 * j + 1), (i, j + 1).
 */
typedef struct pir_height_samples {
    const void *heights; /**< rows · columns; all arrays are borrowed for the call and copied */
    pir_number_type type;
    uint32_t columns, rows;    /**< 2 to 32768 each */
    double step_x, step_y;     /**< above 0 */
    const uint32_t *materials; /**< one a cell, or NULL for 0 */
    const uint8_t *holes;      /**< one a cell, not 0 where there is no surface, or NULL for none */
} pir_height_samples;

typedef struct pir_height_options {
    size_t size;                    /**< of this struct, which pir_height_options_default sets (base.h) */
    const pir_allocator *allocator; /**< as of pir_trimesh_options */
    bool two_sided;
} pir_height_options;

/** malloc's memory, one-sided. O(1). */
static inline pir_height_options pir_height_options_default(void) {
    const pir_height_options options = {sizeof(pir_height_options), NULL, false};
    return options;
}

/**
 * Makes a height field. Heights at the corners of a hole alone may be anything, NaN too.
 *
 * options    NULL for the defaults.
 * report     NULL, or filled when the call fails: it names the sample.
 * ret_field  the caller owns one reference.
 *
 * Memory: the heights as they are given, 4 bytes a cell with materials, a bit a cell with holes, and 2.7 bytes a cell
 * for the tree, which is a pyramid of least and greatest heights.
 *
 * Cost: O(n) for n samples.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_EMPTY (nothing but holes), PIR_ERR_LIMIT (a coordinate beyond
 * 2^60, more than 32768 samples a side), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_height_field_create(const pir_height_samples *samples, const pir_height_options *options,
                                           pir_report *report, pir_height_field **ret_field);

/** Another reference to `field`, which is returned. Thread-safe. O(1). */
PIR_API pir_height_field *pir_height_field_retain(pir_height_field *field);

/**
 * Gives back a reference; the last one frees. NULL is accepted. Thread-safe. O(1), and for the last reference the time
 * to free it.
 */
PIR_API void pir_height_field_release(pir_height_field *field);

/** Counts and properties of a height field. */
typedef struct pir_height_info {
    uint32_t columns, rows;
    uint32_t triangles; /**< those of holes are not counted */
    bool two_sided;
    pir_vec3 low, high;
    size_t bytes, tree_bytes; /**< in all, and of these for the tree */
} pir_height_info;

/** Describes the field. O(1). */
PIR_API void pir_height_field_describe(const pir_height_field *field, pir_height_info *ret_info);

/**
 * Triangle `triangle` of the field. Cost: O(1). Errors: PIR_ERR_ARGUMENT (no triangle, or one of a hole).
 *
 * ret_corners  its corners.
 */
PIR_API pir_status pir_height_field_triangle(const pir_height_field *field, uint32_t triangle,
                                             pir_triangle_corners *ret_corners);

/* --- queries --- */

/** The surface of a query: a mesh, or where that is NULL a height field. */
typedef struct pir_surface_ref {
    const pir_trimesh *mesh;
    const pir_height_field *field;
} pir_surface_ref;

/** From which side a ray meets triangles. */
typedef enum pir_ray_sides {
    PIR_RAY_AS_SURFACE = 0, /**< the front, and the back too of a two-sided surface */
    PIR_RAY_FRONT,
    PIR_RAY_BACK,
    PIR_RAY_BOTH,
} pir_ray_sides;

/** The segment from `origin` to `origin` + `way`, both ends included. */
typedef struct pir_surface_ray {
    pir_vec3 origin, way; /**< within 2^60; a way of 0 meets nothing */
    pir_ray_sides sides;
} pir_surface_ray;

/** A triangle that a ray meets. */
typedef struct pir_ray_hit {
    uint32_t triangle; /**< PIR_TRIANGLE_NONE where it meets none */
    uint32_t material;
    double time; /**< a fraction of the way, 0 to 1 */
    bool back;   /**< met from behind */
    pir_vec3 point;
    pir_vec3 normal; /**< unit, towards the triangle's front */
} pir_ray_hit;

/**
 * The first triangle that a ray meets. A ray through an edge or a corner meets all triangles there, so it never slips
 * between two that share an edge: both decide by the same sign of ray and edge. A ray in the plane of a triangle does
 * not meet that triangle.
 *
 * surface, ray  borrowed for the call.
 * ret_hit       the least time; of equals, exactly, the lowest number.
 *
 * Cost: O(log n) where boxes are apart along the ray. Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT.
 */
PIR_API pir_status pir_surface_ray_nearest(pir_surface_ref surface, const pir_surface_ray *ray, pir_ray_hit *ret_hit);

/**
 * Whether a ray meets any triangle at all; it stops at the first that is found.
 *
 * surface, ray  as of pir_surface_ray_nearest.
 *
 * Cost: at most that of pir_surface_ray_nearest. Errors: as there.
 */
PIR_API pir_status pir_surface_ray_any(pir_surface_ref surface, const pir_surface_ray *ray, bool *ret_hits);

/**
 * All triangles that a ray meets, by rising time where all fit, of equal times in doubles by number.
 *
 * surface, ray        as of pir_surface_ray_nearest.
 * capacity, ret_hits  room for how many, and that room.
 * ret_count           how many there are, also beyond the capacity.
 *
 * Cost: O(log n + k log k) for k hits where boxes are apart along the ray. Errors: as of pir_surface_ray_nearest.
 */
PIR_API pir_status pir_surface_ray_all(pir_surface_ref surface, const pir_surface_ray *ray, size_t capacity,
                                       pir_ray_hit *ret_hits, size_t *ret_count);

/** Is told of one triangle after another; false ends the query. */
typedef bool pir_triangle_callback(void *context, uint32_t triangle);

/**
 * Tells `callback` of every triangle that shares a point with the box from `low` to `high`, edges along the axes,
 * boundaries included. Order: that of the tree.
 *
 * surface   borrowed for the call.
 * context   is handed to `callback`.
 *
 * Cost: O(log n + k) for k triangles whose boxes meet it. Errors: PIR_ERR_ARGUMENT (also where low is above high),
 * PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT.
 */
PIR_API pir_status pir_surface_box_each(pir_surface_ref surface, pir_vec3 low, pir_vec3 high,
                                        pir_triangle_callback *callback, void *context);

/**
 * The triangles that meet a box, as an array, in rising order where all fit.
 *
 * surface, low, high       as of pir_surface_box_each.
 * capacity, ret_triangles  room for how many, and that room.
 * ret_count                how many there are, also beyond the capacity.
 *
 * Cost: that of pir_surface_box_each, and O(k log k). Errors: as there.
 */
PIR_API pir_status pir_surface_box(pir_surface_ref surface, pir_vec3 low, pir_vec3 high, size_t capacity,
                                   uint32_t *ret_triangles, size_t *ret_count);

/** The point of a surface that is nearest to a point. */
typedef struct pir_surface_nearest {
    uint32_t triangle; /**< PIR_TRIANGLE_NONE where none is within the cutoff; of equals, exactly, the lowest number */
    uint32_t material;
    double distance;
    pir_vec3 point;
} pir_surface_nearest;

/**
 * The point of a surface nearest to `point`.
 *
 * surface      borrowed for the call.
 * cutoff       triangles that are farther are not told: a distance, or HUGE_VAL; exactly.
 * ret_nearest  distance and point within 2^-45 of the size of the coordinates.
 *
 * Cost: O(log n) where few boxes are as near as the nearest triangle. Errors: PIR_ERR_ARGUMENT (also a cutoff below 0),
 * PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT.
 */
PIR_API pir_status pir_surface_nearest_point(pir_surface_ref surface, pir_vec3 point, double cutoff,
                                             pir_surface_nearest *ret_nearest);

#ifdef __cplusplus
}
#endif

#endif

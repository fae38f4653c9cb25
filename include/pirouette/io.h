/* SPDX-License-Identifier: MIT */
/**
 * Models and meshes to and from files.
 *
 * OFF is read and written with exact rationals: a token `a/b` is that rational, an integer is itself, any other number
 * the nearest double; `#` starts a comment. OBJ, STL and PLY are read as the doubles nearest to their numbers, and
 * written so that the doubles come back: OBJ in decimals, PLY in binary with double properties, STL in binary where
 * floats hold every coordinate and as text where they do not. SVG is written only.
 *
 * Every call takes an optional report that, on failure, says in one line what was wrong, where (file and line) and why.
 */
#ifndef PIROUETTE_IO_H
#define PIROUETTE_IO_H

#include <stdio.h>

#include <pirouette/base.h>
#include <pirouette/mesh.h>
#include <pirouette/polytope.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The build takes their readers, files of src/polytope/read, from the lines that begin with FORMAT. */
/**
 * The formats that are read, by the endings of their files: PIR_READ_FORMATS(X) is X(off) X(obj) and so on.
 */
#define PIR_READ_FORMATS(FORMAT)                                                                                       \
    FORMAT(off)                                                                                                        \
    FORMAT(obj)                                                                                                        \
    FORMAT(stl)                                                                                                        \
    FORMAT(ply)

/** The surface that facets of a file make. An edge is two neighbouring corners of a facet; points at the
    same place are one corner. */
typedef enum pir_surface_form {
    PIR_SURFACE_POINTS = 0, /**< there are none: the file holds points alone */
    PIR_SURFACE_OPEN,       /**< some edge is on an odd number of them: they bound nothing */
    PIR_SURFACE_CLOSED,     /**< every edge is on an even number of them */
} pir_surface_form;

/**
 * A model as its file has it, before the hull of its points is taken. All of it is decided exactly.
 *
 * A closed surface is convex when it is the boundary of the hull, whichever way round its facets are listed, and
 * however many facets share a plane. A facet whose corners are in no one plane counts by the parts that the hull cuts
 * it into, when these make it up; in a body of dimension 2, facets count by their area on either side. Points alone are
 * convex when each place is a vertex of the hull.
 *
 * The volume takes a facet of more than three corners as a fan from its first, and is rounded from the exact one; of a
 * convex surface it is pir_polytope_volume of the hull. A closed surface whose neighbours are listed different ways
 * round is turned to face one way, each piece of it outward. An open surface is closed by pyramids from the origin over
 * its open edges: near the truth where it has cracks, and no more than a sum where it has holes; it is not turned.
 */
typedef struct pir_surface {
    pir_surface_form form;
    bool convex;     /**< whether the hull adds nothing; false for an open surface */
    uint32_t points; /**< as many as the file has, duplicates and points that no facet has included */
    uint32_t facets;
    /** The volume that the facets enclose, rounded; negative when they are clockwise seen from outside. NaN where there
        is none: points alone, or neighbours that face different sides however they are turned. */
    double volume;
} pir_surface;

/** How to read a model. */
typedef struct pir_read_options {
    size_t size;                    /**< of this struct, which pir_read_options_default sets (base.h) */
    const pir_allocator *allocator; /**< this and the next as of pir_polytope_options */
    double merge_tolerance;         /**< the surface is held against the exact hull, before facets are merged */
    bool require_convex;            /**< whether to refuse a model that is not convex, and say where */
} pir_read_options;

/** malloc, the exact hull, models of every form. O(1). */
static inline pir_read_options pir_read_options_default(void) {
    const pir_read_options options = {sizeof(pir_read_options), NULL, 0, false};
    return options;
}

/**
 * Reads the model in `path`, by its ending (PIR_READ_FORMATS), and makes the exact convex hull of all its points.
 *
 * options      NULL for the default.
 * ret_surface  NULL for the hull alone, or what the file holds beside its points.
 *
 * In OFF, indices count from 0 or, throughout a file, from 1; colours after them are passed over. In OBJ, other
 * statements than points and facets are passed over, and curves, surfaces and references to other files but materials
 * are refused; in PLY, all but x, y, z and vertex_indices is passed over. No other file is opened. Limits: a file of 2
 * GiB, a number of 4096 characters, a common denominator of 65536 bits. Cost: the hull of n points; for the surface,
 * which ret_surface and require_convex ask for, O(n log n) where each facet has a corner that an earlier one has, and
 * otherwise at most O(n) for each that has not.
 *
 * Errors: PIR_ERR_ARGUMENT (another ending), PIR_ERR_FILE, PIR_ERR_EMPTY, PIR_ERR_FORMAT, PIR_ERR_NOT_FINITE,
 * PIR_ERR_LIMIT, PIR_ERR_MEMORY; with require_convex, PIR_ERR_NOT_CLOSED (an open surface) and PIR_ERR_NOT_CONVEX.
 *
 * report        NULL, or filled when the call fails.
 * ret_polytope  the hull; the caller owns one reference.
 */
PIR_API pir_status pir_polytope_read(const char *path, const pir_read_options *options, pir_report *report,
                                     pir_surface *ret_surface, pir_polytope **ret_polytope);

/** A file in memory. */
typedef struct pir_file_bytes {
    const void *bytes; /**< borrowed; may be NULL when size is 0 */
    size_t size;
    const char *name;   /**< stands for the file in reports; NULL for "text" */
    const char *format; /**< "off", "obj", "stl" or "ply", in either case; NULL: by the ending of `name` */
} pir_file_bytes;

/**
 * pir_polytope_read of a file in memory. Text need not end in a zero.
 *
 * options, report, ret_surface, ret_polytope  as of pir_polytope_read.
 *
 * Limits as of pir_polytope_read. Cost: the hull of n points, and as there for the surface.
 *
 * Errors as of pir_polytope_read, without PIR_ERR_FILE.
 */
PIR_API pir_status pir_polytope_read_bytes(const pir_file_bytes *file, const pir_read_options *options,
                                           pir_report *report, pir_surface *ret_surface, pir_polytope **ret_polytope);

/**
 * Writes `mesh` to `path`, by its ending: .off, .obj, .stl, .ply, .svg.
 *
 * exact   for OFF only: write exact integers and a/b; the mesh must hold exact coordinates. Otherwise doubles that read
 *         back as themselves.
 *
 * A regular file is complete or absent: it is written under another name in its folder and then renamed, and keeps the
 * permissions that a file of its name had. Symbolic links are followed and stay. What is no regular file, such as a
 * device or a FIFO, is opened and written to, never replaced or removed.
 *
 * STL holds triangles, into which every facet is cut from its first corner. A mesh without facets, or of a sum of
 * solids, whose facets may have holes, is refused there.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE, PIR_ERR_MEMORY.
 *
 * report  NULL, or filled when the call fails.
 *
 * Cost: O(size of the mesh).
 */
PIR_API pir_status pir_mesh_write(const pir_mesh *mesh, const char *path, bool exact, pir_report *report);

/**
 * Writes a mesh to a stream, which is flushed and stays open.
 *
 * name    stands for the file in reports.
 * format  "off", "obj", "stl", "ply" or "svg".
 *
 * exact, report  as of pir_mesh_write.
 *
 * Cost: O(size of the mesh).
 *
 * Errors as of pir_mesh_write.
 */
PIR_API pir_status pir_mesh_write_stream(const pir_mesh *mesh, FILE *file, const char *name, const char *format,
                                         bool exact, pir_report *report);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
/**
 * Models and meshes to and from files.
 *
 * OFF is read and written by Pirouette itself, with exact rationals: a token `a/b` is that rational, an integer is itself,
 * any other number the nearest double; `#` starts a comment. OBJ, STL and PLY go through assimp where the build has it
 * (PIR_ERR_UNSUPPORTED where it has not), in float as that library keeps them. SVG is written only.
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

/**
 * Reads the model in `path`, by its ending (.off, .obj, .stl, .ply), and makes the exact convex hull of its points.
 * In OFF the facets, when there are any, must close: each edge on exactly two, either way round; the hull is of all points.
 * Their indices count from 0 or, throughout a file, from 1; colours after them are passed over. Limits: a file of 2 GiB, a number
 * of 4096 characters, a common denominator of 65536 bits. `options` as for pir_polytope_create, NULL for the defaults.
 *
 * Errors: PIR_ERR_ARGUMENT (another ending), PIR_ERR_FILE, PIR_ERR_EMPTY, PIR_ERR_FORMAT, PIR_ERR_NOT_FINITE, PIR_ERR_NOT_CLOSED,
 * PIR_ERR_LIMIT, PIR_ERR_UNSUPPORTED, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_polytope_read(const char *path, const pir_polytope_options *options, pir_report *report,
                                     pir_polytope **ret_polytope);

/** The same for OFF text in memory; `name` stands for the file in reports. The text need not end in a zero. */
PIR_API pir_status pir_polytope_read_off(const char *text, size_t size, const char *name,
                                         const pir_polytope_options *options, pir_report *report,
                                         pir_polytope **ret_polytope);

/**
 * Writes `mesh` to `path`, by its ending: .off, .obj, .stl, .ply, .svg.
 *
 * exact   for OFF only: write exact integers and a/b; the mesh must hold exact coordinates. Otherwise doubles that read back
 *         as themselves.
 *
 * A regular file is complete or absent: it is written under another name in its folder and then renamed, and keeps the permissions that a
 * file of its name had. Symbolic links are followed and stay. What is no regular file, such as a device or a FIFO, is opened and
 * written to, never replaced or removed.
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE, PIR_ERR_UNSUPPORTED, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_mesh_write(const pir_mesh *mesh, const char *path, int exact, pir_report *report);

/**
 * The same to a stream, which is flushed and stays open.
 *
 * name    stands for the file in reports.
 * format  "off", "obj", "stl", "ply" or "svg".
 */
PIR_API pir_status pir_mesh_write_stream(const pir_mesh *mesh, FILE *file, const char *name, const char *format,
                                         int exact, pir_report *report);

#ifdef __cplusplus
}
#endif

#endif

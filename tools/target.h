/* SPDX-License-Identifier: MIT */
/* Where an option says that results go: which names it may have, and meshes to be written there. */
#ifndef TOOLS_TARGET_H
#define TOOLS_TARGET_H

#include <stdbool.h>

#include <pirouette/mesh.h>

#include "args.h"
#include "file.h"

/* The endings that a mesh's file may have; a mesh that goes to a stream is OFF. */
#define TARGET_MESH ".off, .obj, .stl, .ply or .svg"

/*
 * Whether the value of option `name`, where it was given, ends in one of the `endings`, told in words as in
 * TARGET_MESH; NULL stands for any. A stream needs no ending, but standard output is not for it and --json. False
 * after a complaint.
 */
bool target_check(const struct args *args, const char *name, const char *endings);

/* Whether options `name` and `other`, where both were given, name two files. False after a complaint. */
bool targets_differ(const struct args *args, const char *name, const char *other);

/* Whether option `name` sends its results to standard output, where nothing else is printed then. */
bool target_is_stdout(const struct args *args, const char *name);

/* Writes the mesh to the open file, in the format that its path ends in, and commits it. False after a complaint. */
bool target_write_mesh(struct output_file *file, const pir_mesh *mesh, bool exact);

#endif

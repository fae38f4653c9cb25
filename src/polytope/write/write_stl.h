/* SPDX-License-Identifier: MIT */
/* Writing STL. The caller notices a stream in error. */
#ifndef PIR_POLYTOPE_WRITE_WRITE_STL_H
#define PIR_POLYTOPE_WRITE_WRITE_STL_H

#include <stdio.h>

#include <pirouette/mesh.h>

/*
 * STL to a stream. PIR_ERR_ARGUMENT, reported, for a mesh without facets, or with facets that need not be convex;
 * PIR_ERR_MEMORY.
 */
pir_status pir_mesh_write_stl(const pir_mesh *mesh, FILE *file, const char *name, pir_report *report);

#endif

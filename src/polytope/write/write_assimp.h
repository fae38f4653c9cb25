/* SPDX-License-Identifier: MIT */
/* Writing OBJ, STL and PLY. The caller notices a stream in error. */
#ifndef PIR_POLYTOPE_WRITE_WRITE_ASSIMP_H
#define PIR_POLYTOPE_WRITE_WRITE_ASSIMP_H

#include <stdio.h>

#include <pirouette/mesh.h>

/* OBJ, STL and PLY through assimp; `ending` is "obj", "stl" or "ply". Where the build has no assimp:
 * PIR_ERR_UNSUPPORTED. */
pir_status pir_mesh_write_assimp(const pir_mesh *mesh, FILE *file, const char *ending, const char *name,
                                 pir_report *report);

#endif

/* SPDX-License-Identifier: MIT */
/* Writing PLY. The caller notices a stream in error. */
#ifndef PIR_POLYTOPE_WRITE_WRITE_PLY_H
#define PIR_POLYTOPE_WRITE_WRITE_PLY_H

#include <stdio.h>

#include <pirouette/mesh.h>

/* PLY to a stream. */
void pir_mesh_write_ply(const pir_mesh *mesh, FILE *file);

#endif

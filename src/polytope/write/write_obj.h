/* SPDX-License-Identifier: MIT */
/* Writing OBJ. The caller notices a stream in error. */
#ifndef PIR_POLYTOPE_WRITE_WRITE_OBJ_H
#define PIR_POLYTOPE_WRITE_WRITE_OBJ_H

#include <stdio.h>

#include <pirouette/mesh.h>

/* OBJ to a stream. PIR_ERR_MEMORY. */
pir_status pir_mesh_write_obj(const pir_mesh *mesh, FILE *file);

#endif

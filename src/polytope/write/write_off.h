/* SPDX-License-Identifier: MIT */
/* Writing OFF. The caller notices a stream in error. */
#ifndef PIR_POLYTOPE_WRITE_WRITE_OFF_H
#define PIR_POLYTOPE_WRITE_WRITE_OFF_H

#include <stdbool.h>
#include <stdio.h>

#include <pirouette/mesh.h>

/* OFF to a stream: exact rationals where `exact`, else the shortest decimal that reads back as the same double. */
pir_status pir_mesh_write_off(const pir_mesh *mesh, FILE *file, bool exact);

#endif

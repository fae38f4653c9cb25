/* SPDX-License-Identifier: MIT */
/* The mesh of a sum of solids from its boundary. */
#ifndef PIR_SOLID_SUM_SOLID_MESH_H
#define PIR_SOLID_SUM_SOLID_MESH_H

#include <pirouette/mesh.h>

#include "solid/sum/boundary.h"
#include "solid/sum/operands.h"

/* With exact coordinates beside the doubles, or without. */
pir_status pir_solid_mesh_make(pir_operands *operands, const pir_sum_boundary *boundary, bool exact,
                               pir_mesh **ret_mesh);

#endif

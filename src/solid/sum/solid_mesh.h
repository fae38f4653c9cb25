/* SPDX-License-Identifier: MIT */
/* The mesh of a sum of solids, with exact coordinates, from its facets and what is on its own. */
#ifndef PIR_SOLID_SUM_SOLID_MESH_H
#define PIR_SOLID_SUM_SOLID_MESH_H

#include <pirouette/mesh.h>

#include "solid/glue/facet_loops.h"
#include "solid/sum/operands.h"
#include "solid/sum/touching.h"

/* The number of edges is the caller's to set. */
pir_status pir_solid_mesh_make(pir_operands *operands, const pir_union_outline *outline, const pir_loop_list *loops,
                               const pir_touching *points, pir_mesh **ret_mesh);

#endif

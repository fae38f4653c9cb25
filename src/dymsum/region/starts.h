/* SPDX-License-Identifier: MIT */
/* Where descents to the cells of one operand start, by direction: see starts.c. */
#ifndef PIR_DYMSUM_REGION_STARTS_H
#define PIR_DYMSUM_REGION_STARTS_H

#include "dymsum/kernels/kernels.h"

/* Starts for descents over the rings of `facets`, a polytope of `vertices` vertices. False when out of memory. */
bool pir_starts_init(pir_starts *starts, const pir_kernels *kernels, const pir_facets *facets, uint32_t vertices,
                     const pir_allocator *allocator);
void pir_starts_finish(pir_starts *starts, const pir_allocator *allocator);

#endif

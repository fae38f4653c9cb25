/* SPDX-License-Identifier: MIT */
/* Reading PLY: the whole file in memory into an empty model. */
#ifndef PIR_POLYTOPE_READ_READ_PLY_H
#define PIR_POLYTOPE_READ_READ_PLY_H

#include "polytope/surface/model.h"

pir_status pir_read_ply(const char *data, size_t size, struct pir_model *model);

#endif

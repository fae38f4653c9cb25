/* SPDX-License-Identifier: MIT */
/* Reading OBJ: the whole file in memory into an empty model. */
#ifndef PIR_POLYTOPE_READ_READ_OBJ_H
#define PIR_POLYTOPE_READ_READ_OBJ_H

#include "polytope/surface/model.h"

pir_status pir_read_obj(const char *data, size_t size, struct pir_model *model);

#endif

/* SPDX-License-Identifier: MIT */
/* Reading OFF: the whole file in memory into an empty model. */
#ifndef PIR_POLYTOPE_READ_READ_OFF_H
#define PIR_POLYTOPE_READ_READ_OFF_H

#include "polytope/surface/model.h"

pir_status pir_read_off(const char *data, size_t size, struct pir_model *model);

#endif

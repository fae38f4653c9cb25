/* SPDX-License-Identifier: MIT */
/* The readers of formats: pir_read_off in read_off.c and so on. Each reads a whole file, in memory, into a model. */
#ifndef PIR_POLYTOPE_READ_READERS_H
#define PIR_POLYTOPE_READ_READERS_H

#include <pirouette/io.h>

#include "polytope/surface/model.h"

/* The model is empty before. */
typedef pir_status pir_reader(const char *data, size_t size, struct pir_model *model);

#define PIR_DECLARE_READER(name) pir_reader pir_read_##name;
PIR_READ_FORMATS(PIR_DECLARE_READER)
#undef PIR_DECLARE_READER

#endif

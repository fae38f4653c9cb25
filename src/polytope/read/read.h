/* SPDX-License-Identifier: MIT */
/*
 * The readers, one per format. Each gets the whole file in memory and fills an empty model, or reports what is wrong,
 * where and why. They open no other file, run nothing, and allocate nothing on the word of a count that the bytes of
 * the file do not bear out.
 */
#ifndef PIR_POLYTOPE_READ_READ_H
#define PIR_POLYTOPE_READ_READ_H

#include "polytope/surface/model.h"

pir_status pir_read_off(const char *data, size_t size, struct pir_model *model);
pir_status pir_read_obj(const char *data, size_t size, struct pir_model *model);
pir_status pir_read_stl(const char *data, size_t size, struct pir_model *model);
pir_status pir_read_ply(const char *data, size_t size, struct pir_model *model);

#endif

/* SPDX-License-Identifier: MIT */
/* Models from files and bytes, for whoever makes something of them. */
#ifndef PIR_POLYTOPE_READ_READ_H
#define PIR_POLYTOPE_READ_READ_H

#include "polytope/surface/model.h"

/* The consumer of a model that was read. */
struct pir_model_maker {
    pir_status (*make)(const struct pir_model *model, void *context);
    void *context;
};

/* Reads a file, by file->format or by its ending, and hands the model to the maker, whose status is returned. */
pir_status pir_model_read_file(const char *path, const pir_allocator *allocator, pir_report *report,
                               struct pir_model_maker maker);
pir_status pir_model_read_bytes(const pir_file_bytes *file, const pir_allocator *allocator, pir_report *report,
                                struct pir_model_maker maker);

#endif

/* SPDX-License-Identifier: MIT */
/* A sealed file in HDF5, which reads it through the seal. See h5.h for who may call HDF5 when. */
#ifndef PIR_CSPACE_STORE_SEALED_FILE_H
#define PIR_CSPACE_STORE_SEALED_FILE_H

#include <hdf5.h>

#include "cspace/store/seal.h"

/* It stays where it is while it is open. */
typedef struct pir_sealed_file {
    pir_sealed sealed;
    hid_t driver, file; /* -1 when closed */
} pir_sealed_file;

/* Not open. */
#define PIR_NO_SEALED_FILE                                                                                             \
    { {.descriptor = -1}, -1, -1 }

/*
 * Opens a file for reading. pir_sealed_file_close releases whatever is there, whatever the outcome. Errors:
 * PIR_ERR_FILE, PIR_ERR_FORMAT, PIR_ERR_MEMORY.
 */
pir_status pir_sealed_file_open(pir_sealed_file *file, const char *path, const pir_allocator *allocator,
                                pir_report *report);
void pir_sealed_file_close(pir_sealed_file *file);

#endif

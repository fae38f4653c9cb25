/* SPDX-License-Identifier: MIT */
/*
 * HDF5 in the few forms that a file of slices has. Functions that return false have failed, and nothing is printed.
 */
#ifndef PIR_CSPACE_STORE_H5_H
#define PIR_CSPACE_STORE_H5_H

#include <hdf5.h>

#include "cspace/parts/pack.h"

/*
 * Between quiet and loud this thread alone is in HDF5, and what HDF5 would print is put aside. All other calls stand
 * between the two.
 */
typedef struct pir_h5_reports {
    H5E_auto2_t function;
    void *data;
} pir_h5_reports;

pir_h5_reports pir_h5_quiet(void);
void pir_h5_loud(pir_h5_reports reports);

/* Types of numbers in files. */
typedef enum pir_h5_type { PIR_H5_U8, PIR_H5_U32, PIR_H5_U64, PIR_H5_F64 } pir_h5_type;

/* The most dimensions here. */
#define PIR_H5_RANK 2

/* A data set: its dimensions, its type, the elements along each dimension that stand together in a chunk. */
typedef struct pir_h5_shape {
    pir_h5_type type;
    int rank;
    uint64_t size[PIR_H5_RANK];
    uint64_t chunk[PIR_H5_RANK];
    bool grows; /* along its first dimension */
    bool plain; /* not compressed */
} pir_h5_shape;

/* A group or data set in a group, or -1. Closed by pir_h5_close, which accepts -1. */
hid_t pir_h5_make_group(hid_t in, const char *name);
hid_t pir_h5_make_set(hid_t in, const char *name, const pir_h5_shape *shape);
hid_t pir_h5_open_group(hid_t in, const char *name);
bool pir_h5_close(hid_t id);

/*
 * A data set written whole, in chunks of whole rows that the packer packs. `data` may be NULL where it is empty.
 */
bool pir_h5_put(hid_t in, const char *name, const pir_h5_shape *shape, const void *data, pir_packer *packer);

/* Writes the rows of one such chunk, which begins at row `first`. */
bool pir_h5_put_rows(hid_t set, const pir_h5_shape *shape, uint64_t first, const void *data, pir_packer *packer);

/* Writes, or reads, a block of a data set: `count` elements from `start` on, along each dimension. */
bool pir_h5_write(hid_t set, pir_h5_type type, const uint64_t *start, const uint64_t *count, const void *data);
bool pir_h5_read(hid_t set, pir_h5_type type, const uint64_t *start, const uint64_t *count, void *data);

/*
 * Writes a chunk, which begins at `start`, as the data set keeps it: shuffled unless it is of bytes, and deflated
 * unless it is `stored`.
 */
bool pir_h5_write_chunk(hid_t set, const pir_h5_shape *shape, const uint64_t *start, const pir_chunk *chunk);

/* Makes a data set that grows `length` long. */
bool pir_h5_extend(hid_t set, const pir_h5_shape *shape, uint64_t length);

/*
 * Opens a data set that must have numbers of this type and `rank` dimensions; their sizes go to ret_size. -1 where it
 * is missing or another, where it stands in another file, or where one chunk of it would take more than 64 MiB.
 */
hid_t pir_h5_open_set(hid_t in, const char *name, pir_h5_type type, int rank, uint64_t *ret_size);

/* Attributes. Texts are of fixed length; one that is read is cut to `room`, its zero included. */
bool pir_h5_put_text(hid_t in, const char *name, const char *text);
bool pir_h5_put_numbers(hid_t in, const char *name, pir_h5_type type, const void *numbers, uint64_t count);
bool pir_h5_get_text(hid_t in, const char *name, char *ret_text, size_t room);
bool pir_h5_get_numbers(hid_t in, const char *name, pir_h5_type type, void *ret_numbers, uint64_t count);

#endif

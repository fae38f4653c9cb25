/* SPDX-License-Identifier: MIT */
/*
 * A file of slices that is open for reading. Nothing in it is trusted: its form is checked when it is opened, pieces
 * are made anew as exact hulls, and each unit is held against its checksum when it is read. Memory stays in proportion
 * to the pieces and to a unit, whatever numbers the file holds.
 */
#ifndef PIR_CSPACE_STORE_STORE_H
#define PIR_CSPACE_STORE_STORE_H

#include <pirouette/cspace.h>

#include "cspace/parts/unit.h"

typedef struct pir_store pir_store;

/* Errors: PIR_ERR_FILE, PIR_ERR_FORMAT, PIR_ERR_LIMIT, PIR_ERR_MEMORY, PIR_ERR_VERSION, PIR_ERR_NOT_BUILT (no HDF5). */
pir_status pir_store_open(const char *path, const pir_allocator *allocator, pir_report *report, pir_store **ret_store);

/* NULL is accepted. */
void pir_store_close(pir_store *store);

/* The file's numbers: grid, pieces, slices. The grid's spacing is the stored one, not computed. */
const pir_cspace_info *pir_store_info(const pir_store *store);

/* A piece as it was given: the robot's, then the obstacles'. Borrowed. */
pir_polytope *const *pir_store_pieces(const pir_store *store);

/* Rotations `first` up to `first + count`. Errors: PIR_ERR_FORMAT (one that turns nothing, too), PIR_ERR_FILE. */
pir_status pir_store_rotations(pir_store *store, uint64_t first, size_t count, pir_report *report,
                               pir_quat *ret_rotations);

/*
 * Reads one section of unit `number`, counted as in a plan; `unit` has room for slices_per_unit. Errors:
 * PIR_ERR_FORMAT, PIR_ERR_FILE, PIR_ERR_MEMORY.
 */
pir_status pir_store_unit(pir_store *store, pir_unit_section section, uint64_t number, pir_report *report,
                          pir_unit *unit);

#endif

/* SPDX-License-Identifier: MIT */
/* Bytes at places of an open file, all of them. */
#ifndef PIR_POLYTOPE_FILE_PLACES_H
#define PIR_POLYTOPE_FILE_PLACES_H

#include <pirouette/base.h>

/* Reads exactly so many bytes from `at` on: PIR_ERR_FORMAT where the file ends before, PIR_ERR_FILE. */
pir_status pir_read_at(int descriptor, void *data, size_t size, uint64_t at);

/* Writes so many bytes from `at` on; errno says why not. */
bool pir_write_at(int descriptor, const void *data, size_t size, uint64_t at);

#endif

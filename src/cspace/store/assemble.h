/* SPDX-License-Identifier: MIT */
/* The file of slices, made of all parts of a job. */
#ifndef PIR_CSPACE_STORE_ASSEMBLE_H
#define PIR_CSPACE_STORE_ASSEMBLE_H

#include "cspace/parts/parts.h"

/*
 * Writes the file under another name beside it, sees to it that it is on the disk, and gives it its name. All units
 * must stand in parts. What is in the file is a function of the plan alone. On failure the file of that name, if there
 * is one, is as it was; on success the new one has its permissions. Of the options `complete` and its context count.
 * Errors: PIR_ERR_FILE, PIR_ERR_FORMAT (a part that
 * has changed), PIR_ERR_MEMORY, PIR_ERR_NOT_BUILT without HDF5.
 */
pir_status pir_assemble(const pir_parts *parts, const pir_cspace_options *options, pir_report *report);

/* Whether the file is there and is that of the plan. It appears complete, so then nothing is left to make. */
bool pir_assembled(const pir_parts *parts);

#endif

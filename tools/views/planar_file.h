/* SPDX-License-Identifier: MIT */
/* Planar sections of all slices, added to their file. Needs HDF5. */
#ifndef TOOLS_VIEWS_PLANAR_FILE_H
#define TOOLS_VIEWS_PLANAR_FILE_H

#include "planar.h"

/*
 * Adds the group `planar` to the file of slices `path`, which then has it or is as it was; docs/slices.md says what it
 * holds. A file that has the group gets the new one. False after a complaint, in which the file is called `name`.
 */
bool planar_file_write(const char *path, const char *name, const struct planar *planar);

#endif

/* SPDX-License-Identifier: MIT */
/* Slices as a file of VTK, for ParaView. Needs HDF5. */
#ifndef TOOLS_VIEWS_VTK_H
#define TOOLS_VIEWS_VTK_H

#include "slices.h"

/* Writes the file `path`, which is complete or as it was. False after a complaint. */
bool vtk_write(const char *path, const struct slices *slices);

#endif

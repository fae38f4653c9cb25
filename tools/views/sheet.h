/* SPDX-License-Identifier: MIT */
/* A contact sheet of slices: a grid of small views, as SVG. */
#ifndef TOOLS_VIEWS_SHEET_H
#define TOOLS_VIEWS_SHEET_H

#include <stdio.h>

#include "planar.h"
#include "slices.h"

/*
 * Writes the sheet to an open file: the differences of all pairs of pieces, seen as one body, or, where a plane is
 * given, their sections. All views have one scale. False after a complaint.
 */
bool sheet_write(FILE *file, const struct slices *slices, const struct planar *planar);

#endif

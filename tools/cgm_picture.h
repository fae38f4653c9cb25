/* SPDX-License-Identifier: MIT */
/* The picture of a cubical Gaussian map: the cube unfolded, its six planar maps side by side. */
#ifndef TOOLS_CGM_PICTURE_H
#define TOOLS_CGM_PICTURE_H

#include <stdio.h>

#include <pirouette/cgm.h>

/*
 * Writes a whole SVG. Arcs of source 0 are red, of source 1 blue, of any other green, of several violet; what is not
 * real is grey.
 */
void cgm_picture_write(FILE *file, const pir_cgm *cgm);

#endif

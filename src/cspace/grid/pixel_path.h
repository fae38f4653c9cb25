/* SPDX-License-Identifier: MIT */
/*
 * A path through all pixels of a HEALPix map on which each pixel is a neighbour of the one before.
 *
 * Within a face it is Hilbert's curve, which begins and ends at two corners of one side. The faces follow each other
 * such that the curve of one ends beside the place where that of the next begins; a table says in which order, and how
 * each face's curve is turned or reflected.
 */
#ifndef PIR_CSPACE_GRID_PIXEL_PATH_H
#define PIR_CSPACE_GRID_PIXEL_PATH_H

#include "cspace/grid/pixel.h"

/* Pixel `rank` of the path, of 12·4^level, and back. O(level). */
pir_pixel pir_pixel_path_at(uint32_t level, uint32_t rank);
uint32_t pir_pixel_path_rank(uint32_t level, pir_pixel pixel);

#endif

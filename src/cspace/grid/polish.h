/* SPDX-License-Identifier: MIT */
/* Exchanges of steps that shorten a path through rotations. */
#ifndef PIR_CSPACE_GRID_POLISH_H
#define PIR_CSPACE_GRID_POLISH_H

#include <stdbool.h>
#include <stdint.h>

#include <pirouette/base.h>

/* How many nearest rotations of each are tried. */
#define PIR_POLISH_NEIGHBOURS 8

/*
 * Shortens the path `order` through `count` unit quaternions. False when out of memory; the path is then as it was.
 * O(n log n) expected.
 */
bool pir_polish(const pir_quat *unit, uint32_t count, const pir_allocator *allocator, uint32_t *order);

#endif

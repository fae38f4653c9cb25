/* SPDX-License-Identifier: MIT */
/* A path of small turns through a list of rotations. */
#ifndef PIR_CSPACE_GRID_CHAIN_H
#define PIR_CSPACE_GRID_CHAIN_H

#include <stdbool.h>
#include <stdint.h>

#include <pirouette/base.h>

/*
 * Writes the numbers 0 … count − 1 of unit quaternions to ret_order in the order of a path. False when out of
 * memory; ret_order is then undefined. O(n log n) expected.
 */
bool pir_chain_make(const pir_quat *unit, uint32_t count, const pir_allocator *allocator, uint32_t *ret_order);

#endif

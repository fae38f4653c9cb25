/* SPDX-License-Identifier: MIT */
/*
 * What a function is declared by that does nothing but fetch memory ahead. GCC takes one that it does not inline for a
 * function without effect, and leaves out its calls.
 */
#ifndef PIR_BASE_FETCHING_H
#define PIR_BASE_FETCHING_H

#define PIR_FETCHING static inline __attribute__((always_inline))

#endif

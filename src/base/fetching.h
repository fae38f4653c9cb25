/* SPDX-License-Identifier: MIT */
/*
 * Declares a function that does nothing but fetch memory ahead. GCC takes one that it does not inline for a
 * function without effect, and leaves out its calls.
 */
#ifndef PIR_BASE_FETCHING_H
#define PIR_BASE_FETCHING_H

#define PIR_FETCHING static inline __attribute__((always_inline))

/*
 * Fetches the line of `address` into the cache of the second level. That one waits for more lines at a time than the
 * first, and what is fetched well ahead would not stay there.
 */
#define PIR_FETCH(address) __builtin_prefetch((address), 0, 2)

#endif

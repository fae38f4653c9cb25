/* SPDX-License-Identifier: MIT */
/**
 * Scratch memory, one a thread. What works in it keeps nothing there from call to call, or makes it again where another
 * has used it in between, so that any number of sums, queries and pairs may share it.
 */
#ifndef PIROUETTE_WORKSPACE_H
#define PIROUETTE_WORKSPACE_H

#include <pirouette/base.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_workspace pir_workspace;

/**
 * Scratch for the pairs of one thread, and for the sums that are made with it (pir_sum_options), with their queries. It
 * belongs to one thread at a time, and all of these with it. `allocator` may be NULL. Errors: PIR_ERR_ARGUMENT,
 * PIR_ERR_MEMORY.
 *
 * Cost: O(1).
 */
PIR_API pir_status pir_workspace_create(const pir_allocator *allocator, pir_workspace **ret_workspace);

/**
 * Gives the workspace back; NULL is accepted. Sums that were made with it go on: they hold what they need of it, and
 * the allocator must outlive them.
 *
 * Cost: the time to free it.
 */
PIR_API void pir_workspace_destroy(pir_workspace *workspace);

#ifdef __cplusplus
}
#endif

#endif

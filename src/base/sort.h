/* SPDX-License-Identifier: MIT */
/* Sorting numbers: by an order that needs a context, and short lists of keys. */
#ifndef PIR_BASE_SORT_H
#define PIR_BASE_SORT_H

#include <stdbool.h>
#include <stdint.h>

/* Sorts item[0 .. count) so that no later item is `before` an earlier one; equal items keep their order. `work`
   has room for count items. */
void pir_sort(uint32_t *item, uint32_t count, uint32_t *work, bool (*before)(void *context, uint32_t a, uint32_t b),
              void *context);

/* Sorts a short list of keys; O(count²). */
void pir_sort_short(uint64_t *key, uint32_t count);

#endif

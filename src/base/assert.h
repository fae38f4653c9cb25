/* SPDX-License-Identifier: MIT */
/* PIR_ASSERT states what only a bug of ours could break; it is compiled out with NDEBUG. Bad input
   is a status, never this. */
#ifndef PIR_BASE_ASSERT_H
#define PIR_BASE_ASSERT_H

#include <assert.h>

#define PIR_ASSERT(condition) assert(condition)

#endif

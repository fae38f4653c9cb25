/* SPDX-License-Identifier: MIT */
/* PIR_ASSERT states what only a bug in the library could break; NDEBUG compiles it out. Bad input is a status, never an
   assertion. */
#ifndef PIR_BASE_ASSERT_H
#define PIR_BASE_ASSERT_H

#include <assert.h>

#define PIR_ASSERT(condition) assert(condition)

#endif

/* SPDX-License-Identifier: MIT */
/* The text of a polytope in memory. */
#ifndef PIR_POLYTOPE_WRITE_OFF_TEXT_H
#define PIR_POLYTOPE_WRITE_OFF_TEXT_H

#include <pirouette/polytope.h>

#include "base/byte_block.h"

/* The text of a polytope in exact OFF, in the allocator's memory. */
pir_status pir_off_text(const pir_polytope *polytope, const pir_allocator *allocator, pir_bytes *bytes);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * An allocator that counts, checks every size it is told against what it gave and that nothing was written behind a
 * block, and fails when asked to. Its balance is zero when nothing leaked.
 */
#ifndef PIR_TEST_MEMORY_H
#define PIR_TEST_MEMORY_H

#include <stdbool.h>

#include <pirouette/base.h>

typedef struct test_memory {
    size_t blocks, bytes; /* out at the moment */
    size_t peak;          /* the most bytes that were out */
    uint64_t requests;    /* for memory, so far */
    uint64_t fail_at;     /* the request, counted from 1, that fails; 0 for none */
    bool fail_after;      /* all requests after that one fail as well */
    bool wrong_size;      /* an old size did not match, or a block was overrun */
    bool overrun;         /* something was written behind the end of a block */
} test_memory;

/* An allocator on `memory`, which must stay where it is; it starts zeroed. */
pir_allocator test_allocator(test_memory *memory);

#endif

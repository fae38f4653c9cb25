/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a program on objects that stand on each other: see handle_program.h. See fuzz_sum.c for how to run an
 * engine.
 */
#include <stdint.h>

#include "fuzz/input.h"
#include "query/handle_program.h"

#define SIZE_LIMIT 4096

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    uint32_t step = 0;
    if (size > SIZE_LIMIT)
        return 0;
    const char *failed = handle_program_run(data, size, &step);
    fuzz_require(!failed, failed ? failed : "");
    return 0;
}

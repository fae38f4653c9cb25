/* SPDX-License-Identifier: MIT */
/* Which version of the kernels sums take: the linker sends the library's choice here, where it can. */
#include "base/processor.h"
#include "dymsum/kernels/kernels.h"
#include "golden/golden.h"

#if PIR_GOLDEN_WRAPS
static unsigned taken;

const pir_kernels *__wrap_pir_kernels_choose(void);
const pir_kernels *__wrap_pir_kernels_choose(void) {
    return pir_processor_version(taken)->kernels;
}

unsigned golden_kernels_count(void) {
    unsigned count = 0;
    while (pir_processor_version(count))
        count++;
    return count;
}

const char *golden_kernels_name(unsigned index) {
    return pir_processor_version(index)->kernels->name;
}

void golden_kernels_take(unsigned index) {
    taken = index;
}
#else
unsigned golden_kernels_count(void) {
    return 1;
}

const char *golden_kernels_name(unsigned index) {
    (void)index;
    return pir_kernels_choose()->name;
}

void golden_kernels_take(unsigned index) {
    (void)index;
}
#endif

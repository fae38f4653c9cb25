/* SPDX-License-Identifier: MIT */
/* The tables of loops: see processor.h. */
#include "base/processor.h"

#include <stdbool.h>

/* The loops of one version, which their rooms define. */
#define DECLARE(version)                                                                                               \
    extern const struct pir_relative_version pir_relative_##version;                                                   \
    extern const struct pir_scan pir_scan_##version;                                                                   \
    extern const struct pir_walker pir_walker_##version;                                                               \
    extern const struct pir_single_version pir_single_##version;                                                       \
    extern const struct pir_surface_loops pir_surface_##version;                                                       \
    extern const struct pir_axes_loops pir_axes_##version;                                                             \
    extern const struct pir_turned_box_loops pir_turned_box_##version

extern const struct pir_kernels pir_kernels_plain;
DECLARE(plain);
#if defined(__x86_64__)
extern const struct pir_kernels pir_kernels_avx2, pir_kernels_avx512;
DECLARE(avx2);
#elif defined(__aarch64__)
extern const struct pir_kernels pir_kernels_neon;
#endif

/* A table of one version of all loops but the kernels. */
#define TABLE(name, kernels, version)                                                                                  \
    {                                                                                                                  \
        name, &pir_relative_##version, kernels, &pir_scan_##version, &pir_walker_##version, &pir_single_##version,     \
            &pir_surface_##version, &pir_axes_##version, &pir_turned_box_##version                                     \
    }

const pir_processor *pir_processor_version(unsigned index) {
    static const pir_processor plain = TABLE("plain", &pir_kernels_plain, plain);
    const pir_processor *found[3] = {&plain};
    unsigned count = 1;
#if defined(__x86_64__)
    static const pir_processor avx2 = TABLE("AVX2", &pir_kernels_avx2, avx2),
                               avx512 = TABLE("AVX-512", &pir_kernels_avx512, avx2);
    const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (has_avx2)
        found[count++] = &avx2;
    if (has_avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        found[count++] = &avx512;
#elif defined(__aarch64__)
    static const pir_processor neon = TABLE("NEON", &pir_kernels_neon, plain);
    found[count++] = &neon;
#endif
    return index < count ? found[index] : NULL;
}

const pir_processor *pir_processor_best(void) {
    unsigned index = 0;
    while (pir_processor_version(index + 1))
        index++;
    return pir_processor_version(index);
}

/* SPDX-License-Identifier: MIT */
/* Which versions of the kernels this build has. */
#ifndef PIR_DYMSUM_KERNELS_KERNELS_VERSIONS_H
#define PIR_DYMSUM_KERNELS_KERNELS_VERSIONS_H

#include "dymsum/kernels/kernels.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define PIR_HAVE_X86_KERNELS 1
extern const pir_kernels pir_kernels_avx2, pir_kernels_avx512;
#elif defined(__aarch64__) && defined(__ARM_NEON)
#define PIR_HAVE_NEON_KERNELS 1
extern const pir_kernels pir_kernels_neon;
#endif

#endif

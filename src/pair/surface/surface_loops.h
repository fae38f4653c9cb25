/* SPDX-License-Identifier: MIT */
/* Which versions of a surface's loops this build has. */
#ifndef PIR_PAIR_SURFACE_SURFACE_LOOPS_H
#define PIR_PAIR_SURFACE_SURFACE_LOOPS_H

#include "pair/surface/inner_surface.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define PIR_HAVE_X86_SURFACE 1
extern const pir_surface_loops pir_surface_avx2;
#endif

#endif

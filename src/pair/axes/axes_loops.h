/* SPDX-License-Identifier: MIT */
/* Which versions of the loops over axes this build has. */
#ifndef PIR_PAIR_AXES_AXES_LOOPS_H
#define PIR_PAIR_AXES_AXES_LOOPS_H

#include "pair/axes/axes.h"

extern const pir_axes_loops pir_axes_plain;

#if defined(__x86_64__) && defined(__GNUC__)
#define PIR_HAVE_X86_AXES 1
extern const pir_axes_loops pir_axes_avx2;
#endif

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The loops that exist in versions for several processors: one table for each. Who makes an object with such a loop
 * takes it from the best table. All versions of a loop give the same bits, which tests compare with those of the plain
 * table. A table knows no more of a loop than its name; the room of the loop declares what it does.
 */
#ifndef PIR_BASE_PROCESSOR_H
#define PIR_BASE_PROCESSOR_H

#include <stddef.h>

typedef struct pir_processor {
    const char *name;
    const struct pir_relative_version *relative;   /* exact/relative_turn.h */
    const struct pir_kernels *kernels;             /* dymsum/kernels/kernels.h */
    const struct pir_scan *scan;                   /* query/depth/scan.h */
    const struct pir_walker *walker;               /* query/walk/walker.h */
    const struct pir_single_version *single;       /* query/contact/single.h */
    const struct pir_surface_loops *surface;       /* pair/surface/inner_surface.h */
    const struct pir_axes_loops *axes;             /* pair/axes/axes.h */
    const struct pir_turned_box_loops *turned_box; /* scene/world/turned_box.h */
} pir_processor;

/* Table `index` of those that this build has and this processor can use, the plain one first. NULL past the last. */
const pir_processor *pir_processor_version(unsigned index);

/* The last of them. */
const pir_processor *pir_processor_best(void);

#endif

/* SPDX-License-Identifier: MIT */
/* A file of slices of one pair of pieces at given rotations, in a folder of its own, asked for states. */
#ifndef PIR_TEST_EXTREME_SLICES_H
#define PIR_TEST_EXTREME_SLICES_H

#include <pirouette/cspace.h>

typedef struct slice_file {
    char folder[128], path[160];
    pir_cspace *cspace; /* NULL where the build has no HDF5, or the file could not be made */
} slice_file;

/* NULL, or what went wrong. */
const char *slice_file_make(slice_file *file, pir_polytope *p, pir_polytope *q, const pir_quat *rotations,
                            uint32_t count);
void slice_file_free(slice_file *file);

/* That the file gives this state for P at a rotation of it, moved by t. NULL, or what does not hold. */
const char *slice_file_check(slice_file *file, pir_quat rotation, pir_vec3 t, pir_state state);

#endif

/* SPDX-License-Identifier: MIT */
/* Files of models in every format and form that is read, to start mutating from. */
#ifndef PIR_FUZZ_MODEL_FILES_H
#define PIR_FUZZ_MODEL_FILES_H

#include <pirouette/mesh.h>

#include "fuzz/mutate.h"

enum model_form {
    MODEL_OFF = 0,
    MODEL_OFF_RATIONAL, /* every coordinate a third of itself, as a/b */
    MODEL_OBJ,
    MODEL_OBJ_FULL, /* with texture coordinates, normals, groups, comments and a folded line */
    MODEL_STL_ASCII,
    MODEL_STL_BINARY,
    MODEL_PLY_ASCII,
    MODEL_PLY_LITTLE, /* floats and uchar counts */
    MODEL_PLY_BIG,    /* doubles, colours and int counts */
    MODEL_FORM_COUNT,
};

/* "off", "obj", "stl" or "ply". */
const char *model_ending(enum model_form form);

/* The facets of `mesh` as a file, to be freed; STL holds them as fans of triangles. */
struct file_bytes model_file(const pir_mesh *mesh, enum model_form form);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The models of a path: one file, the objects of an OBJ file that has several, or a folder of such files, taken by the
 * order of their names.
 */
#ifndef TOOLS_MODELS_H
#define TOOLS_MODELS_H

#include <stdbool.h>

#include "args.h"

/* A model that was found; its strings are lent for the call. */
struct found_model {
    const char *path, *name; /* of the file; of the object, or of the file without its folders */
    const char *text;        /* of the object, in OBJ; NULL where the file is the model */
};

/* Takes a model; false ends the walk. */
typedef bool model_taker(void *context, const struct found_model *model);

/* Hands all models of a path to a taker. False where that has said so, or after a complaint: a folder that cannot be
 * read or has no models, memory. */
bool models_each(const struct args *args, const char *path, model_taker *take, void *context);

#endif

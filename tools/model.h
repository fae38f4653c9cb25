/* SPDX-License-Identifier: MIT */
/* A MODEL argument: a file, "-" for OFF on standard input, or shape:NAME for a built-in one. */
#ifndef TOOLS_MODEL_H
#define TOOLS_MODEL_H

#include <pirouette/pirouette.h>

#include "args.h"

/* The prefix of built-in models. */
#define MODEL_SHAPE "shape:"

/*
 * The polytope of positional argument `index`, its facets merged within --merge where that is given, to be released;
 * NULL after a complaint, also about a model that is not convex where --require-convex was given.
 *
 * ret_surface  NULL, or what the model was before its hull was taken.
 */
pir_polytope *model_load(const struct args *args, size_t index, pir_surface *ret_surface);

/* The polytope of a MODEL by its name, as of model_load. */
pir_polytope *model_of_path(const struct args *args, const char *model, pir_surface *ret_surface);

/* The polytope of a model's text in a format of pir_file_bytes; `name` stands for it in complaints. */
pir_polytope *model_of_text(const struct args *args, const char *name, const char *text, const char *format);

/* The name for titles: the file's without its folders. Points into `model`. */
const char *model_title(const char *model);

#endif

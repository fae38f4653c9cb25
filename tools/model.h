/* SPDX-License-Identifier: MIT */
/* A MODEL argument: a file, "-" for OFF on standard input, or shape:NAME for a built-in one. */
#ifndef TOOLS_MODEL_H
#define TOOLS_MODEL_H

#include <pirouette/pirouette.h>

#include "args.h"

/* The prefix of built-in models. */
#define MODEL_SHAPE "shape:"

/* The polytope, its facets merged within --merge where that is given, to be released; NULL after a complaint. */
pir_polytope *model_load(const struct args *args, const char *model);

/* The name for titles: the file's without its folders. Points into `model`. */
const char *model_title(const char *model);

#endif

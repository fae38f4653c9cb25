/* SPDX-License-Identifier: MIT */
/* Models as the solids that they are, not their hulls: what --solid asks for. */
#ifndef TOOLS_SOLID_H
#define TOOLS_SOLID_H

#include <pirouette/pirouette.h>

#include "args.h"

/* The solid of positional argument `index`, to be released; NULL after a complaint, as about --merge, which takes
 * hulls. */
pir_solid *solid_load(const struct args *args, size_t index);

/* info --solid and sum --solid. */
int solid_info(const struct args *args);
int solid_sum(const struct args *args);

#endif

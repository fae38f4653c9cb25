/* SPDX-License-Identifier: MIT */
/* Models as the solids that they are, not their hulls: what --solid asks for. */
#ifndef TOOLS_SOLID_H
#define TOOLS_SOLID_H

#include <pirouette/pirouette.h>

#include "args.h"

/* The solid of positional argument `index`, to be released; NULL after a complaint, as about --merge, which takes
 * hulls. */
/* Where solids and their pieces go as pictures, in this build: the end of a list of endings. */
#if PIR_HAVE_PNG
#define SOLID_PICTURE " or .png"
#else
#define SOLID_PICTURE ""
#endif

pir_solid *solid_load(const struct args *args, size_t index);

/* query --solid: what is asked, the motion of a cast or NULL, and what of the answer --certificate is to prove. */
int solid_query(const struct args *args, const pir_query_input *input, pir_quat rotation, const pir_vec3 *motion,
                int proven);

/* info --solid and sum --solid. */
int solid_info(const struct args *args);
int solid_sum(const struct args *args);

#endif

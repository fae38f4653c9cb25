/* SPDX-License-Identifier: MIT */
/*
 * Convex pieces of a body: a model, an OBJ file with several objects, each a piece, or a folder of such files, taken by
 * the order of their names. Functions that return false have complained.
 */
#ifndef TOOLS_PIECES_H
#define TOOLS_PIECES_H

#include <pirouette/pirouette.h>

#include "args.h"

struct pieces {
    pir_polytope **at; /* `count` of them, each released by pieces_release */
    uint32_t count, room;
};

/* Adds the pieces of positional argument `index`. */
bool pieces_load(const struct args *args, size_t index, struct pieces *pieces);

void pieces_release(struct pieces *pieces);

#endif

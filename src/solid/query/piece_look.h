/* SPDX-License-Identifier: MIT */
/* P's frame in Q's, in doubles, and what two pieces can be told to be by doubles alone. */
#ifndef PIR_SOLID_QUERY_PIECE_LOOK_H
#define PIR_SOLID_QUERY_PIECE_LOOK_H

#include <pirouette/pair.h>

#include "solid/pieces/compound.h"

typedef struct pir_relative {
    double turn[3][3], reach[3][3]; /* of P's frame into Q's, and its absolute values */
    double shift[3];
    double radii;
    double error; /* what distances and heights over planes are off by at most, each */
} pir_relative;

/* `input` is finite, and its rotations are not zero. */
pir_relative pir_relative_of(const pir_compound *p, const pir_compound *q, const pir_pair_input *input);

/* Whether an input is one that doubles may be tried for: finite, with rotations and radii of a usual size. */
bool pir_relative_is_plain(const pir_pair_input *input);

typedef enum pir_likely { PIR_LIKELY_UNKNOWN, PIR_CERTAINLY_APART, PIR_CERTAINLY_INSIDE } pir_likely;

/* Whether a plane of a face parts two pieces, grown by the radii, or one holds the middle of the other inside. */
pir_likely pir_pieces_look(const pir_relative *relative, const pir_compound *p, uint32_t i, const pir_compound *q,
                           uint32_t j);

#endif

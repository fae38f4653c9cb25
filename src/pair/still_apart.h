/* SPDX-License-Identifier: MIT */
/*
 * Apart still by more than the cutoff, without a frame.
 *
 * A call that found the bodies apart by more than the cutoff leaves the direction along which they are, and a distance
 * that they have along it for certain. Where the next call in that workspace has Q at the same place, P has gone along
 * that direction by what its origin has, less at most its turn times how fast its support changes. So the distance is
 * at least what that leaves.
 */
#ifndef PIR_PAIR_STILL_APART_H
#define PIR_PAIR_STILL_APART_H

#include "pair/pair.h"

/* Keeps a distance that the bodies have along the axis for certain at these poses, in units of the frame, or less. */
static inline void pir_pair_keep_left(pir_pair *pair, double distance) {
    const double most = 0x1p100;
    pair->left = (float)((distance < most ? distance : most) * (1 - 0x1p-20));
}

/*
 * Whether the bodies are apart by more than cutoff and radii, as the last call on this pair tells. The workspace is
 * then at these poses, without a frame. False too where the input may be wrong.
 */
bool pir_pair_still_apart(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Apart still by more than the cutoff, without a frame.
 *
 * A call that found the bodies apart leaves a distance that they have for certain. Where the next call in that
 * workspace has Q at the same place, no point of P has moved by more than the way of its origin and its turn times the
 * farthest point from there. So the distance is at least what that leaves.
 */
#ifndef PIR_PAIR_STILL_APART_H
#define PIR_PAIR_STILL_APART_H

#include "pair/pair.h"

/* Keeps a distance that the bodies have for certain at the poses of this call, in units of the frame, or less. */
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

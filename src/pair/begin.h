/* SPDX-License-Identifier: MIT */
/* Slow path of a call's beginning: its inputs changed since the call before. */
#ifndef PIR_PAIR_BEGIN_H
#define PIR_PAIR_BEGIN_H

#include "pair/pair.h"

/* Makes the frame one of the bodies of this pair. */
void pir_pair_set_bodies(const pir_pair *pair, pir_workspace *workspace);

/* Sets Q's place. */
pir_status pir_pair_set_q(pir_workspace *workspace, const pir_pose *q);

/* Sets P's rotation as Q sees it, where Q is turned or P's quaternion has to be scaled. */
pir_status pir_pair_set_any_rotation(pir_workspace *workspace, const pir_pair_input *input);

#endif

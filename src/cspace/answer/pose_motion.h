/* SPDX-License-Identifier: MIT */
/* Motions from pose to pose. */
#ifndef PIR_CSPACE_ANSWER_MOTION_H
#define PIR_CSPACE_ANSWER_MOTION_H

#include "cspace/answer/pose_answers.h"

/* Proves where the motion between two poses is free. Errors as of pir_answers_classify. */
pir_status pir_answers_segment(pir_answers *answers, const pir_pose *from, const pir_pose *to, pir_report *report,
                               pir_cspace_motion *ret_motion);

#endif

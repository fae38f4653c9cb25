/* SPDX-License-Identifier: MIT */
/* Poses and motions, asked of a file of slices. What is kept between calls is made by the first one. */
#include <math.h>

#include "base/pose_array.h"
#include "base/report.h"
#include "cspace/answer/pose_motion.h"
#include "cspace/read/cspace.h"

static void free_answers(pir_cspace *cspace) {
    pir_answers *answers = cspace->answers;
    pir_answers_finish(answers);
    PIR_FREE(&cspace->allocator, answers, 1);
}

/* The answers that the file keeps, made where they are not there yet. */
static pir_status get_answers(pir_cspace *cspace, pir_report *report, pir_answers **ret_answers) {
    if (!cspace->answers) {
        // a pair takes references, which is no change of what the pieces say
        pir_polytope *const *pieces = (pir_polytope *const *)pir_store_pieces(cspace->store);
        const pir_cspace_info *info = &cspace->info;
        const pir_answered_bodies bodies = {cspace->grid, pieces, pieces + info->robot_count, info->robot_count,
                                            info->obstacle_count};
        pir_answers *answers = PIR_ZEROED(&cspace->allocator, pir_answers, 1);
        pir_status status = answers ? pir_answers_init(answers, &bodies, &cspace->allocator) : PIR_ERR_MEMORY;
        if (status != PIR_OK) {
            if (answers)
                pir_answers_finish(answers);
            PIR_FREE(&cspace->allocator, answers, 1);
            return pir_fail(report, status, "slices: out of memory");
        }
        cspace->answers = answers;
        cspace->answers_free = free_answers;
    }
    *ret_answers = cspace->answers;
    return PIR_OK;
}

pir_status pir_cspace_classify(pir_cspace *cspace, const pir_pose *pose, pir_report *report,
                               pir_configuration *ret_configuration) {
    if (!cspace || !pose || !ret_configuration)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file, no pose, or nowhere to put the answer");
    pir_answers *answers = NULL;
    double gap;
    pir_status status = get_answers(cspace, report, &answers);
    return status == PIR_OK ? pir_answers_classify(answers, pose, PIR_WISH_PLACE, report, ret_configuration, &gap)
                            : status;
}

/* --- many poses --- */

/* Writes what became of a pose; `status` is that of the pose, and where it is bad there is no answer. */
static void write_answer(const pir_cspace_arrays *to, size_t i, pir_status status, const pir_configuration *answer) {
    const bool good = status == PIR_OK;
    if (to->verdict)
        to->verdict[i] = good ? (uint8_t)answer->verdict : PIR_POSE_BAD;
    if (to->status)
        to->status[i] = (uint8_t)status;
    if (to->state)
        to->state[i] = good ? (uint8_t)answer->state : PIR_POSE_BAD;
    if (to->on_grid)
        to->on_grid[i] = good && answer->on_grid;
    if (to->robot)
        to->robot[i] = good ? answer->place.robot : 0;
    if (to->obstacle)
        to->obstacle[i] = good ? answer->place.obstacle : 0;
    if (to->slice)
        to->slice[i] = good ? answer->place.slice : 0;
    if (to->turn)
        to->turn[i] = good ? answer->turn : NAN;
}

pir_status pir_cspace_classify_many(pir_cspace *cspace, const pir_pose_array *poses, size_t count,
                                    const pir_cspace_arrays *arrays, pir_report *report,
                                    pir_pair_batch_summary *ret_summary) {
    if (!cspace || !poses || !arrays)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file, no poses, or nowhere to put the answers");
    if (!pir_pose_array_is_good(poses))
        return pir_fail(report, PIR_ERR_ARGUMENT,
                        "slices: a stride of poses is no multiple of 8, or shorter than an element");
    pir_answers *answers = NULL;
    const pir_status made = get_answers(cspace, report, &answers);
    if (made != PIR_OK)
        return made;
    const bool of_grid = arrays->state || arrays->on_grid || arrays->slice || arrays->turn;
    pir_pair_batch_summary summary = {0, count, PIR_OK};
    for (size_t i = 0; i < count; i++) {
        pir_pose pose = {{0, 0, 0, 1}, {0, 0, 0}};
        pir_configuration answer;
        double gap;
        pir_pose_array_get(poses, i, &pose);
        const pir_status status =
            pir_answers_classify(answers, &pose, of_grid ? PIR_WISH_PLACE : PIR_WISH_VERDICT, NULL, &answer, &gap);
        write_answer(arrays, i, status, &answer);
        if (status != PIR_OK && summary.bad++ == 0) {
            summary.first_bad = i;
            summary.first_status = status;
        }
    }
    if (ret_summary)
        *ret_summary = summary;
    return PIR_OK;
}

pir_status pir_cspace_segment(pir_cspace *cspace, const pir_pose *from, const pir_pose *to, pir_report *report,
                              pir_cspace_motion *ret_motion) {
    if (!cspace || !from || !to || !ret_motion)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file, no pose, or nowhere to put the answer");
    pir_answers *answers = NULL;
    pir_status status = get_answers(cspace, report, &answers);
    return status == PIR_OK ? pir_answers_segment(answers, from, to, report, ret_motion) : status;
}

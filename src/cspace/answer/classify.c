/* SPDX-License-Identifier: MIT */
/* Poses and motions, asked of a file of slices. What is kept between calls is made by the first one. */
#include "base/report.h"
#include "cspace/answer/pose_motion.h"
#include "cspace/read/cspace.h"

static pir_status make_sum(void *context, pir_cspace_place place, pir_report *report, pir_sum **ret_sum) {
    return pir_cspace_sum(context, place, report, ret_sum);
}

static void free_answers(pir_cspace *cspace) {
    pir_answers *answers = cspace->answers;
    pir_answers_finish(answers);
    PIR_FREE(&cspace->allocator, answers, 1);
}

/* The answers that the file keeps, made where they are not there yet. */
static pir_status get_answers(pir_cspace *cspace, pir_report *report, pir_answers **ret_answers) {
    if (!cspace->answers) {
        const pir_polytope *const *pieces = (const pir_polytope *const *)pir_store_pieces(cspace->store);
        const pir_cspace_info *info = &cspace->info;
        const pir_slice_source source = {
            cspace->grid, pieces, pieces + info->robot_count, info->robot_count, info->obstacle_count,
            make_sum,     cspace};
        pir_answers *answers = PIR_ZEROED(&cspace->allocator, pir_answers, 1);
        pir_status status = answers ? pir_answers_init(answers, &source, &cspace->allocator) : PIR_ERR_MEMORY;
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
    return status == PIR_OK ? pir_answers_classify(answers, pose, report, ret_configuration, &gap) : status;
}

pir_status pir_cspace_segment(pir_cspace *cspace, const pir_pose *from, const pir_pose *to, pir_report *report,
                              pir_cspace_motion *ret_motion) {
    if (!cspace || !from || !to || !ret_motion)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file, no pose, or nowhere to put the answer");
    pir_answers *answers = NULL;
    pir_status status = get_answers(cspace, report, &answers);
    return status == PIR_OK ? pir_answers_segment(answers, from, to, report, ret_motion) : status;
}

/* SPDX-License-Identifier: MIT */
/* Answers from what is proven: see task.h. */
#include "pair/task.h"

#include "pair/apart.h"
#include "query/last/foot.h"

void pir_task_near(pir_task *task, const pir_nearest *nearest) {
    pir_query_result *result = task->result;
    const double distance = nearest->distance - PIR_DISTANCE_ERROR * task->placement->reach;
    if (!(task->want & PIR_WANT_SEPARATION)) {
        pir_task_keep_proof(task, nearest->normal, distance);
        return;
    }
    pir_result_separation(&task->workspace->frame, nearest, result);
    if (result->distance > pir_frame_length(&task->workspace->frame, task->limit)) {
        pir_result_beyond(result);
        pir_task_keep_axis(task, nearest->normal, distance);
    }
}

void pir_task_inside(pir_task *task, const pir_facet *facet, double slack) {
    pir_result_set_state(task->result, PIR_INSIDE);
    pir_task_keep_facet(task->pair, facet);
    if (!(task->want & PIR_WANT_DEPTH))
        return;
    if (task->has_same && pir_facet_same(facet, &task->same.facet))
        pir_result_depth_at(task->exact->frame, facet->n, slack, &task->same.touch, task->result);
    else
        pir_result_depth_of(task->exact, task->placement, facet, slack, task->result);
}

void pir_task_touching(pir_task *task, const pir_facet *facet) {
    pir_least touching = {true, *facet};
    pir_result_set_state(task->result, PIR_BOUNDARY);
    pir_result_touching(task->exact, task->placement, &touching, task->result);
    pir_task_keep_facet(task->pair, facet);
}

bool pir_task_settle(pir_task *task, const pir_facet *facet) {
    const pir_placement *placement = task->placement;
    double slack;
    int side = pir_facet_measure(task->exact, placement, facet, &slack);
    if (side < 0) {
        pir_nearest nearest;
        task->is_outside = true;
        if (!(task->want & PIR_WANT_SEPARATION))
            return true;
        if (!pir_nearest_at_slack(task->exact, placement, facet, slack, &nearest))
            return false;
        pir_task_near(task, &nearest);
        return true;
    }
    if (!pir_foot_settles(task->exact, placement, facet, slack))
        return false;
    if (side > 0)
        pir_task_inside(task, facet, slack);
    else
        pir_task_touching(task, facet);
    return true;
}

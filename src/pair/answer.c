/* SPDX-License-Identifier: MIT */
/*
 * Queries on a pair. Ways to an answer are tried in the order in which the last answer makes them likely; each ends
 * with a proof at this placement, or leaves the question open for the next.
 *
 *   - proof: bodies that were apart are so still, without a frame (query/proof/proof.h);
 *   - axis: the direction in which the last answer was apart by more than the cutoff, with Q or with P (apart.c);
 *   - same facet: the facet of the last answer, or the one that the foot of x has gone to from there (follow_foot.h),
 *     proven by doubles (same_facet.h). Where it separates, it is the nearest; where x is within it, foot.h tells
 *     whether it is the least;
 *   - axes: the facet of least slack among all that D can have, where both bodies have few (axes.h);
 *   - surface: that of the last answer, placed again and mended (overlap.h);
 *   - facet: that of the last answer with another corner, or proven by integers;
 *   - descent: to the nearest point, proven by doubles, else by integers where a separating direction is certain;
 *   - a new surface: from the descent's last simplex, or widened from one about a point inside of D;
 *   - whole: the difference (whole.c).
 */
#include "pair/apart.h"
#include "pair/give.h"
#include "pair/seek.h"
#include "pair/task.h"
#include "query/last/foot.h"

/* --- by the same facet --- */

/* Sets the slack of the same facet from integers where doubles do not give it. Returns its sign. */
static int measure_same(pir_task *task, pir_same is) {
    double slack = task->same.slack;
    if (is == PIR_SAME_PROVEN)
        return slack < 0 ? -1 : 1;
    int side = pir_facet_measure(task->exact, task->placement, &task->same.facet, &slack);
    pir_same_facet_set_slack(&task->workspace->frame, task->placement, slack, &task->same);
    return side;
}

/* The answer from the same facet, where that is enough. */
static bool settle_same(pir_task *task, pir_same is) {
    const pir_same_facet *same = &task->same;
    const pir_frame *frame = &task->workspace->frame;
    task->has_same = is >= PIR_SAME_NEAR;
    if (!task->has_same)
        return false;
    int side = measure_same(task, is);
    if (side < 0) {
        pir_nearest nearest = {-same->slack, same->facet.n, same->touch};
        task->is_outside = true;
        task->pair->deep = false;
        pir_task_near(task, &nearest);
        return true;
    }
    if (!pir_foot_settles_within(frame, task->placement, &same->facet, same->slack, same->margin))
        return false;
    if (side == 0)
        pir_task_touching(task, &same->facet);
    else
        pir_task_inside(task, &same->facet, same->slack);
    return true;
}

static bool by_same_facet(pir_task *task) {
    pir_workspace *workspace = task->workspace;
    pir_pair *pair = task->pair;
    if (!pair->has_facet)
        return false;
    pir_same is = workspace->prove_same(&workspace->frame, task->placement, pair->facet, &task->same);
    task->in_doubt = is == PIR_SAME_IN_DOUBT;
    if (is <= PIR_SAME_BESIDE)
        is = workspace->follow_foot(&workspace->frame, task->placement, is, &task->same);
    // a descent begins there
    if (is == PIR_SAME_BESIDE)
        pir_task_keep_facet(pair, &task->same.facet);
    if (!settle_same(task, is))
        return false;
    pir_task_keep_facet(pair, &task->same.facet);
    pair->statistics.by_facet++;
    pir_task_end(task, PIR_LEVEL_NEAR);
    return true;
}

/* --- by all axes --- */

/* Whether all facets but task->same, of which x is inside, have more slack; then it is the answer. */
static bool is_ahead(pir_task *task, const pir_axes_slack *least) {
    pir_pair *pair = task->pair;
    const pir_same_facet *same = &task->same;
    if (!(same->slack > 0 && same->slack + task->placement->error * same->facet.err < least->next))
        return false;
    pir_task_inside(task, &same->facet, same->slack);
    pair->statistics.by_surface++;
    pir_task_end(task, PIR_LEVEL_OVERLAPPING);
    return true;
}

/* The answer from task->same, which separates and holds the foot of x. */
static void finish_outside(pir_task *task) {
    const pir_same_facet *same = &task->same;
    pir_nearest nearest = {-same->slack, same->facet.n, same->touch};
    task->is_outside = true;
    pir_task_keep_facet(task->pair, &same->facet);
    pir_task_near(task, &nearest);
    task->pair->statistics.by_descent++;
    pir_task_end(task, PIR_LEVEL_NEAR);
}

/* The answer from task->same, a facet that doubles have proven. */
static bool settle_least(pir_task *task, const pir_axes_slack *least) {
    if (task->same.slack > 0)
        return is_ahead(task, least);
    finish_outside(task);
    return true;
}

/* The answer by the axes of both bodies. Where they leave it open, tells whether they are likely to do so again. */
static bool ask_axes(pir_task *task, bool *ret_open) {
    const pir_pair *pair = task->pair;
    const pir_frame *frame = &task->workspace->frame;
    pir_axes_slack least;
    pir_same_facet other;
    pir_vec3 n;
    const pir_axes *p = pair->axes_p, *q = pair->axes_q;
    pir_axes_least(task->workspace->axes, p, q, frame, task->placement, &least);
    // along edges that are parallel there is no axis, and less than any slack is said
    const bool is_none = least.low < -task->placement->reach;
    *ret_open = is_none || !(least.low < 0);
    if (task->has_same && settle_least(task, &least))
        return true;
    if (is_none)
        return false;
    pir_piece piece = pir_axes_piece(p, q, frame, least.at, &n);
    // in place where nothing is there: copying takes a while
    pir_same_facet *same = task->has_same ? &other : &task->same;
    if (task->workspace->prove_same(frame, task->placement, piece, same) == PIR_SAME_PROVEN) {
        if (task->has_same)
            task->same = other;
        task->has_same = true;
        return settle_least(task, &least);
    }
    if (*ret_open || !(task->want & PIR_WANT_SEPARATION) || !pir_task_apart_along(task, n))
        return false;
    task->pair->statistics.by_descent++;
    pir_task_end(task, PIR_LEVEL_NEAR);
    return true;
}

/*
 * What two facets of one slack, or an edge of P along one of Q, leave open lasts where bodies rest on each other. So
 * the next calls do not ask.
 */
#define AXES_REST 15

static bool by_axes(pir_task *task) {
    pir_pair *pair = task->pair;
    bool open;
    if (!pair->axes_p)
        return false;
    if (pair->resting > 0) {
        pair->resting--;
        return false;
    }
    if (ask_axes(task, &open))
        return true;
    pair->resting = open ? AXES_REST : 0;
    return false;
}

/* --- the calls --- */

static bool by_need(pir_task *task) {
    pir_pair *pair = task->pair;
    if (pir_pair_allows(pair, PIR_LEVEL_APART) && pair->has_axis && pir_task_apart(task)) {
        pair->statistics.by_certificate++;
        pir_task_end(task, PIR_LEVEL_APART);
        return true;
    }
    bool near = pir_pair_allows(pair, PIR_LEVEL_NEAR), deep = pir_pair_allows(pair, PIR_LEVEL_OVERLAPPING),
         was_deep = pair->deep;
    if (near && by_same_facet(task))
        return true;
    pair->deep = false;
    if (near && deep && by_axes(task))
        return true;
    return pir_task_seek(task, near, deep, was_deep);
}

static void add_radii(const pir_pair_input *input, pir_query_result *result) {
    pir_query_input radii = {.radius_p = input->radius_p, .radius_q = input->radius_q, .cutoff = input->cutoff};
    pir_result_add_radii(&radii, result);
}

/* The answer where it takes no frame. */
static bool is_still_apart(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, int want) {
    const double radii = input->radius_p + input->radius_q, cutoff = input->cutoff > 0 ? input->cutoff : 0;
    const bool has_cutoff = (want & PIR_WANT_SEPARATION) || radii > 0;
    if (!pir_pair_allows(pair, PIR_LEVEL_APART) || !pir_pair_stays_apart(pair, input, has_cutoff ? cutoff + radii : 0))
        return false;
    pir_result_clear(&workspace->answer);
    if (has_cutoff) {
        workspace->answer.outcome = PIR_BEYOND_CUTOFF;
        workspace->answer.distance = cutoff;
    }
    pair->statistics.queries++;
    pair->statistics.by_certificate++;
    pair->level = PIR_LEVEL_APART;
    return true;
}

/* The answer in the workspace, the frame being set. */
static pir_status find_answer(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, int want) {
    pir_query_result *result = &workspace->answer;
    pir_result_clear(result);
    double radii = input->radius_p + input->radius_q;
    pir_task task;
    task.pair = pair;
    task.workspace = workspace;
    task.placement = &workspace->placement;
    task.exact = &workspace->exact;
    task.is_outside = task.has_same = task.in_doubt = false;
    task.simplex.count = task.simplex.tried = 0;
    task.want = want | (radii > 0 ? PIR_WANT_SEPARATION | PIR_WANT_DEPTH : 0);
    task.limit = pir_frame_from(&workspace->frame, (input->cutoff > 0 ? input->cutoff : 0) + radii);
    task.result = result;
    pair->statistics.queries++;
    if (!by_need(&task)) {
        if (!pir_pair_allows(pair, PIR_LEVEL_WHOLE))
            return PIR_ERR_UNSUPPORTED;
        pir_status status = pir_pair_whole(pair, workspace, input, want, result);
        if (status != PIR_OK)
            return status;
        pair->statistics.by_whole++;
        pir_task_end(&task, PIR_LEVEL_WHOLE);
    } else if (radii > 0) {
        add_radii(input, result);
    } else if (result->outcome == PIR_BEYOND_CUTOFF) {
        result->distance = input->cutoff > 0 ? input->cutoff : 0;
    }
    if (workspace->posed)
        pir_pair_to_world(workspace, result);
    return PIR_OK;
}

static pir_status answer(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, int want,
                         pir_query_result *ret_result) {
    if (!pair || !workspace || !input || !ret_result)
        return PIR_ERR_ARGUMENT;
    if (!is_still_apart(pair, workspace, input, want)) {
        pir_status status = pir_pair_begin(pair, workspace, input);
        if (status == PIR_OK)
            status = find_answer(pair, workspace, input, want);
        if (status != PIR_OK)
            return status;
    }
    pir_result_give(&workspace->answer, ret_result);
    return PIR_OK;
}

pir_status pir_pair_overlap(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                            pir_query_result *ret_result) {
    if (!pair || !workspace || !input || !ret_result)
        return PIR_ERR_ARGUMENT;
    // the caller's cutoff tells nothing here, but is refused where it is no number
    pir_status status = pir_pair_check(input);
    if (status != PIR_OK)
        return status;
    pir_pair_input near = *input;
    bool rounded = input->radius_p + input->radius_q > 0;
    if (rounded)
        near.cutoff = 0;
    status = answer(pair, workspace, &near, rounded ? PIR_WANT_SEPARATION : 0, ret_result);
    if (status == PIR_OK)
        pir_result_keep_state(ret_result);
    return status;
}

pir_status pir_pair_distance(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                             pir_query_result *ret_result) {
    pir_status status = answer(pair, workspace, input, PIR_WANT_SEPARATION, ret_result);
    if (status == PIR_OK && ret_result->outcome == PIR_OVERLAPPING)
        ret_result->distance = 0;
    return status;
}

pir_status pir_pair_penetration(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                pir_query_result *ret_result) {
    pir_status status = answer(pair, workspace, input, PIR_WANT_DEPTH, ret_result);
    if (status == PIR_OK && ret_result->state == PIR_OUTSIDE)
        ret_result->distance = 0;
    return status;
}

pir_status pir_pair_signed_distance(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                    pir_query_result *ret_result) {
    return answer(pair, workspace, input, PIR_WANT_SEPARATION | PIR_WANT_DEPTH, ret_result);
}

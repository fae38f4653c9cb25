/* SPDX-License-Identifier: MIT */
/*
 * Queries on a pair. Ways to an answer are tried in the order in which the last answer makes them likely; each ends
 * with a proof at this placement, or leaves the question open for the next.
 *
 *   - certificate: the proven distance of an earlier answer, less the motion since; after the last one without a
 *     frame (still_apart.h);
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
#include "pair/still_apart.h"
#include "pair/task.h"
#include "query/last/foot.h"

/* --- by the certificate --- */

/* The square of x's way from the place of the pair's proof. */
static inline double way_since(const pir_task *task) {
    pir_vec3 way = pir_vec_sub(task->placement->x, task->pair->at);
    return pir_vec_dot(way, way);
}

/* How much supports of D may have changed against x since then, the square of x's way being known. */
static double moved_since(const pir_task *task, double way) {
    double turn = pir_rotation_angle_bound(task->pair->turned, task->workspace->frame.unit);
    return (sqrt(way) + turn * task->workspace->frame.p.swing) * (1 + 0x1p-40);
}

static bool by_certificate(pir_task *task) {
    const pir_pair *pair = task->pair;
    const pir_placement *placement = task->placement;
    // where there is no cutoff, numbers are wanted
    if (!(pair->apart > 0) || ((task->want & PIR_WANT_SEPARATION) && !(task->limit < pair->apart)))
        return false;
    // most that is too far is so by the way alone
    double way = way_since(task);
    if (!(way < pair->apart * pair->apart))
        return false;
    double left = pair->apart - moved_since(task, way) - 4 * placement->error;
    if (!(left > 0))
        return false;
    task->is_outside = true;
    if (!(task->want & PIR_WANT_SEPARATION))
        return true;
    if (!(left > task->limit + PIR_DISTANCE_ERROR * placement->reach))
        return false;
    pir_result_beyond(task->result);
    return true;
}

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

/* Proves the facet of the last answer by the rest of an earlier proof. */
static bool by_held_facet(pir_task *task) {
    pir_workspace *workspace = task->workspace;
    pir_held *held = &task->pair->held;
    pir_same_known known;
    if (!held->some)
        return false;
    held->served += held->served < UINT16_MAX;
    if (pir_held_is_past(held, &workspace->frame)) {
        pir_held_end(held, held->falls);
        return false;
    }
    workspace->moved = pir_held_moved(held, &workspace->frame, task->placement);
    if (pir_held_known(held, workspace->moved, task->placement, &known) &&
        settle_same(task,
                    workspace->prove_same(&workspace->frame, task->placement, task->pair->facet, &known, &task->same)))
        return true;
    pir_held_end(held, workspace->moved.turn);
    return false;
}

static bool by_fresh_facet(pir_task *task) {
    pir_workspace *workspace = task->workspace;
    pir_pair *pair = task->pair;
    pir_same is = workspace->prove_same(&workspace->frame, task->placement, pair->facet, NULL, &task->same);
    task->in_doubt = is == PIR_SAME_IN_DOUBT;
    if (is <= PIR_SAME_BESIDE)
        is = workspace->follow_foot(&workspace->frame, task->placement, is, &task->same);
    // a descent begins there
    if (is == PIR_SAME_BESIDE)
        pir_task_keep_facet(pair, &task->same.facet);
    if (!settle_same(task, is))
        return false;
    // what is held is of this piece, with its corner as it is here
    pir_task_keep_facet(pair, &task->same.facet);
    pir_held_set(&pair->held, &workspace->frame, task->placement, &task->same);
    workspace->moved = (pir_leeway){0, 0};
    return true;
}

static bool by_same_facet(pir_task *task) {
    pir_pair *pair = task->pair;
    if (!pair->has_facet || !(by_held_facet(task) || by_fresh_facet(task)))
        return false;
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
    pir_workspace *workspace = task->workspace;
    if (task->same.slack < 0)
        finish_outside(task);
    else if (!is_ahead(task, least))
        return false;
    pir_held_set(&task->pair->held, &workspace->frame, task->placement, &task->same);
    workspace->moved = (pir_leeway){0, 0};
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
    if (task->workspace->prove_same(frame, task->placement, piece, NULL, same) == PIR_SAME_PROVEN) {
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
    if (pir_pair_allows(pair, PIR_LEVEL_APART) && (by_certificate(task) || (pair->has_axis && pir_task_apart(task)))) {
        pair->statistics.by_certificate++;
        pir_task_end(task, PIR_LEVEL_APART);
        return true;
    }
    bool near = pir_pair_allows(pair, PIR_LEVEL_NEAR), deep = pir_pair_allows(pair, PIR_LEVEL_OVERLAPPING),
         was_deep = pair->deep;
    if (near && by_same_facet(task))
        return true;
    pair->deep = pair->held.some = false;
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
    if (!(want & PIR_WANT_SEPARATION) || !pir_pair_allows(pair, PIR_LEVEL_APART) ||
        !pir_pair_still_apart(pair, workspace, input))
        return false;
    pir_result_clear(&workspace->answer);
    workspace->answer.outcome = PIR_BEYOND_CUTOFF;
    workspace->answer.distance = input->cutoff > 0 ? input->cutoff : 0;
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

/* SPDX-License-Identifier: MIT */
/* The ways from a placement to an answer: see ladder.h. */
#include "query/answer/ladder.h"

#include "query/decide/touch.h"
#include "query/walk/foot.h"

/* An end of a descent that is nearer than this, relative to the reach, is tried for a facet that x touches. */
#define MAY_TOUCH 0x1p-30

/* A descent for the state alone ends farther away than this, relative to the reach: then x is outside for certain. */
#define CLEARLY_OUTSIDE 0x1p-20

/* --- answers from what is proven --- */

void pir_task_near(pir_task *task, const pir_nearest *nearest) {
    const pir_facet_source *source = task->source;
    const double distance = nearest->distance - PIR_DISTANCE_ERROR * task->placement->reach;
    bool beyond = !(task->want & PIR_WANT_SEPARATION);
    task->is_outside = true;
    if (!beyond) {
        pir_result_separation(task->frame, nearest, task->result);
        beyond = task->result->distance > pir_frame_length(task->frame, task->limit);
        if (beyond)
            pir_result_beyond(task->result);
    }
    // nearer ones leave no proof that could serve
    if (beyond && source->keep_apart)
        source->keep_apart(task, nearest->normal, distance);
}

void pir_task_near_same(pir_task *task) {
    const pir_same_facet *same = &task->same;
    pir_task_keep_facet(task, &same->facet);
    pir_task_near(task, &(pir_nearest){-same->slack, same->facet.n, same->touch});
}

void pir_task_inside(pir_task *task, const pir_facet *facet, double slack) {
    pir_result_set_state(task->result, PIR_INSIDE);
    pir_task_keep_facet(task, facet);
    task->decided = facet->piece;
    if (!(task->want & PIR_WANT_DEPTH))
        return;
    if (task->has_same && pir_facet_same(facet, &task->same.facet))
        pir_result_depth_at(task->frame, facet->n, slack, &task->same.touch, task->result);
    else
        pir_result_depth_of(task->exact, task->placement, facet, slack, task->result);
}

void pir_task_touching(pir_task *task, const pir_least *touching) {
    pir_result_set_state(task->result, PIR_BOUNDARY);
    pir_result_touching(task->exact, task->placement, touching, task->result);
    if (!touching->found)
        return;
    pir_task_keep_facet(task, &touching->facet);
    task->decided = touching->facet.piece;
}

/* From a facet on which x is, or which x is within: the answer, where its slack is the least of all. */
static void settle_within(pir_task *task, const pir_facet *facet, int side, double slack) {
    if (side > 0)
        pir_task_inside(task, facet, slack);
    else
        pir_task_touching(task, &(pir_least){true, *facet});
}

bool pir_task_settle(pir_task *task, const pir_facet *facet) {
    double slack;
    int side = pir_facet_measure(task->exact, task->placement, facet, &slack);
    if (side < 0) {
        pir_nearest nearest;
        task->is_outside = true;
        if (!(task->want & PIR_WANT_SEPARATION))
            return true;
        if (!pir_nearest_at_slack(task->exact, task->placement, facet, slack, &nearest))
            return false;
        pir_task_near(task, &nearest);
        return true;
    }
    if (!pir_foot_settles(task->exact, task->placement, facet, slack))
        return false;
    settle_within(task, facet, side, slack);
    return true;
}

/* --- walk --- */

/* Sets the slack of the same facet from integers where doubles do not give it. Returns its sign. */
static int measure_same(pir_task *task, pir_same is) {
    double slack = task->same.slack;
    if (is == PIR_SAME_PROVEN)
        return slack < 0 ? -1 : 1;
    int side = pir_facet_measure(task->exact, task->placement, &task->same.facet, &slack);
    pir_same_facet_set_slack(task->frame, task->placement, slack, &task->same);
    return side;
}

/* The answer from the same facet, where that is enough. */
static bool settle_same(pir_task *task, pir_same is) {
    const pir_same_facet *same = &task->same;
    task->has_same = is >= PIR_SAME_NEAR;
    if (!task->has_same)
        return false;
    int side = measure_same(task, is);
    if (side < 0) {
        task->hint->deep = false;
        pir_task_near_same(task);
        return true;
    }
    if (!pir_foot_settles_within(task->frame, task->placement, &same->facet, same->slack, same->margin))
        return false;
    settle_within(task, &same->facet, side, same->slack);
    return true;
}

/* The facet of the last answer with the corner that it has here, as doubles tell. */
static pir_piece aim(const pir_task *task) {
    const pir_frame *frame = task->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_piece piece = task->hint->facet;
    if (piece.kind == PIR_FACET_FV)
        piece.second = pir_climb(q, pir_mat_apply(&frame->r, p->normal[piece.first]), piece.second);
    else if (piece.kind == PIR_FACET_VF)
        piece.first = pir_climb(p, pir_mat_apply_transposed(&frame->r, q->normal[piece.second]), piece.first);
    return piece;
}

/* The answer from the facet of the last one, proven by integers where doubles leave it in doubt. */
static bool settle_doubt(pir_task *task) {
    pir_facet facet;
    return task->in_doubt && pir_facet_prove(task->exact, aim(task), &facet) && pir_task_settle(task, &facet);
}

static bool walk(pir_task *task) {
    const pir_frame *frame = task->frame;
    if (!task->hint->has_facet)
        return false;
    const pir_same last = task->walker->prove(frame, task->placement, task->hint->facet, &task->same);
    pir_same is = last;
    if (is <= PIR_SAME_BESIDE)
        is = task->walker->follow(frame, task->placement, is, &task->same);
    if (settle_same(task, is)) {
        pir_task_keep_facet(task, &task->same.facet);
        return true;
    }
    // a descent begins there
    if (is == PIR_SAME_BESIDE || task->same.is_far)
        pir_task_keep_facet(task, &task->same.facet);
    task->in_doubt = last == PIR_SAME_IN_DOUBT;
    return false;
}

/* --- nearest --- */

static void keep_simplex(pir_hint *hint, const pir_simplex *simplex) {
    hint->points = (uint8_t)(simplex->count < 3 ? simplex->count : 3);
    for (uint32_t i = 0; i < hint->points; i++) {
        hint->a[i] = simplex->a[i];
        hint->b[i] = simplex->b[i];
    }
}

static void recall_simplex(const pir_task *task, pir_simplex *simplex) {
    const pir_hint *hint = task->hint;
    simplex->tried = 0;
    if (hint->has_facet && !task->frame->p.polytope->artificial && !task->frame->q.polytope->artificial) {
        pir_facet_simplex(task->frame, hint->facet, simplex);
        return;
    }
    simplex->count = hint->points;
    for (uint32_t i = 0; i < hint->points; i++) {
        simplex->a[i] = hint->a[i];
        simplex->b[i] = hint->b[i];
    }
}

/* The features that a descent ended at. */
static pir_witness faces_of(const pir_task *task) {
    const pir_simplex *simplex = &task->simplex;
    return (pir_witness){pir_feature_of(task->frame->p.polytope, simplex->a, simplex->count),
                         pir_feature_of(task->frame->q.polytope, simplex->b, simplex->count)};
}

/* The nearest point from those features, where doubles and filtered signs prove them. */
static bool prove_end(pir_task *task, pir_nearest *ret_nearest) {
    const pir_simplex *simplex = &task->simplex;
    const pir_witness faces = faces_of(task);
    pir_piece piece;
    if (!pir_piece_of(task->frame, faces, simplex->a[0], simplex->b[0], simplex->direction, &piece)) {
        task->hint->has_facet = false;
        return pir_nearest_prove(task->exact, task->placement, faces, ret_nearest);
    }
    pir_facet facet;
    pir_same_facet same;
    if (task->walker->prove(task->frame, task->placement, piece, &same) == PIR_SAME_PROVEN && same.slack < 0) {
        *ret_nearest = (pir_nearest){-same.slack, same.facet.n, same.touch};
        pir_task_keep_facet(task, &same.facet);
        return true;
    }
    if (!pir_facet_prove(task->exact, piece, &facet))
        return false;
    double slack = facet.h - pir_vec_dot(facet.n, task->placement->x);
    if (!(slack < -task->placement->error * facet.err) ||
        !pir_nearest_at_facet(task->exact, task->placement, &facet, ret_nearest))
        return false;
    pir_task_keep_facet(task, &facet);
    return true;
}

/* Where the descent ended so near that x may touch: the answer from the facet there. */
static bool settle_end(pir_task *task) {
    const pir_simplex *simplex = &task->simplex;
    pir_piece piece;
    pir_facet facet;
    if (!(simplex->upper < MAY_TOUCH * task->placement->reach) ||
        !pir_piece_of(task->frame, faces_of(task), simplex->a[0], simplex->b[0], simplex->direction, &piece) ||
        !pir_facet_prove(task->exact, piece, &facet) || !pir_task_settle(task, &facet))
        return false;
    pir_task_keep_facet(task, &facet);
    return true;
}

/* From outside, where the descent has not proven its end: by integers. */
static void find_nearest(pir_task *task) {
    pir_nearest nearest;
    if (!(task->want & PIR_WANT_SEPARATION))
        return;
    if (pir_nearest_find(task->exact, task->placement, &task->simplex, &nearest, &task->result->steps))
        pir_task_near(task, &nearest);
    else
        pir_result_unfinished(task->frame, &task->simplex, task->result);
}

/* Where the nearest point is not proven: whether x is outside, and how far. */
static bool settle_outside(pir_task *task) {
    const bool wants = task->want & PIR_WANT_SEPARATION;
    double distance;
    if (!task->source->is_outside(task, &distance))
        return false;
    const bool beyond = wants && distance > pir_task_least_beyond(task);
    task->is_outside = true;
    if (distance > 0 && (beyond || !wants) && task->source->keep_apart)
        task->source->keep_apart(task, task->simplex.direction, distance);
    if (beyond) {
        pir_result_beyond(task->result);
        task->hint->has_facet = false;
    } else {
        find_nearest(task);
    }
    return true;
}

static bool nearest(pir_task *task) {
    const pir_placement *placement = task->placement;
    const double enough =
        task->want & PIR_WANT_SEPARATION ? pir_task_least_beyond(task) : CLEARLY_OUTSIDE * placement->reach;
    pir_simplex *simplex = &task->simplex;
    pir_nearest found;
    recall_simplex(task, simplex);
    pir_descend_to_point(task->frame, placement, enough, simplex, &task->result->steps);
    const bool far = simplex->lower > PIR_CLEARLY_APART * placement->reach && simplex->lower > 4 * placement->error;
    if (!settle_end(task)) {
        if (far && !(simplex->lower > enough) && prove_end(task, &found))
            pir_task_near(task, &found);
        else if (!settle_outside(task))
            return false;
    }
    keep_simplex(task->hint, simplex);
    return true;
}

/* --- all ways --- */

pir_task_way pir_task_answer(pir_task *task) {
    task->was_deep = task->hint->deep;
    if (task->may_near && walk(task))
        return PIR_WAY_WALK;
    task->hint->deep = false;
    // a source that was deep decides sooner than integers
    if (!task->was_deep && settle_doubt(task))
        return PIR_WAY_WALK;
    if (task->may_deep && task->source->depth(task, false))
        return PIR_WAY_DEPTH;
    if (task->was_deep && settle_doubt(task))
        return PIR_WAY_WALK;
    if (task->may_near && nearest(task))
        return PIR_WAY_NEAREST;
    return task->may_deep && !task->is_outside && task->source->depth(task, true) ? PIR_WAY_DEPTH : PIR_WAY_OPEN;
}

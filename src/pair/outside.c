/* SPDX-License-Identifier: MIT */
/* Descent from the features of the last answer to the nearest point: see answer.c. */
#include "pair/apart.h"
#include "pair/task.h"
#include "query/decide/witness.h"
#include "query/last/facet_simplex.h"
#include "query/last/same_facet.h"

/* An end of a descent that is nearer than this, relative to the reach, is tried for a facet that x touches. */
#define MAY_TOUCH 0x1p-30

/* --- where a descent begins --- */

static void keep_simplex(pir_pair *pair, const pir_simplex *simplex) {
    pair->points = (uint8_t)simplex->count;
    for (uint32_t i = 0; i < simplex->count && i < 3; i++) {
        pair->a[i] = simplex->a[i];
        pair->b[i] = simplex->b[i];
    }
}

static void recall_simplex(const pir_task *task, pir_simplex *simplex) {
    const pir_pair *pair = task->pair;
    simplex->tried = 0;
    if (pair->has_facet && !task->workspace->frame.p.polytope->artificial &&
        !task->workspace->frame.q.polytope->artificial) {
        pir_facet_simplex(&task->workspace->frame, task->pair->facet, simplex);
        return;
    }
    simplex->count = pair->points;
    for (uint32_t i = 0; i < pair->points; i++) {
        simplex->a[i] = pair->a[i];
        simplex->b[i] = pair->b[i];
    }
}

/* --- what is proven at its end --- */

/* The piece that two features make, with its normal along n. */
static bool piece_of(const pir_frame *frame, pir_witness faces, const pir_simplex *simplex, pir_piece *ret_piece) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_vec3 n = simplex->direction;
    if (faces.p.kind == PIR_FEATURE_FACET) {
        if (p->dimension == 2 && pir_vec_dot(pir_mat_apply(&frame->r, p->normal[faces.p.index]), n) < 0)
            faces.p.index = 1 - faces.p.index;
        *ret_piece = (pir_piece){PIR_FACET_FV, faces.p.index, simplex->b[0]};
    } else if (faces.q.kind == PIR_FEATURE_FACET) {
        if (q->dimension == 2 && pir_vec_dot(q->normal[faces.q.index], n) < 0)
            faces.q.index = 1 - faces.q.index;
        *ret_piece = (pir_piece){PIR_FACET_VF, simplex->a[0], faces.q.index};
    } else if (faces.p.kind == PIR_FEATURE_EDGE && faces.q.kind == PIR_FEATURE_EDGE) {
        uint32_t half = q->edge_half[faces.q.index];
        pir_vec3 across =
            pir_vec_cross(q->direction[half], pir_mat_apply(&frame->r, p->direction[p->edge_half[faces.p.index]]));
        *ret_piece = (pir_piece){PIR_FACET_EE, faces.p.index, pir_vec_dot(across, n) > 0 ? half : q->twin[half]};
    } else {
        return false;
    }
    return true;
}

/* The nearest point from the features at which the descent ended, where doubles and filtered signs prove them. */
static bool prove(pir_task *task, pir_nearest *ret_nearest) {
    const pir_frame *frame = &task->workspace->frame;
    const pir_simplex *simplex = &task->simplex;
    pir_witness faces = {pir_feature_of(frame->p.polytope, simplex->a, simplex->count),
                         pir_feature_of(frame->q.polytope, simplex->b, simplex->count)};
    pir_piece piece;
    if (!piece_of(frame, faces, simplex, &piece)) {
        task->pair->has_facet = false;
        return pir_nearest_prove(task->exact, task->placement, faces, NULL, ret_nearest);
    }
    pir_facet facet;
    pir_same_facet same;
    if (task->workspace->prove_same(frame, task->placement, piece, &same) == PIR_SAME_PROVEN && same.slack < 0) {
        *ret_nearest = (pir_nearest){-same.slack, same.facet.n, same.touch};
        pir_task_keep_facet(task->pair, &same.facet);
        return true;
    }
    if (!pir_facet_prove(task->exact, piece, &facet))
        return false;
    double slack = facet.h - pir_vec_dot(facet.n, task->placement->x);
    if (!(slack < -task->placement->error * facet.err) ||
        !pir_nearest_at_facet(task->exact, task->placement, &facet, ret_nearest))
        return false;
    pir_task_keep_facet(task->pair, &facet);
    return true;
}

/* From outside, where the descent has not proven its end. */
static void finish_outside(pir_task *task) {
    pir_nearest nearest;
    if (!(task->want & PIR_WANT_SEPARATION))
        return;
    if (pir_nearest_find(task->exact, task->placement, &task->simplex, &nearest, &task->result->steps))
        pir_task_near(task, &nearest);
    else
        pir_result_unfinished(&task->workspace->frame, &task->simplex, task->result);
}

/* Where the descent ended so near that x may touch: the facet there. */
static bool by_end(pir_task *task) {
    const pir_frame *frame = &task->workspace->frame;
    const pir_simplex *simplex = &task->simplex;
    pir_piece piece;
    pir_facet facet;
    if (!(simplex->upper < MAY_TOUCH * task->placement->reach))
        return false;
    pir_witness faces = {pir_feature_of(frame->p.polytope, simplex->a, simplex->count),
                         pir_feature_of(frame->q.polytope, simplex->b, simplex->count)};
    if (!piece_of(frame, faces, simplex, &piece) || !pir_facet_prove(task->exact, piece, &facet) ||
        !pir_task_settle(task, &facet))
        return false;
    pir_task_keep_facet(task->pair, &facet);
    return true;
}

bool pir_task_descend(pir_task *task) {
    const pir_placement *placement = task->placement;
    const double error = PIR_DISTANCE_ERROR * placement->reach;
    pir_simplex *simplex = &task->simplex;
    pir_nearest nearest;
    recall_simplex(task, simplex);
    pir_descend_to_point(&task->workspace->frame, placement, task->limit + error, simplex, &task->result->steps);
    if (by_end(task)) {
        keep_simplex(task->pair, simplex);
        task->pair->statistics.by_descent++;
        pir_task_end(task, PIR_LEVEL_NEAR);
        return true;
    }
    bool far = simplex->lower > PIR_CLEARLY_APART * placement->reach && simplex->lower > 4 * placement->error;
    bool beyond = simplex->lower > task->limit + error;
    if (far && !beyond && prove(task, &nearest)) {
        pir_task_near(task, &nearest);
    } else {
        double distance = simplex->lower > 0 ? pir_task_certain(task, simplex->direction, simplex->lower) : 0;
        if (!task->is_outside && !(distance > 0))
            return false;
        if (distance > 0 && !(task->want & PIR_WANT_SEPARATION))
            pir_task_keep_proof(task, simplex->direction, distance);
        if (pir_task_is_beyond(task, distance)) {
            pir_result_beyond(task->result);
            pir_task_keep_axis(task, simplex->direction, distance);
            task->pair->has_facet = false;
        } else {
            finish_outside(task);
        }
    }
    keep_simplex(task->pair, simplex);
    task->pair->statistics.by_descent++;
    pir_task_end(task, PIR_LEVEL_NEAR);
    return true;
}

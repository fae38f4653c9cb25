/* SPDX-License-Identifier: MIT */
/* The ways to an answer that search for its facet: see seek.h. */
#include "pair/seek.h"

#include "pair/overlap.h"

/* --- by a facet --- */

/* The facet of the last answer with the corner that it has here, as doubles tell. */
static pir_piece aim(const pir_task *task) {
    const pir_frame *frame = &task->workspace->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_piece piece = task->pair->facet;
    if (piece.kind == PIR_FACET_FV)
        piece.second = pir_climb(q, pir_mat_apply(&frame->r, p->normal[piece.first]), piece.second);
    else if (piece.kind == PIR_FACET_VF)
        piece.first = pir_climb(p, pir_mat_apply_transposed(&frame->r, q->normal[piece.second]), piece.first);
    return piece;
}

static bool by_facet(pir_task *task) {
    pir_facet facet;
    if (!task->in_doubt || !pir_facet_prove(task->exact, aim(task), &facet) || !pir_task_settle(task, &facet))
        return false;
    task->pair->statistics.by_facet++;
    pir_task_end(task, PIR_LEVEL_NEAR);
    return true;
}

/* --- by a surface --- */

static pir_overlap overlap_of(pir_task *task) {
    pir_pair *pair = task->pair;
    pir_workspace *workspace = task->workspace;
    if (!pair->surface)
        pair->surface = PIR_ZEROED(&pair->allocator, pir_surface, 1);
    // without memory, one that is not kept
    return (pir_overlap){.exact = task->exact,
                         .placement = task->placement,
                         .surface = pair->surface ? pair->surface : &workspace->spare,
                         .room = &workspace->room,
                         .prove_same = workspace->prove_same,
                         .statistics = &pair->statistics,
                         .has_same = &task->has_same,
                         .same = &task->same};
}

/* The answer from a surface about x. */
static bool finish_inside(pir_task *task, const pir_overlap *overlap) {
    pir_facet facet;
    if (!(task->want & PIR_WANT_DEPTH)) {
        pir_result_set_state(task->result, PIR_INSIDE);
    } else {
        if (!pir_overlap_least(overlap, &facet))
            return false;
        pir_task_inside(task, &facet, pir_facet_slack(task->exact, task->placement, &facet));
    }
    task->pair->deep = true;
    task->pair->statistics.by_surface++;
    pir_task_end(task, PIR_LEVEL_OVERLAPPING);
    return true;
}

/* The answer from what came of a surface. A facet that x is at or beyond is an answer by the level `near`. */
static bool finish(pir_task *task, const pir_overlap *overlap, pir_about about, const pir_facet *facet) {
    if (about == PIR_ABOUT_X)
        return finish_inside(task, overlap);
    if (about == PIR_ABOUT_NOTHING || !pir_pair_allows(task->pair, PIR_LEVEL_NEAR) || !pir_task_settle(task, facet))
        return false;
    task->pair->statistics.by_facet++;
    pir_task_end(task, PIR_LEVEL_NEAR);
    return true;
}

static bool by_surface(pir_task *task) {
    const pir_surface *surface = task->pair->surface;
    pir_facet facet;
    if (!surface || surface->count == 0)
        return false;
    pir_overlap overlap = overlap_of(task);
    return finish(task, &overlap, pir_overlap_place(&overlap) ? PIR_ABOUT_X : pir_overlap_repair(&overlap, &facet),
                  &facet);
}

static bool by_new_surface(pir_task *task) {
    const pir_frame *frame = &task->workspace->frame;
    pir_overlap overlap = overlap_of(task);
    pir_facet facet;
    bool done = finish(task, &overlap, pir_overlap_begin(&overlap, &task->simplex, &facet), &facet);
    if (!done) {
        pir_vec3 inner = pir_vec_add(pir_mat_apply(&frame->r, task->pair->body_p->inner), task->pair->body_q->inner);
        done = finish(task, &overlap, pir_overlap_widen(&overlap, inner, &facet), &facet);
    }
    if (task->pair->surface && task->pair->level != PIR_LEVEL_OVERLAPPING)
        task->pair->surface->count = 0;
    return done;
}

/* --- all --- */

bool pir_task_seek(pir_task *task, bool near, bool deep, bool was_deep) {
    if (was_deep && deep && by_surface(task))
        return true;
    if (near && (by_facet(task) || pir_task_descend(task)))
        return true;
    return deep && !task->is_outside && by_new_surface(task);
}

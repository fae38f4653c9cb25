/* SPDX-License-Identifier: MIT */
/*
 * Queries on a pair. Ways to an answer are tried in the order in which the last answer makes them likely; each ends
 * with a proof at this placement, or leaves the question open for the next.
 *
 *   - certificate: the proven distance of an earlier answer, less the motion since;
 *   - facet: the facet of the last answer, proven again. Where it separates and holds the foot of x, it is the nearest;
 *     where x is within it, foot.h tells whether it is the least;
 *   - surface: that of the last answer, placed again (overlap.h);
 *   - descent: to the nearest point, proven by doubles, else by integers where a separating direction is certain;
 *   - a new surface: from the descent's last simplex, or widened from one about a point inside of D;
 *   - whole: the difference (whole.c).
 */
#include "pair/foot.h"
#include "pair/overlap.h"
#include "query/answer/result.h"
#include "query/decide/witness.h"

struct task {
    pir_pair *pair;
    pir_workspace *workspace;
    const pir_placement *placement;
    pir_exact *exact;
    int want;
    double limit;    /* the cutoff and the radii, in the frame */
    bool is_outside; /* proven */
    pir_simplex simplex;
    pir_query_result *result;
};

/* --- hints --- */

static void keep_facet(pir_pair *pair, const pir_facet *facet) {
    pair->facet = facet->piece;
    pair->has_facet = true;
}

static void keep_simplex(pir_pair *pair, const pir_simplex *simplex) {
    pair->points = (uint8_t)simplex->count;
    for (uint32_t i = 0; i < simplex->count && i < 3; i++) {
        pair->a[i] = simplex->a[i];
        pair->b[i] = simplex->b[i];
    }
}

static void recall_simplex(const pir_pair *pair, pir_simplex *simplex) {
    *simplex = (pir_simplex){.count = pair->points};
    for (uint32_t i = 0; i < pair->points; i++) {
        simplex->a[i] = pair->a[i];
        simplex->b[i] = pair->b[i];
    }
}

/* Keeps a distance from D, in the frame, that is certain. */
static void keep_apart(const struct task *task, double distance) {
    pir_pair *pair = task->pair;
    pair->apart = distance;
    pair->at = task->placement->x;
    pair->turned = task->workspace->rotation.unit;
}

/* --- answers --- */

static void end(const struct task *task, pir_level level) {
    task->pair->level = (uint8_t)level;
}

static void answer_near(struct task *task, const pir_nearest *nearest) {
    pir_query_result *result = task->result;
    keep_apart(task, nearest->distance - PIR_DISTANCE_ERROR * task->placement->reach);
    if (!(task->want & PIR_WANT_SEPARATION))
        return;
    pir_result_separation(&task->workspace->frame, nearest, result);
    if (result->distance > pir_frame_length(&task->workspace->frame, task->limit))
        pir_result_beyond(result);
}

/* x on the boundary of D or inside; `facet` is the first that touches, or the one of least slack. */
static void answer_overlap(struct task *task, pir_state state, const pir_facet *facet) {
    pir_result_set_state(task->result, state);
    if (state == PIR_BOUNDARY) {
        pir_least touching = {true, *facet};
        pir_result_touching(task->exact, task->placement, &touching, task->result);
    } else if (task->want & PIR_WANT_DEPTH) {
        pir_result_depth(task->exact, task->placement, facet, task->result);
    }
    keep_facet(task->pair, facet);
    task->pair->apart = 0;
}

/* --- by the certificate --- */

static bool by_certificate(struct task *task) {
    const pir_pair *pair = task->pair;
    const pir_placement *placement = task->placement;
    // where there is no cutoff, numbers are wanted
    if (!(pair->apart > 0) || ((task->want & PIR_WANT_SEPARATION) && !(task->limit < pair->apart)))
        return false;
    pir_vec3 way = pir_vec_sub(placement->x, pair->at);
    double turn = pir_rotation_angle_bound(pair->turned, task->workspace->rotation.unit);
    double used = (sqrt(pir_vec_dot(way, way)) + turn * task->workspace->frame.p.size) * (1 + 0x1p-40);
    double left = pair->apart - used - 4 * placement->error;
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

/* --- by a facet --- */

/* The facet of the last answer with the corner that it has here, as doubles tell. */
static pir_piece aim(const struct task *task) {
    const pir_frame *frame = &task->workspace->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_piece piece = task->pair->facet;
    if (piece.kind == PIR_FACET_FV)
        piece.second = pir_climb(q, pir_mat_apply(&frame->r, p->normal[piece.first]), piece.second);
    else if (piece.kind == PIR_FACET_VF)
        piece.first = pir_climb(p, pir_mat_apply_transposed(&frame->r, q->normal[piece.second]), piece.first);
    return piece;
}

/* The answer from a true facet, where that is enough. */
static bool settle(struct task *task, const pir_facet *facet) {
    const pir_placement *placement = task->placement;
    double slack = facet->h - pir_vec_dot(facet->n, placement->x), error = placement->error * facet->err;
    int side = slack > error ? 1 : slack < -error ? -1 : pir_facet_side(task->exact, placement, facet);
    if (side < 0) {
        pir_nearest nearest;
        task->is_outside = true;
        if (!(task->want & PIR_WANT_SEPARATION))
            return true;
        if (!pir_nearest_at_facet(task->exact, placement, facet, &nearest))
            return false;
        answer_near(task, &nearest);
        return true;
    }
    if (!pir_foot_settles(task->exact, placement, facet, slack))
        return false;
    answer_overlap(task, side > 0 ? PIR_INSIDE : PIR_BOUNDARY, facet);
    return true;
}

static bool by_facet(struct task *task) {
    pir_facet facet;
    if (!task->pair->has_facet || !pir_facet_prove(task->exact, aim(task), &facet) || !settle(task, &facet))
        return false;
    task->pair->points = 1;
    task->pair->a[0] = facet.a;
    task->pair->b[0] = facet.b;
    task->pair->statistics.by_facet++;
    end(task, PIR_LEVEL_NEAR);
    return true;
}

/* --- by a surface --- */

static pir_overlap overlap_of(const struct task *task) {
    pir_pair *pair = task->pair;
    pir_workspace *workspace = task->workspace;
    if (!pair->surface)
        pair->surface = PIR_ZEROED(&pair->allocator, pir_surface, 1);
    // without memory, one that is not kept
    return (pir_overlap){task->exact, task->placement, pair->surface ? pair->surface : &workspace->spare,
                         &workspace->room, &pair->statistics};
}

/* The answer from a surface about x. */
static bool finish_inside(struct task *task, const pir_overlap *overlap) {
    pir_facet facet;
    if (!(task->want & PIR_WANT_DEPTH)) {
        pir_result_set_state(task->result, PIR_INSIDE);
        task->pair->apart = 0;
    } else {
        if (!pir_overlap_least(overlap, &facet))
            return false;
        answer_overlap(task, PIR_INSIDE, &facet);
    }
    // where a descent begins should x leave the surface
    task->pair->points = 3;
    pir_overlap_nearest(overlap, task->pair->a, task->pair->b);
    task->pair->deep = true;
    task->pair->statistics.by_surface++;
    end(task, PIR_LEVEL_OVERLAPPING);
    return true;
}

static bool by_surface(struct task *task) {
    const pir_surface *surface = task->pair->surface;
    if (!surface || surface->count == 0)
        return false;
    pir_overlap overlap = overlap_of(task);
    return pir_overlap_place(&overlap) && finish_inside(task, &overlap);
}

static bool by_new_surface(struct task *task) {
    const pir_frame *frame = &task->workspace->frame;
    pir_overlap overlap = overlap_of(task);
    bool done = pir_overlap_begin(&overlap, &task->simplex) && finish_inside(task, &overlap);
    if (!done) {
        pir_vec3 inner = pir_vec_add(pir_mat_apply(&frame->r, task->pair->body_p->inner), task->pair->body_q->inner);
        pir_facet facet;
        bool some;
        done = pir_overlap_widen(&overlap, inner, &facet, &some) && finish_inside(task, &overlap);
        if (!done && some) {
            done = settle(task, &facet);
            task->pair->statistics.by_facet += done;
            end(task, PIR_LEVEL_NEAR);
        }
    }
    if (task->pair->surface && task->pair->level != PIR_LEVEL_OVERLAPPING)
        task->pair->surface->count = 0;
    return done;
}

/* --- by descent --- */

/* The farthest of all vertices along n. */
static double farthest(const pir_body *body, pir_vec3 n) {
    double most = -HUGE_VAL;
    for (uint32_t v = 0; v < body->polytope->vertex_count; v++)
        most = fmax(most, pir_vec_dot(n, body->vertex[v]));
    return most;
}

/* A distance from D that is certain, along the direction of a descent. */
static double certain_distance(const struct task *task) {
    const pir_frame *frame = &task->workspace->frame;
    pir_vec3 n = task->simplex.direction;
    double support = farthest(&frame->p, pir_mat_apply_transposed(&frame->r, n)) + farthest(&frame->q, n);
    return pir_vec_dot(n, task->placement->x) - support - 2 * task->placement->error;
}

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
static bool prove(struct task *task, pir_nearest *ret_nearest) {
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
    if (!pir_facet_prove(task->exact, piece, &facet))
        return false;
    double slack = facet.h - pir_vec_dot(facet.n, task->placement->x);
    if (!(slack < -task->placement->error * facet.err) ||
        !pir_nearest_at_facet(task->exact, task->placement, &facet, ret_nearest))
        return false;
    keep_facet(task->pair, &facet);
    return true;
}

/* From outside, where the descent has not proven its end. */
static void finish_outside(struct task *task) {
    pir_nearest nearest;
    if (!(task->want & PIR_WANT_SEPARATION))
        return;
    if (pir_nearest_find(task->exact, task->placement, &task->simplex, &nearest, &task->result->steps))
        answer_near(task, &nearest);
    else
        pir_result_unfinished(&task->workspace->frame, &task->simplex, task->result);
}

static bool by_descent(struct task *task) {
    const pir_placement *placement = task->placement;
    const double error = PIR_DISTANCE_ERROR * placement->reach;
    pir_simplex *simplex = &task->simplex;
    pir_nearest nearest;
    recall_simplex(task->pair, simplex);
    pir_descend_to_point(&task->workspace->frame, placement, task->limit + error, simplex, &task->result->steps);
    bool far = simplex->lower > PIR_CLEARLY_APART * placement->reach && simplex->lower > 4 * placement->error;
    bool beyond = simplex->lower > task->limit + error;
    if (far && !beyond && prove(task, &nearest)) {
        answer_near(task, &nearest);
    } else {
        double distance = simplex->lower > 0 ? certain_distance(task) : 0;
        if (!task->is_outside && !(distance > 0))
            return false;
        if (distance > 0)
            keep_apart(task, distance);
        if ((task->want & PIR_WANT_SEPARATION) && distance > task->limit + error)
            pir_result_beyond(task->result);
        else
            finish_outside(task);
    }
    keep_simplex(task->pair, simplex);
    task->pair->statistics.by_descent++;
    end(task, PIR_LEVEL_NEAR);
    return true;
}

/* --- the calls --- */

/* Which ways the option allows. */
static bool allows(const pir_pair *pair, pir_level level) {
    return pair->least <= (uint8_t)level && (uint8_t)level <= pair->most;
}

static bool by_need(struct task *task) {
    pir_pair *pair = task->pair;
    if (allows(pair, PIR_LEVEL_APART) && by_certificate(task)) {
        pair->statistics.by_certificate++;
        end(task, PIR_LEVEL_APART);
        return true;
    }
    bool near = allows(pair, PIR_LEVEL_NEAR), deep = allows(pair, PIR_LEVEL_OVERLAPPING), was_deep = pair->deep;
    pair->deep = false;
    if (was_deep && deep && by_surface(task))
        return true;
    if (near && (by_facet(task) || by_descent(task)))
        return true;
    return deep && !task->is_outside && by_new_surface(task);
}

static pir_status answer(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, int want,
                         pir_query_result *ret_result) {
    pir_placement placement;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_pair_begin(pair, workspace, input, &placement);
    if (status != PIR_OK)
        return status;
    pir_query_result result;
    pir_result_clear(&result);
    double radii = input->radius_p + input->radius_q;
    struct task task = {.pair = pair, .workspace = workspace, .placement = &placement, .exact = &workspace->exact};
    task.want = want | (radii > 0 ? PIR_WANT_SEPARATION | PIR_WANT_DEPTH : 0);
    task.limit = pir_frame_from(&workspace->frame, fmax(input->cutoff, 0) + radii);
    task.result = &result;
    pair->statistics.queries++;
    if (!by_need(&task)) {
        if (!allows(pair, PIR_LEVEL_WHOLE))
            return PIR_ERR_UNSUPPORTED;
        status = pir_pair_whole(pair, workspace, input, want, &result);
        if (status != PIR_OK)
            return status;
        pair->statistics.by_whole++;
        end(&task, PIR_LEVEL_WHOLE);
    } else {
        pir_query_input radii_of = {.radius_p = input->radius_p, .radius_q = input->radius_q, .cutoff = input->cutoff};
        pir_result_add_radii(&radii_of, &result);
    }
    pir_pair_to_world(workspace, &result);
    *ret_result = result;
    return PIR_OK;
}

pir_status pir_pair_overlap(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                            pir_query_result *ret_result) {
    pir_query_result result;
    pir_pair_input near;
    if (!input || !ret_result)
        return PIR_ERR_ARGUMENT;
    near = *input;
    bool rounded = input->radius_p + input->radius_q > 0;
    if (rounded)
        near.cutoff = 0;
    pir_status status = answer(pair, workspace, &near, rounded ? PIR_WANT_SEPARATION : 0, &result);
    if (status != PIR_OK)
        return status;
    if (!rounded && result.state != PIR_BOUNDARY) {
        pir_state state = result.state;
        uint32_t steps = result.steps;
        pir_result_clear(&result);
        pir_result_set_state(&result, state);
        result.steps = steps;
    }
    *ret_result = result;
    return PIR_OK;
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

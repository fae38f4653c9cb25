/* SPDX-License-Identifier: MIT */
/*
 * Apart by more than the cutoff, without the nearest point.
 *
 * Along a unit vector n, x is n·x − h(n) from D at least, where h is the sum of both bodies' supports. A climb along
 * n ends at a vertex v of a body where no edge rises by more than ε, which is the rounding of a slope. All of the body
 * is in the cone of these edges. Where all of them fall by the sine c along some other direction, a point at the
 * distance r from v is v and a sum of edges of at most r / c in all. So the body rises above v by ε · 2 · size / c
 * at most.
 *
 * A direction that is kept is tried as it stood with Q, then as it has turned with P: the nearest features are often a
 * facet of either. Round bodies that have moved far are apart from middle to middle, or between all three.
 */
#include "pair/pair_task.h"

/* The most that a climb may have missed of a body's support: see above. */
static inline double missed(const pir_kept_body *body) {
    return 4 * PIR_SLOPE_BOUND * body->slip;
}

/* The farthest of all vertices along n. */
static double farthest(const pir_body *body, pir_vec3 n) {
    double most = -HUGE_VAL;
    for (uint32_t v = 0; v < body->polytope->vertex_count; v++) {
        double along = pir_vec_dot(n, body->vertex[v]);
        most = along > most ? along : most;
    }
    return most;
}

/* A distance from D along the unit vector n that is certain, where climbs along n found `distance`. */
static double certain(const pir_task *task, const pir_pair *pair, pir_vec3 n, double distance) {
    const pir_kept_body *p = pair->body_p, *q = pair->body_q;
    const double error = 2 * task->placement->error;
    if ((p->slip >= 0) & (q->slip >= 0))
        return distance - error - missed(p) - missed(q);
    double support = farthest(&p->body, pir_mat_apply_transposed(&task->frame->r, n)) + farthest(&q->body, n);
    return pir_vec_dot(n, task->placement->x) - support - error;
}

bool pir_pair_is_outside(pir_task *task, double *ret_distance) {
    const pir_simplex *simplex = &task->simplex;
    *ret_distance = 0;
    if (simplex->lower > 0)
        *ret_distance = certain(task, pir_pair_task_of(task)->pair, simplex->direction, simplex->lower);
    return task->is_outside || *ret_distance > 0;
}

/* Keeps n, which is `back` in the frame of P, as the direction to try, and the distance along it as a proof. */
static inline void keep(pir_task *task, pir_vec3 n, pir_vec3 back, double distance) {
    const pir_workspace *workspace = pir_pair_task_of(task)->workspace;
    pir_pair *pair = pir_pair_task_of(task)->pair;
    pir_pair_proof *proof = &pair->proof;
    pair->axis = n;
    pair->axis_of_p = back;
    pair->has_axis = true;
    // `down` is 0 where units are no normal numbers
    proof->leeway = task->frame->down > 0 ? distance : 0;
    proof->down = task->frame->down;
    proof->along = workspace->is_turned ? pir_mat_apply(&workspace->rotation_q.r, n) : n;
    proof->p = workspace->pose[0];
    proof->q = workspace->pose[1];
}

void pir_pair_keep_apart(pir_task *task, pir_vec3 n, double distance) {
    keep(task, n, pir_mat_apply_transposed(&task->frame->r, n), distance);
}

/* Shared by all directions tried. */
struct probe {
    pir_vec3 way; /* to x, from the vertex of D at the supports that were kept */
    double least; /* a distance has to be above this to be an answer */
};

static inline pir_vec3 way_from_kept(const pir_task *task, const pir_pair *pair) {
    return pir_vec_sub(task->placement->x, pir_frame_vertex(task->frame, pair->axis_a, pair->axis_b));
}

static inline struct probe begin_probe(pir_task *task) {
    return (struct probe){way_from_kept(task, pir_pair_task_of(task)->pair), pir_task_least_beyond(task)};
}

/* The answer along n, where x is `distance` along it from that vertex. */
static bool settle_along(pir_task *task, pir_vec3 n, double distance, struct probe *probe) {
    pir_pair *pair = pir_pair_task_of(task)->pair;
    pir_vec3 back;
    uint32_t a = pair->axis_a, b = pair->axis_b;
    pir_pair_task_of(task)->workspace->walker->supports(task->frame, n, &a, &b, &back);
    if (((a ^ pair->axis_a) | (b ^ pair->axis_b)) != 0) {
        pair->axis_a = a;
        pair->axis_b = b;
        probe->way = way_from_kept(task, pair);
        distance = pir_vec_dot(n, probe->way);
    }
    distance = certain(task, pair, n, distance);
    if (!(distance > probe->least))
        return false;
    keep(task, n, back, distance);
    // nothing else has been written yet
    task->result->outcome = PIR_BEYOND_CUTOFF;
    return true;
}

/* Supports are no nearer to x than any vertices, so most directions need none. */
static inline bool is_apart_along(pir_task *task, pir_vec3 n, struct probe *probe) {
    double distance = pir_vec_dot(n, probe->way);
    return distance > probe->least && settle_along(task, n, distance, probe);
}

bool pir_pair_apart_along(pir_task *task, pir_vec3 n) {
    struct probe probe = begin_probe(task);
    return (task->want & PIR_WANT_SEPARATION) && is_apart_along(task, n, &probe);
}

/* The unit vector along d; 0 where d is too short to tell one, and nothing is apart along that. */
static inline pir_vec3 unit_along(pir_vec3 d) {
    double square = pir_vec_dot(d, d);
    return pir_vec_scale(d, square > 0x1p-200 ? 1 / sqrt(square) : 0);
}

/* By the other directions: see above. */
static bool is_apart_elsewhere(pir_task *task, struct probe *probe) {
    const pir_pair *pair = pir_pair_task_of(task)->pair;
    // brought to length 1 each time, so that rounding does not add up from turn to turn
    pir_vec3 n = unit_along(pir_mat_apply(&task->frame->r, pair->axis_of_p));
    pir_vec3 middle = unit_along(task->placement->x);
    return is_apart_along(task, n, probe) || is_apart_along(task, middle, probe) ||
           is_apart_along(task, unit_along(pir_vec_add(middle, pir_vec_add(n, pair->axis))), probe);
}

bool pir_pair_apart(pir_task *task) {
    pir_pair *pair = pir_pair_task_of(task)->pair;
    if (!(task->want & PIR_WANT_SEPARATION))
        return false;
    struct probe probe = begin_probe(task);
    if (is_apart_along(task, pair->axis, &probe) || is_apart_elsewhere(task, &probe))
        return true;
    pair->has_axis = false;
    return false;
}

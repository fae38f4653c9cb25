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
 *
 * That takes no frame: n is turned by both quaternions as they are, and each body is looked at where it lies. With
 * u = 2^-53 a turn by a quaternion is off by 32u, and so n is by 64u as P has it. Each product with it is off by less
 * than 128u of the lengths that it is with, and PIR_PROOF_ERROR is 2^13 u of all of these (tests/proofs/apart.g).
 */
#include "pair/pair_task.h"

/* The most that a climb may have missed of a body's support: see above. */
static inline double missed(const pir_kept_body *body) {
    return 4 * PIR_SLOPE_BOUND * body->slip;
}

/* The farthest of all vertices along n. */
static uint32_t farthest(const pir_body *body, pir_vec3 n) {
    uint32_t farthest = 0;
    double most = -HUGE_VAL;
    for (uint32_t v = 0; v < body->polytope->vertex_count; v++) {
        double along = pir_vec_dot(n, body->vertex[v]);
        farthest = along > most ? v : farthest;
        most = along > most ? along : most;
    }
    return farthest;
}

/* How far a body reaches along n. */
static double support(const pir_body *body, pir_vec3 n) {
    return pir_vec_dot(n, body->vertex[farthest(body, n)]);
}

/* A distance from D along the unit vector n that is certain, where climbs along n found `distance`. */
static double certain(const pir_task *task, const pir_pair *pair, pir_vec3 n, double distance) {
    const pir_kept_body *p = pair->body_p, *q = pair->body_q;
    const double error = 2 * task->placement->error;
    if ((p->slip >= 0) & (q->slip >= 0))
        return distance - error - missed(p) - missed(q);
    double both = support(&p->body, pir_mat_apply_transposed(&task->frame->r, n)) + support(&q->body, n);
    return pir_vec_dot(n, task->placement->x) - both - error;
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
    const double down = task->frame->down;
    pir_pair *pair = pir_pair_task_of(task)->pair;
    pair->axis = n;
    pair->axis_of_p = back;
    pair->has_axis = true;
    // `down` is 0 where units are no normal numbers
    pir_pair_proof_set(&pair->proof, down > 0 ? distance : 0, down,
                       workspace->is_turned ? pir_mat_apply(&workspace->rotation_q.r, n) : n, &workspace->pose[0],
                       &workspace->pose[1]);
}

void pir_pair_keep_apart(pir_task *task, pir_vec3 n, double distance) {
    keep(task, n, pir_mat_apply_transposed(&task->frame->r, n), distance);
}

/* --- in the frame --- */

bool pir_pair_apart_along(pir_task *task, pir_vec3 n) {
    pir_pair *pair = pir_pair_task_of(task)->pair;
    const double least = pir_task_least_beyond(task);
    const pir_vec3 x = task->placement->x;
    if (!(task->want & PIR_WANT_SEPARATION) ||
        !(pir_vec_dot(n, pir_vec_sub(x, pir_frame_vertex(task->frame, pair->axis_a, pair->axis_b))) > least))
        return false;
    pir_vec3 back;
    pir_pair_task_of(task)->workspace->walker->supports(task->frame, n, &pair->axis_a, &pair->axis_b, &back);
    const pir_vec3 nearest = pir_frame_vertex(task->frame, pair->axis_a, pair->axis_b);
    const double distance = certain(task, pair, n, pir_vec_dot(n, pir_vec_sub(x, nearest)));
    if (!(distance > least))
        return false;
    keep(task, n, back, distance);
    // nothing else has been written yet
    task->result->outcome = PIR_BEYOND_CUTOFF;
    return true;
}

/* --- without a frame --- */

/* v turned by q, or back by it. `twice` is 2/|q|². */
static inline pir_vec3 turned(pir_quat q, double twice, pir_vec3 v) {
    const pir_vec3 u = {q.x, q.y, q.z}, across = pir_vec_cross(u, v);
    const pir_vec3 change = pir_vec_add(pir_vec_scale(across, q.w), pir_vec_cross(u, across));
    return pir_vec_add(v, pir_vec_scale(change, twice));
}

static inline pir_vec3 turned_back(pir_quat q, double twice, pir_vec3 v) {
    q.w = -q.w;
    return turned(q, twice, v);
}

/* 2/|q|² of a quaternion that is near unit: what it leaves out is below 2^-58. */
static inline double twice_by_norm(pir_quat q) {
    const double above = pir_quat_norm(q) - 1;
    return 2 - 2 * (above - above * above);
}

/* Bodies as they stand in the world, in units of the frame. */
struct standing {
    pir_pair *pair;
    const pir_walker *walker;
    pir_quat p, q;
    double twice_p, twice_q; /* see above */
    pir_vec3 way;            /* from Q's origin to P's */
    double least;            /* a distance has to be above this to be an answer */
    double error;            /* of a distance along a direction */
    bool has_far;            /* the middle of either is not at its origin */
};

/* A unit vector in the world, and as each body has it. */
struct view {
    pir_vec3 world, p, q;
};

static inline struct view view_with_q(const struct standing *at, pir_vec3 n) {
    const pir_vec3 world = turned(at->q, at->twice_q, n);
    return (struct view){world, turned_back(at->p, at->twice_p, world), n};
}

static inline struct view view_with_p(const struct standing *at, pir_vec3 n) {
    const pir_vec3 world = turned(at->p, at->twice_p, n);
    return (struct view){world, n, turned_back(at->q, at->twice_q, world)};
}

static inline struct view view_of_world(const struct standing *at, pir_vec3 n) {
    return (struct view){n, turned_back(at->p, at->twice_p, n), turned_back(at->q, at->twice_q, n)};
}

/* How far apart the vertices that are kept are along a direction. */
static inline double apart_along(const struct standing *at, const struct view *view) {
    const pir_body *p = &at->pair->body_p->body, *q = &at->pair->body_q->body;
    double distance = pir_vec_dot(view->world, at->way) - pir_vec_dot(view->p, p->vertex[at->pair->axis_a]) -
                      pir_vec_dot(view->q, q->vertex[at->pair->axis_b]);
    if (at->has_far)
        distance -= pir_vec_dot(view->p, pir_dd3_round(p->centre)) + pir_vec_dot(view->q, pir_dd3_round(q->centre));
    return distance;
}

/* Keeps a direction and the distance along it, as `keep` does. */
static void keep_view(const struct standing *at, const struct view *view, const pir_pair_input *input,
                      double distance) {
    at->pair->axis = view->q;
    at->pair->axis_of_p = view->p;
    pir_pair_proof_set(&at->pair->proof, distance, at->pair->down, view->world, &input->pose_p, &input->pose_q);
}

/* A climb tells no support of bodies without a slip. */
static inline uint32_t support_from(const struct standing *at, const pir_kept_body *body, pir_vec3 n, uint32_t from) {
    return body->slip >= 0 ? at->walker->support(&body->body, n, from) : farthest(&body->body, n);
}

/* Supports are no farther apart than any vertices, so most directions that do not part the bodies need none. */
static inline bool is_apart_by(const struct standing *at, struct view view, const pir_pair_input *input) {
    pir_pair *pair = at->pair;
    const pir_kept_body *p = pair->body_p, *q = pair->body_q;
    if (!(apart_along(at, &view) - at->error > at->least))
        return false;
    pair->axis_a = support_from(at, p, view.p, pair->axis_a);
    pair->axis_b = support_from(at, q, view.q, pair->axis_b);
    const double distance = apart_along(at, &view) - at->error;
    if (!(distance > at->least))
        return false;
    keep_view(at, &view, input, distance);
    return true;
}

/* The unit vector along d; 0 where d is too short to tell one, and nothing is apart along that. */
static inline pir_vec3 unit_along(pir_vec3 d) {
    double square = pir_vec_dot(d, d);
    return pir_vec_scale(d, square > 0x1p-200 ? 1 / sqrt(square) : 0);
}

/* The unit vector from the middle of Q's bounds to that of P's. */
static pir_vec3 middle_to_middle(const struct standing *at) {
    pir_vec3 way = at->way;
    if (at->has_far) {
        // P is kept reflected
        way = pir_vec_sub(way, turned(at->p, at->twice_p, pir_dd3_round(at->pair->body_p->body.centre)));
        way = pir_vec_sub(way, turned(at->q, at->twice_q, pir_dd3_round(at->pair->body_q->body.centre)));
    }
    return unit_along(way);
}

/* By the other directions: see above. */
static bool is_apart_elsewhere(const struct standing *at, pir_vec3 with_q, const pir_pair_input *input) {
    // brought to length 1 each time, so that rounding does not add up from turn to turn
    const struct view by_p = view_with_p(at, unit_along(at->pair->axis_of_p));
    if (is_apart_by(at, by_p, input))
        return true;
    const pir_vec3 middle = middle_to_middle(at);
    return is_apart_by(at, view_of_world(at, middle), input) ||
           is_apart_by(at, view_of_world(at, unit_along(pir_vec_add(middle, pir_vec_add(by_p.world, with_q)))), input);
}

/* Whether poses need no more than doubles. */
static inline bool set_standing(pir_pair *pair, const pir_walker *walker, const pir_pair_input *input, double least,
                                struct standing *at) {
    const pir_kept_body *p = pair->body_p, *q = pair->body_q;
    const pir_pose *at_p = &input->pose_p, *at_q = &input->pose_q;
    const double down = pair->down, reach = pir_pair_reach(&p->body, &q->body, at_p, at_q, down);
    if (!pir_poses_are_plain(reach, at_p, at_q))
        return false;
    at->pair = pair;
    at->walker = walker;
    at->p = at_p->rotation;
    at->q = at_q->rotation;
    at->twice_p = twice_by_norm(at->p);
    at->twice_q = twice_by_norm(at->q);
    at->way = pir_vec_scale(pir_vec_sub(at_p->translation, at_q->translation), down);
    at->least = least * down * (1 + 0x1p-40);
    at->error = PIR_PROOF_ERROR * reach + (p->slip > 0 ? missed(p) : 0) + (q->slip > 0 ? missed(q) : 0);
    at->has_far = p->body.far + q->body.far > 0;
    return true;
}

bool pir_pair_apart(pir_pair *pair, const pir_walker *walker, const pir_pair_input *input, double least) {
    struct standing at;
    if (!(pair->down > 0) || pir_pair_check(input) != PIR_OK || !set_standing(pair, walker, input, least, &at))
        return false;
    const struct view by_q = view_with_q(&at, pair->axis);
    if (is_apart_by(&at, by_q, input) || is_apart_elsewhere(&at, by_q.world, input))
        return true;
    pair->has_axis = false;
    return false;
}

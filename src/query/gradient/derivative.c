/* SPDX-License-Identifier: MIT */
/* The derivatives of signed distances: see derivative.h. */
#include "query/gradient/derivative.h"

/* --- the features that decide --- */

static pir_witness features_of(pir_feature_kind kind_p, uint32_t p, pir_feature_kind kind_q, uint32_t q) {
    return (pir_witness){{kind_p, p}, {kind_q, q}};
}

pir_witness pir_deciding_features(const pir_frame *frame, pir_piece decided, pir_witness witness) {
    const pir_feature p = witness.p, q = witness.q;
    const bool are_edges = p.kind == PIR_FEATURE_EDGE && q.kind == PIR_FEATURE_EDGE;
    if (decided.kind == PIR_FACET_EE)
        return features_of(PIR_FEATURE_EDGE, decided.first, PIR_FEATURE_EDGE,
                           frame->q.polytope->artificial ? 0 : frame->q.polytope->edge[decided.second]);
    if (decided.kind == PIR_NO_PIECE || are_edges)
        return witness;
    // parallel faces: the corner that the witness is at
    if (decided.kind == PIR_FACET_FV && !(p.kind == PIR_FEATURE_VERTEX && q.kind == PIR_FEATURE_FACET))
        return features_of(PIR_FEATURE_FACET, decided.first, q.kind, q.index);
    return features_of(p.kind, p.index, PIR_FEATURE_FACET, decided.kind == PIR_FACET_FV ? q.index : decided.second);
}

/* The direction of an edge of a body, in Q's frame or the world. */
static pir_vec3 direction_of(const pir_polytope *p, uint32_t edge, const pir_mat3 *r, const pir_mat3 *turn) {
    pir_vec3 e = p->direction[p->edge_half[edge]];
    if (r)
        e = pir_mat_apply(r, e);
    return turn ? pir_mat_apply(turn, e) : e;
}

bool pir_decider_set(const pir_frame *frame, const pir_mat3 *turn, const pir_query_result *result, pir_witness features,
                     const pir_deriving *deriving, pir_decider *ret_decider) {
    const pir_vec3 n = result->normal;
    if (n.x == 0 && n.y == 0 && n.z == 0)
        return false;
    ret_decider->features = features;
    ret_decider->n = n;
    ret_decider->distance = result->distance + (deriving->radius_p + deriving->radius_q);
    ret_decider->y = pir_vec_sub(result->point_q, pir_vec_scale(n, deriving->radius_q));
    ret_decider->x = pir_vec_add(ret_decider->y, pir_vec_scale(n, ret_decider->distance));
    ret_decider->origin_p = deriving->origin_p;
    ret_decider->origin_q = deriving->origin_q;
    if (features.p.kind == PIR_FEATURE_EDGE)
        ret_decider->along_p = direction_of(frame->p.polytope, features.p.index, &frame->r, turn);
    if (features.q.kind == PIR_FEATURE_EDGE)
        ret_decider->along_q = direction_of(frame->q.polytope, features.q.index, NULL, turn);
    return true;
}

/* --- first derivatives --- */

void pir_gradient_fill(const pir_decider *decider, pir_wrench *ret_p, pir_wrench *ret_q) {
    const pir_vec3 n = decider->n, back = pir_vec_scale(n, -1);
    *ret_p = (pir_wrench){n, pir_vec_cross(pir_vec_sub(decider->x, decider->origin_p), n)};
    *ret_q = (pir_wrench){back, pir_vec_cross(pir_vec_sub(decider->y, decider->origin_q), back)};
}

/* --- linear forms in the twelve numbers of both motions --- */

enum { TURN_P = 3, MOVE_Q = 6, TURN_Q = 9, NUMBERS = 12 };

typedef struct pir_gradient_form {
    double c[NUMBERS];
} pir_gradient_form;

static inline void set_three(pir_gradient_form *form, int at, pir_vec3 v) {
    form->c[at] = v.x;
    form->c[at + 1] = v.y;
    form->c[at + 2] = v.z;
}

/* t·u, the motion of P's point relative to Q's along t. */
static inline pir_gradient_form motion_along(const pir_decider *decider, pir_vec3 t) {
    pir_gradient_form form;
    const pir_vec3 back = pir_vec_scale(t, -1);
    set_three(&form, 0, t);
    set_three(&form, TURN_P, pir_vec_cross(pir_vec_sub(decider->x, decider->origin_p), t));
    set_three(&form, MOVE_Q, back);
    set_three(&form, TURN_Q, pir_vec_cross(pir_vec_sub(decider->y, decider->origin_q), back));
    return form;
}

/* t·(ω × n), the turn of a normal that is fixed to a body. */
static inline pir_gradient_form turn_along(const pir_decider *decider, int turn, pir_vec3 t) {
    pir_gradient_form form = {{0}};
    set_three(&form, turn, pir_vec_cross(decider->n, t));
    return form;
}

static inline pir_gradient_form scaled(const pir_gradient_form *form, double s) {
    pir_gradient_form r;
    for (int i = 0; i < NUMBERS; i++)
        r.c[i] = form->c[i] * s;
    return r;
}

/* --- the turn of the normal --- */

/* T1, T2, b and ν of derivative.h. */
struct across {
    pir_vec3 t[2];
    pir_gradient_form b[2], turn[2];
};

/* Two unit vectors across n, the first along a direction that is nearly so. */
static inline void set_axes(pir_vec3 n, pir_vec3 along, pir_vec3 t[2]) {
    along = pir_vec_sub(along, pir_vec_scale(n, pir_vec_dot(n, along)));
    t[0] = pir_vec_scale(along, 1 / pir_vec_length(along));
    t[1] = pir_vec_cross(n, t[0]);
}

/* Any two unit vectors across n. */
static inline void set_any_axes(pir_vec3 n, pir_vec3 t[2]) {
    const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    const pir_vec3 least = {(x <= y) & (x <= z), (y < x) & (y <= z), (z < x) & (z < y)};
    set_axes(n, least, t);
}

static void set_motions(const pir_decider *decider, struct across *across) {
    for (int i = 0; i < 2; i++)
        across->b[i] = motion_along(decider, across->t[i]);
}

/* The normal of a facet, which turns with its body. */
static void turn_with_facet(const pir_decider *decider, int turn, struct across *across) {
    set_any_axes(decider->n, across->t);
    set_motions(decider, across);
    for (int i = 0; i < 2; i++)
        across->turn[i] = turn_along(decider, turn, across->t[i]);
}

/* The normal of two edges. False where they are parallel. */
static bool turn_with_edges(const pir_decider *decider, struct across *across) {
    set_axes(decider->n, decider->along_p, across->t);
    set_motions(decider, across);
    const double cosine = pir_vec_dot(decider->along_q, across->t[0]),
                 sine = pir_vec_dot(decider->along_q, across->t[1]);
    across->turn[0] = turn_along(decider, TURN_P, across->t[0]);
    const pir_gradient_form by_q = turn_along(decider, TURN_Q, decider->along_q);
    const double inverse = 1 / sine;
    for (int i = 0; i < NUMBERS; i++)
        across->turn[1].c[i] = (by_q.c[i] - cosine * across->turn[0].c[i]) * inverse;
    return inverse * 0 == 0;
}

/* The normal from a vertex to a vertex, or to an edge of the body with this turn. False where they are at one place. */
static bool turn_with_points(const pir_decider *decider, int turn, struct across *across) {
    const double inverse = 1 / decider->distance;
    if (turn)
        set_axes(decider->n, turn == TURN_P ? decider->along_p : decider->along_q, across->t);
    else
        set_any_axes(decider->n, across->t);
    set_motions(decider, across);
    across->turn[0] = turn ? turn_along(decider, turn, across->t[0]) : scaled(&across->b[0], inverse);
    across->turn[1] = scaled(&across->b[1], inverse);
    return decider->distance > 0 && inverse < HUGE_VAL;
}

static bool set_across(const pir_decider *decider, struct across *across) {
    const pir_feature_kind p = decider->features.p.kind, q = decider->features.q.kind;
    if (p == PIR_FEATURE_FACET || q == PIR_FEATURE_FACET) {
        turn_with_facet(decider, p == PIR_FEATURE_FACET ? TURN_P : TURN_Q, across);
        return true;
    }
    if (p == PIR_FEATURE_EDGE && q == PIR_FEATURE_EDGE)
        return turn_with_edges(decider, across);
    return turn_with_points(decider, p == PIR_FEATURE_EDGE ? TURN_P : q == PIR_FEATURE_EDGE ? TURN_Q : 0, across);
}

/* --- second derivatives --- */

/* The Jacobian of the normal: Σ T ν. Its block to P's translation is symmetric, to the bit too. */
static void set_normal(const struct across *across, double normal[3][NUMBERS]) {
    const pir_vec3 s = across->t[0], t = across->t[1];
    const double *u = across->turn[0].c, *v = across->turn[1].c;
    for (int i = 0; i < NUMBERS; i++) {
        normal[0][i] = s.x * u[i] + t.x * v[i];
        normal[1][i] = s.y * u[i] + t.y * v[i];
        normal[2][i] = s.z * u[i] + t.z * v[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++) {
            normal[i][j] = normal[j][i];
            normal[i][MOVE_Q + j] = normal[j][MOVE_Q + i];
        }
}

/*
 * The block of the Hessian to two turns: Σ ν cᵀ + c νᵀ with c = b − ½ d ν. The order of terms makes a block
 * on the diagonal symmetric to the bit.
 */
static inline void set_turns(const struct across *across, const pir_gradient_form rest[2], int row, int column,
                             double hessian[NUMBERS][NUMBERS]) {
    const double *u = across->turn[0].c, *v = across->turn[1].c, *s = rest[0].c, *t = rest[1].c;
    for (int i = row; i < row + 3; i++)
        for (int j = column; j < column + 3; j++)
            hessian[i][j] = (u[i] * s[j] + s[i] * u[j]) + (v[i] * t[j] + t[i] * v[j]);
}

/* Adds ± the second order of n·(e^ω r) in ω: n rᵀ + r nᵀ halved, less n·r on the diagonal. */
static inline void add_turned_point(pir_vec3 n, pir_vec3 r, double sign, int at, double hessian[NUMBERS][NUMBERS]) {
    const double a[3] = {n.x, n.y, n.z}, b[3] = {r.x, r.y, r.z}, dot = pir_vec_dot(n, r);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            hessian[at + i][at + j] += sign * (0.5 * (a[i] * b[j] + a[j] * b[i]));
        hessian[at + i][at + i] -= sign * dot;
    }
}

/* Rows and columns to translations: the derivative to P's is the normal, that to Q's its opposite. */
static inline void set_translations(double normal[3][NUMBERS], double hessian[NUMBERS][NUMBERS]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < NUMBERS; j++) {
            hessian[i][j] = normal[i][j];
            hessian[MOVE_Q + i][j] = -normal[i][j];
        }
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++) {
            hessian[TURN_P + j][k] = normal[k][TURN_P + j];
            hessian[TURN_P + j][MOVE_Q + k] = -normal[k][TURN_P + j];
            hessian[TURN_Q + j][k] = normal[k][TURN_Q + j];
            hessian[TURN_Q + j][MOVE_Q + k] = -normal[k][TURN_Q + j];
        }
}

static void set_hessian(const pir_decider *decider, const struct across *across, pir_curvature *curvature) {
    double(*hessian)[NUMBERS] = curvature->hessian;
    pir_gradient_form rest[2];
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < NUMBERS; i++)
            rest[k].c[i] = across->b[k].c[i] - 0.5 * decider->distance * across->turn[k].c[i];
    set_translations(curvature->normal, hessian);
    set_turns(across, rest, TURN_P, TURN_P, hessian);
    set_turns(across, rest, TURN_P, TURN_Q, hessian);
    set_turns(across, rest, TURN_Q, TURN_Q, hessian);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            hessian[TURN_Q + j][TURN_P + i] = hessian[TURN_P + i][TURN_Q + j];
    add_turned_point(decider->n, pir_vec_sub(decider->x, decider->origin_p), 1, TURN_P, hessian);
    add_turned_point(decider->n, pir_vec_sub(decider->y, decider->origin_q), -1, TURN_Q, hessian);
}

void pir_curvature_fill(const pir_decider *decider, pir_curvature *ret_curvature) {
    struct across across;
    ret_curvature->is_known = set_across(decider, &across);
    if (!ret_curvature->is_known) {
        *ret_curvature = (pir_curvature){.is_known = false};
        return;
    }
    set_normal(&across, ret_curvature->normal);
    set_hessian(decider, &across, ret_curvature);
}

void pir_derive(const pir_frame *frame, const pir_mat3 *turn, pir_piece decided, const pir_query_result *result,
                const pir_deriving *deriving, pir_gradient *ret_gradient, pir_curvature *ret_curvature) {
    pir_decider decider;
    const pir_witness features = pir_deciding_features(frame, decided, result->witness);
    if (!pir_decider_set(frame, turn, result, features, deriving, &decider)) {
        *ret_gradient = (pir_gradient){.features = {{PIR_FEATURE_NONE, 0}, {PIR_FEATURE_NONE, 0}}};
        if (ret_curvature)
            *ret_curvature = (pir_curvature){.is_known = false};
        return;
    }
    pir_gradient_fill(&decider, &ret_gradient->p, &ret_gradient->q);
    ret_gradient->features = features;
    if (ret_curvature)
        pir_curvature_fill(&decider, ret_curvature);
}

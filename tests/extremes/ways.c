/* SPDX-License-Identifier: MIT */
/* See ways.h. */
#include "extremes/ways.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pair.h>

#include "support/meshes.h"

/* --- sums --- */

/* The greatest difference of a coordinate from the exact one. */
static double error_of_mesh(const pir_mesh *mesh, double size) {
    mpq_t exact[3], is;
    double worst = 0;
    mpq_inits(exact[0], exact[1], exact[2], is, NULL);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        pir_vec3 at = pir_mesh_vertices(mesh)[v];
        const double x[3] = {at.x, at.y, at.z};
        pir_mesh_vertex_exact(mesh, v, exact);
        double most = fmax(size, exact_largest(at));
        for (int k = 0; k < 3; k++) {
            // the quotient is rational: the difference may be below the least double
            mpq_set_d(is, x[k]);
            mpq_sub(exact[k], exact[k], is);
            mpq_set_d(is, most);
            mpq_div(exact[k], exact[k], is);
            worst = fmax(worst, fabs(mpq_get_d(exact[k])));
        }
    }
    mpq_clears(exact[0], exact[1], exact[2], is, NULL);
    return worst;
}

static const char *check_methods(pir_sum *sum, pir_quat rotation) {
    pir_sum *other = NULL;
    const char *wrong = NULL;
    if (pir_sum_clone(sum, NULL, &other) != PIR_OK)
        return "no clone";
    if (pir_sum_reset(other, rotation) != PIR_OK || !pir_sum_same_pairing(sum, other))
        wrong = "update and walk differ";
    else if (pir_sum_rotate(other, rotation, PIR_METHOD_CGM) != PIR_OK || !pir_sum_same_pairing(sum, other))
        wrong = "update and CGM differ";
    pir_sum_destroy(other);
    return wrong;
}

const char *way_sum(pir_sum *sum, pir_quat rotation, double size, double *worst) {
    pir_mesh *mesh = NULL;
    if (pir_sum_rotate(sum, rotation, PIR_METHOD_UPDATE) != PIR_OK)
        return "no rotation";
    const char *wrong = check_methods(sum, rotation);
    if (wrong)
        return wrong;
    if (!pir_sum_is_valid(sum))
        return "a pair does not hold";
    if (pir_sum_mesh(sum, PIR_EXACT, &mesh) != PIR_OK)
        return "no mesh";
    wrong = test_prove_mesh(sum, mesh);
    *worst = fmax(*worst, error_of_mesh(mesh, size));
    pir_mesh_destroy(mesh);
    return wrong;
}

/* --- pairs and scenes --- */

/* The greatest coordinate that a scene takes. */
#define SCENE_REACH 0x1p60

static double reach_of(const pir_polytope *p) {
    pir_vec3 low, high;
    pir_polytope_bounds(p, &low, &high);
    return fmax(exact_largest(low), exact_largest(high));
}

const char *way_objects_make(way_objects *o, pir_polytope *p, pir_polytope *q) {
    pir_scene_options options = pir_scene_options_default();
    pir_body_options body = pir_body_options_default();
    *o = (way_objects){0};
    options.detail = PIR_SCENE_DEPTHS;
    if (pir_workspace_create(NULL, &o->workspace) != PIR_OK || pir_pair_create(p, q, NULL, &o->pair) != PIR_OK)
        return "no pair";
    if (pir_scene_create(&options, &o->scene) != PIR_OK)
        return "no scene";
    body.piece_count = 1;
    body.pieces = &p;
    pir_status status = pir_scene_add(o->scene, &body, &o->body_p);
    o->refused = status == PIR_ERR_LIMIT && reach_of(p) > SCENE_REACH;
    if (o->refused)
        return NULL;
    body.pieces = &q;
    if (status != PIR_OK || pir_scene_add(o->scene, &body, &o->body_q) != PIR_OK)
        return "the scene refuses a body";
    if (pir_scene_update(o->scene, NULL, 0) != PIR_OK)
        return "the scene's first update fails";
    size_t count;
    pir_scene_events(o->scene, &count);
    o->touching = count > 0;
    return NULL;
}

void way_objects_free(way_objects *o) {
    pir_scene_destroy(o->scene);
    pir_pair_destroy(o->pair);
    pir_workspace_destroy(o->workspace);
}

/* Whether a pair with Q turned may refuse P's rotation. */
static bool spans_too_much(pir_quat r) {
    double c[4] = {fabs(r.x), fabs(r.y), fabs(r.z), fabs(r.w)}, most = 0, least = HUGE_VAL;
    for (int k = 0; k < 4; k++) {
        most = fmax(most, c[k]);
        least = c[k] > 0 ? fmin(least, c[k]) : least;
    }
    return least / most < 0x1p-899;
}

/* Both poses, half a turn about z on: exact in doubles. */
static pir_pair_input half_turned(pir_quat r, pir_vec3 t) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = (pir_pose){{-r.y, r.x, r.w, -r.z}, {-t.x, -t.y, t.z}};
    input.pose_q.rotation = (pir_quat){0, 0, 1, 0};
    return input;
}

const char *way_pair(way_objects *o, const exact_pair *bodies, pir_quat rotation, const exact_pose *pose,
                     double *worst) {
    pir_pair_input input = pir_pair_input_default(), turned = half_turned(rotation, pose->t);
    pir_query_result result;
    pir_pair *fresh = NULL;
    input.pose_p = (pir_pose){rotation, pose->t};
    if (pir_pair_signed_distance(o->pair, o->workspace, &input, &result) != PIR_OK)
        return "the pair refuses";
    if (!exact_same_bits(&result, &pose->answer))
        return "a lasting pair and the query differ";
    if (pir_pair_create(bodies->body[0].polytope, bodies->body[1].polytope, NULL, &fresh) != PIR_OK)
        return "no new pair";
    pir_status status = pir_pair_signed_distance(fresh, o->workspace, &input, &result);
    bool same = status == PIR_OK && exact_same_bits(&result, &pose->answer);
    status = pir_pair_signed_distance(fresh, o->workspace, &turned, &result);
    pir_pair_destroy(fresh);
    if (!same)
        return "a new pair and the query differ";
    if (status == PIR_ERR_LIMIT && spans_too_much(rotation))
        return NULL;
    if (status != PIR_OK || result.state != pose->state)
        return "both turned by half: another state";
    double scale = fmax(bodies->size + fabs(pose->should), exact_largest(pose->t));
    double error = result.distance == pose->should ? 0 : fabs(result.distance - pose->should) / scale;
    *worst = fmax(*worst, error);
    return error <= 1e-12 ? NULL : "both turned by half: a distance off by more than 1e-12";
}

const char *way_scene(way_objects *o, pir_quat rotation, const exact_pose *pose) {
    pir_scene_move move = {o->body_p, {rotation, pose->t}};
    size_t count = 0;
    if (o->refused)
        return NULL;
    pir_status status = pir_scene_update(o->scene, &move, 1);
    if (status == PIR_ERR_LIMIT && exact_largest(pose->t) > SCENE_REACH / 2)
        return NULL;
    if (status != PIR_OK)
        return "the update fails";
    const pir_scene_event *event = pir_scene_events(o->scene, &count);
    int touches = pose->state != PIR_OUTSIDE, touched = o->touching;
    o->touching = touches;
    if (count != (size_t)(touches || touched))
        return "another number of events";
    if (count == 0)
        return NULL;
    if (event->kind != (!touches ? PIR_EVENT_ENDED : touched ? PIR_EVENT_PERSISTED : PIR_EVENT_BEGAN))
        return "another kind of event";
    if (touches && (event->state != pose->state || event->distance != pose->answer.distance))
        return "another state or distance";
    return pir_scene_is_valid(o->scene) ? NULL : "the scene is not valid";
}

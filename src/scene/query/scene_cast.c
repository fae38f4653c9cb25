/* SPDX-License-Identifier: MIT */
/* The first hit of a moving shape: the least over the pieces that its way may meet, each by pir_pair_fly. */
#include "pair/flight.h"
#include "query/proof/parting.h"
#include "scene/query/probe.h"

struct flight {
    pir_scene *scene;
    pir_probe probe; /* where it begins */
    uint32_t own_piece;
    const pir_motion *motion;
    double tolerance;
};

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

/* The size that rounding is relative to. */
static double size_of(const struct flight *flight, const pir_scene_body *body) {
    return flight->probe.extent.reach + flight->probe.radius + body->reach + body->radius +
           length(flight->probe.pose.translation) + length(flight->motion->way) + length(body->pose.translation);
}

static void set_impact(const struct flight *flight, const pir_scene_piece *piece, const pir_flight_end *end,
                       pir_impact *impact) {
    *impact = (pir_impact){.body = piece->body,
                           .piece_p = flight->own_piece,
                           .piece_q = piece->number,
                           .outcome = end->outcome,
                           .time = end->time,
                           .normal = end->answer.normal,
                           .point = end->answer.point_q,
                           .witness = end->answer.witness};
}

/* The time at which the probe comes within the tolerance of a piece, where that is at most `until`. */
static pir_status advance(const struct flight *flight, uint32_t number, double until, pir_impact *impact,
                          bool *ret_meets) {
    pir_scene *scene = flight->scene;
    const pir_scene_piece *piece = &scene->bodies.piece[number];
    const pir_flight way = {.p = flight->probe.extent.polytope,
                            .from = flight->probe.pose,
                            .motion = flight->motion,
                            .reach = flight->probe.extent.reach,
                            .tolerance = flight->tolerance,
                            .size = size_of(flight, &scene->bodies.body[piece->body])};
    pir_pair *pair;
    pir_pair_input input;
    pir_flight_end end;
    pir_status status = pir_probe_pair(&flight->probe, number, &pair, &input);
    if (status == PIR_OK)
        status = pir_pair_fly(pair, scene->worker[0].workspace, &input, &way, until, &end);
    if (status != PIR_OK || end.outcome == PIR_CAST_MISS)
        return status;
    *ret_meets = true;
    set_impact(flight, piece, &end, impact);
    return PIR_OK;
}

/* A box that holds the probe on all its way. */
static pir_box box_of_way(const struct flight *flight) {
    const pir_probe *probe = &flight->probe;
    const pir_vec3 begin = probe->pose.translation, end = pir_vec_add(begin, flight->motion->way);
    const double from[3] = {begin.x, begin.y, begin.z}, to[3] = {end.x, end.y, end.z};
    // a turn takes no point farther than its arc, nor out of the ball about the origin
    const double arc = length(flight->motion->turn) * flight->probe.extent.reach * (1 + 0x1p-40),
                 ball = flight->probe.extent.reach + flight->probe.radius;
    pir_box box;
    for (int k = 0; k < 3; k++) {
        double low = probe->box.low[k] - from[k], high = probe->box.high[k] - from[k];
        if (arc > 0) {
            low = fmax(low - arc, -ball);
            high = fmin(high + arc, ball);
        }
        double room = flight->tolerance + 0x1p-40 * (fabs(from[k]) + fabs(to[k]) + high - low);
        box.low[k] = pir_float_below(fmin(from[k], to[k]) + low - room);
        box.high[k] = pir_float_above(fmax(from[k], to[k]) + high + room);
    }
    return box;
}

static bool comes_before(const pir_impact *a, const pir_impact *b) {
    if (b->body == PIR_SCENE_NONE || a->time != b->time)
        return b->body == PIR_SCENE_NONE || a->time < b->time;
    const uint32_t x[3] = {a->body, a->piece_q, a->piece_p}, y[3] = {b->body, b->piece_q, b->piece_p};
    for (int k = 0; k < 3; k++)
        if (x[k] != y[k])
            return x[k] < y[k];
    return false;
}

static pir_status fly(const struct flight *flight, pir_impact *first) {
    const pir_tree *tree = &flight->scene->tree;
    pir_box box = box_of_way(flight);
    for (uint32_t leaf = pir_tree_first(tree, &box); leaf != PIR_TREE_NONE; leaf = pir_tree_next(tree, &box, leaf)) {
        uint32_t piece = pir_tree_item(tree, leaf);
        pir_impact impact;
        bool meets = false;
        if (!pir_box_meets(&box, &flight->scene->bodies.piece[piece].tight) || !pir_probe_meets(&flight->probe, piece))
            continue;
        pir_status status = advance(flight, piece, first->time, &impact, &meets);
        if (status != PIR_OK)
            return pir_fail(flight->scene->report, status, "cast: body %u, piece %u: %s",
                            (unsigned)flight->scene->bodies.piece[piece].body,
                            (unsigned)flight->scene->bodies.piece[piece].number, pir_status_text(status));
        if (meets && comes_before(&impact, first))
            *first = impact;
    }
    return PIR_OK;
}

static pir_status check(const pir_scene *scene, const pir_motion *motion, double tolerance) {
    const pir_status status = pir_motion_check(motion, tolerance);
    if (status != PIR_OK)
        return pir_fail(scene->report, status, "cast: its motion or tolerance: %s", pir_status_text(status));
    if (!(length(motion->way) <= PIR_BOX_FARTHEST))
        return pir_fail(scene->report, PIR_ERR_LIMIT, "cast: its way is longer than 2^60");
    return PIR_OK;
}

static const pir_impact no_impact = {
    .body = PIR_SCENE_NONE, .piece_q = PIR_SCENE_NONE, .outcome = PIR_CAST_MISS, .time = 1};

pir_status pir_scene_cast(pir_scene *scene, const pir_scene_shape *shape, const pir_motion *motion, double tolerance,
                          pir_impact *ret_impact) {
    if (!scene || !shape || !motion || !ret_impact)
        return PIR_ERR_ARGUMENT;
    struct flight flight = {.scene = scene, .motion = motion, .tolerance = tolerance};
    pir_status status = check(scene, motion, tolerance);
    if (status == PIR_OK)
        status = pir_probe_of_shape(scene, shape, &flight.probe);
    if (status != PIR_OK)
        return status;
    pir_impact first = no_impact;
    status = fly(&flight, &first);
    if (status == PIR_OK)
        *ret_impact = first;
    return status;
}

pir_status pir_scene_time_of_impact(pir_scene *scene, uint32_t body, const pir_motion *motion, double tolerance,
                                    pir_impact *ret_impact) {
    if (!scene || !motion || !ret_impact)
        return PIR_ERR_ARGUMENT;
    if (!pir_bodies_has(&scene->bodies, body))
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "time of impact: there is no body %u", (unsigned)body);
    if (scene->bodies.body[body].sensor)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "time of impact: body %u is a sensor", (unsigned)body);
    pir_status status = check(scene, motion, tolerance);
    pir_impact first = no_impact;
    for (uint32_t p = scene->bodies.body[body].first; status == PIR_OK && p != PIR_PIECE_NONE;
         p = scene->bodies.piece[p].next) {
        struct flight flight = {.scene = scene,
                                .probe = pir_probe_of_piece(scene, p),
                                .own_piece = scene->bodies.piece[p].number,
                                .motion = motion,
                                .tolerance = tolerance};
        status = fly(&flight, &first);
    }
    if (status == PIR_OK)
        *ret_impact = first;
    return status;
}

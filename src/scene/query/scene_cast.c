/* SPDX-License-Identifier: MIT */
/*
 * The hits of a moving shape, the first or all: of the pieces that its way may meet, each by pir_pair_fly, and of
 * triangles, each by doubles where these settle it.
 */
#include "scene/query/scene_cast.h"
#include "mesh/query/mesh_walk.h"
#include "pair/flight.h"
#include "scene/change/changes.h"
#include "scene/query/core_flight.h"
#include "scene/query/near_pieces.h"
#include "scene/query/swept_pieces.h"
#include "scene/world/grow.h"
#include "scene/world/near_triangles.h"
#include "scene/world/surfaces.h"
#include "scene/world/triangles.h"

struct flight {
    pir_scene *scene;
    pir_probe probe; /* where it begins */
    uint32_t own_piece;
    const pir_motion *motion;
    double tolerance;
    pir_box box; /* all its way is in it */
    pir_status (*take)(struct flight *flight, const pir_scene_met *met);
    pir_scene_met *first;   /* so far, where that alone is wanted */
    size_t capacity, count; /* else of the scene's room for hits */
    double until;           /* times beyond this are not looked for */
    bool by_doubles;        /* whether `core` has been begun */
    pir_core_flight core;   /* where the probe begins */
};

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

/* The size that rounding is relative to. */
static double size_of(const struct flight *flight, const pir_scene_body *body) {
    return flight->probe.extent.reach + flight->probe.radius + body->reach + body->radius +
           length(flight->probe.pose.translation) + length(flight->motion->way) + length(body->pose.translation);
}

static void set_met(const struct flight *flight, const pir_scene_piece *piece, const pir_flight_end *end,
                    pir_scene_met *met) {
    met->impact = (pir_impact){.body = piece->body,
                               .piece_p = flight->own_piece,
                               .piece_q = piece->number,
                               .piece_user = pir_piece_user(&flight->scene->bodies, piece),
                               .outcome = end->outcome,
                               .time = end->time,
                               .normal = end->answer.normal,
                               .point = end->answer.point_q,
                               .witness = end->answer.witness};
    met->depth = end->outcome == PIR_CAST_START_INSIDE ? -end->answer.distance : -1;
}

/* The time at which the probe comes within the tolerance of a piece, where that is at most `until`. */
static pir_status advance(const struct flight *flight, pir_scene_piece *piece, double until, pir_scene_met *met,
                          bool *ret_meets) {
    pir_scene *scene = flight->scene;
    const pir_flight way = {.p = flight->probe.extent.polytope,
                            .from = flight->probe.pose,
                            .motion = flight->motion,
                            .reach = flight->probe.extent.reach,
                            .tolerance = flight->tolerance,
                            .size = size_of(flight, &scene->bodies.body[piece->body])};
    pir_pair *pair;
    pir_pair_input input;
    pir_flight_end end;
    pir_status status = pir_probe_pair(&flight->probe, piece, &pair, &input);
    if (status == PIR_OK)
        status = pir_pair_fly(pair, scene->worker[0].workspace, &input, &way, until, &end);
    if (status != PIR_OK || end.outcome == PIR_CAST_MISS)
        return status;
    *ret_meets = true;
    set_met(flight, piece, &end, met);
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

/* By time, then by how deep the shape begins in it, then by number. */
static bool comes_before(const void *x_met, const void *y_met) {
    const pir_scene_met *met = x_met, *other = y_met;
    const pir_impact *a = &met->impact, *b = &other->impact;
    if (b->body == PIR_SCENE_NONE || a->time != b->time)
        return b->body == PIR_SCENE_NONE || a->time < b->time;
    if (met->depth != other->depth)
        return met->depth > other->depth;
    const uint32_t x[3] = {a->body, a->piece_q, a->piece_p}, y[3] = {b->body, b->piece_q, b->piece_p};
    for (int k = 0; k < 3; k++)
        if (x[k] != y[k])
            return x[k] < y[k];
    return false;
}

static pir_status fail(const struct flight *flight, pir_status status, const pir_scene_piece *piece) {
    return pir_fail(flight->scene->report, status, "cast: body %u, piece %u: %s", (unsigned)piece->body,
                    (unsigned)piece->number, pir_status_text(status));
}

static pir_status take_first(struct flight *flight, const pir_scene_met *met) {
    if (comes_before(met, flight->first)) {
        *flight->first = *met;
        flight->until = met->impact.time;
    }
    return PIR_OK;
}

static pir_status take_all(struct flight *flight, const pir_scene_met *met) {
    pir_scene *scene = flight->scene;
    const pir_order order = {sizeof *met, flight->capacity, comes_before};
    const bool is_put = pir_put_in_order(&scene->allocator, &scene->answers.met, &scene->answers.met_capacity, &order,
                                         met, &flight->count);
    return is_put ? PIR_OK : pir_fail(scene->report, PIR_ERR_MEMORY, "cast: no memory for %zu hits", flight->count + 1);
}

static pir_status look(void *context, pir_scene_piece *piece) {
    struct flight *flight = context;
    pir_scene_met met;
    bool meets = false;
    if (!pir_box_meets(&flight->box, &piece->tight))
        return PIR_OK;
    const pir_status status = advance(flight, piece, flight->until, &met, &meets);
    if (status != PIR_OK)
        return fail(flight, status, piece);
    return meets ? flight->take(flight, &met) : PIR_OK;
}

/* --- triangles --- */

/* The flight of a probe over the triangles of a body's surface. */
struct surface_flight {
    struct flight *flight;
    const pir_scene_body *body;
    uint32_t number; /* of that body */
    pir_place place;
    pir_core_target target; /* the last triangle */
    pir_status status;
};

/* Where doubles settle nothing: by a pair with the triangle as a polytope. */
static pir_status look_at_flat(struct flight *flight, uint32_t body, uint32_t triangle) {
    pir_scene *scene = flight->scene;
    pir_scene_piece piece = pir_triangle_piece(&scene->bodies, body, triangle);
    piece.extent.polytope = pir_triangles_recall(&scene->bodies, body, triangle);
    piece.tight = flight->box;
    const pir_status status = look(flight, &piece);
    pir_triangles_keep(&scene->bodies, &scene->allocator, &piece);
    return status;
}

static bool look_at_triangle(void *context, const pir_met_triangle *met) {
    struct surface_flight *on = context;
    struct flight *flight = on->flight;
    const pir_vec3 from = flight->probe.pose.translation, off = pir_vec_sub(on->place.pose.translation, from);
    pir_core_impact met_at;
    for (int k = 0; k < 3; k++)
        on->target.corner[k] = pir_vec_add(pir_mat_apply(&on->place.r, met->tri.p[k]), off);
    if (!flight->by_doubles || !pir_core_fly(&flight->core, &on->target, flight->until, &met_at)) {
        on->status = look_at_flat(flight, on->number, met->number);
        return on->status == PIR_OK;
    }
    if (!met_at.hits)
        return true;
    const pir_scene_met hit = {
        .impact = {.body = on->number,
                   .piece_p = flight->own_piece,
                   .piece_q = met->number,
                   .piece_user = pir_surface_material(pir_body_surface_of(on->body), met->number),
                   .outcome = PIR_CAST_HIT,
                   .time = met_at.time,
                   .normal = met_at.normal,
                   .point = met_at.point,
                   .witness = met_at.witness},
        .depth = -1};
    on->status = flight->take(flight, &hit);
    return on->status == PIR_OK;
}

/* A box that holds the probe at time 0 however it turns until time 1, and is wider by what it is to come near. */
static pir_box box_of_turns(const struct flight *flight) {
    const double arc = length(flight->motion->turn) * flight->probe.extent.reach * (1 + 0x1p-40);
    return pir_probe_wider(&flight->probe, flight->tolerance + arc);
}

static pir_status look_at_surface(struct flight *flight, const pir_scene_body *body) {
    const pir_scene *scene = flight->scene;
    struct surface_flight on = {.flight = flight, .body = body, .number = (uint32_t)(body - scene->bodies.body)};
    const pir_vec3 t = body->pose.translation;
    // more than distances in doubles are off by
    const double room = body->radius + 0x1p-30 * (body->reach + body->radius + fabs(t.x) + fabs(t.y) + fabs(t.z));
    const pir_status status = pir_place_make(body->pose, &on.place);
    if (status != PIR_OK)
        return status;
    const pir_box turned = box_of_turns(flight), wider = pir_box_wider(&turned, room);
    const pir_walk_box from = pir_place_sees(&on.place, &wider);
    const pir_vec3 way = pir_mat_apply_transposed(&on.place.r, flight->motion->way);
    on.target.radius = body->radius;
    on.target.size = size_of(flight, body);
    pir_swept_walk walk = {.until = &flight->until, .look = look_at_triangle, .context = &on};
    pir_swept_box_set(&walk.swept, from.low, from.high, way);
    pir_swept_triangles(body, &walk);
    return on.status;
}

/* --- all pieces --- */

static pir_status look_at_leaf(void *context, pir_scene_piece *piece) {
    struct flight *flight = context;
    return piece->kind == PIR_PIECE_SURFACE ? look_at_surface(flight, &flight->scene->bodies.body[piece->body])
                                            : look(flight, piece);
}

static pir_status fly(struct flight *flight) {
    flight->box = box_of_way(flight);
    flight->by_doubles = pir_core_flight_begin(&flight->core, &flight->probe, flight->motion, flight->tolerance);
    const pir_box from = box_of_turns(flight);
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = from.low[k];
        high[k] = from.high[k];
    }
    pir_swept_box swept;
    pir_swept_box_set(&swept, low, high, flight->motion->way);
    return pir_swept_pieces(&(pir_swept_search){&flight->probe, &swept, &flight->until, look_at_leaf, flight});
}

/* --- surfaces that move --- */

/* A piece in the way of a surface's triangles. */
struct in_the_way {
    struct flight *flight; /* without a probe */
    pir_scene_piece *piece;
};

static pir_status look_from_triangle(void *context, pir_scene_piece *triangle) {
    const struct in_the_way *in_the_way = context;
    struct flight *flight = in_the_way->flight;
    pir_scene *scene = flight->scene;
    pir_status status = pir_piece_ready(&scene->bodies.body[triangle->body], &scene->for_triangles, triangle);
    if (status != PIR_OK)
        return fail(flight, status, triangle);
    flight->probe = pir_probe_of_piece(scene, triangle);
    flight->own_piece = triangle->number;
    flight->box = box_of_way(flight);
    return look(flight, in_the_way->piece);
}

/* The search for triangles that may come to a piece: seen from the surface the piece moves, the other way. */
static pir_near_search near_piece(const struct flight *flight, const pir_probe *piece, const pir_scene_body *body) {
    const pir_motion *motion = flight->motion;
    const double turn = length(motion->turn) * body->reach * (1 + 0x1p-40);
    return (pir_near_search){.probe = piece,
                             .box = pir_probe_wider(piece, flight->tolerance + turn + length(motion->way)),
                             .by = turn > 0 ? PIR_NEAR_BOX : PIR_NEAR_TIME,
                             .from = pir_probe_wider(piece, flight->tolerance),
                             .way = pir_vec_scale(motion->way, -1),
                             .most = &flight->until,
                             .look = look_from_triangle};
}

/* The first hit of a surface that moves: of its triangles that may come to a piece, for each. */
static pir_status fly_surface(struct flight *flight, uint32_t number) {
    pir_scene *scene = flight->scene;
    const pir_scene_body *body = &scene->bodies.body[number];
    const double far =
        length(flight->motion->turn) * body->reach * (1 + 0x1p-40) + length(flight->motion->way) + flight->tolerance;
    const pir_box box = pir_box_wider(&scene->bodies.piece[body->first].tight, far);
    pir_status status = PIR_OK;
    for (uint32_t leaf = pir_tree_first(&scene->tree, &box); leaf != PIR_TREE_NONE && status == PIR_OK;
         leaf = pir_tree_next(&scene->tree, &box, leaf)) {
        pir_scene_piece *q = &scene->bodies.piece[pir_tree_item(&scene->tree, leaf)];
        if (!pir_bodies_meet(&scene->bodies, number, q->body) || scene->bodies.body[q->body].sensor)
            continue;
        const pir_probe piece = pir_probe_of_piece(scene, q);
        struct in_the_way in_the_way = {flight, q};
        pir_near_search near = near_piece(flight, &piece, body);
        near.context = &in_the_way;
        status = pir_near_triangles(&near, body);
    }
    return status;
}

/* The fault of a motion or a tolerance that pir_motion_check refuses. */
static const char *fault_of(const pir_motion *motion, double tolerance) {
    if (!pir_vec_is_finite(motion->way))
        return "its way is not finite";
    if (!pir_vec_is_finite(motion->turn))
        return "its turn is not finite";
    if (isnan(tolerance) || isnan(motion->held))
        return isnan(tolerance) ? "its tolerance is not a number" : "its motion's held is not a number";
    if (!(tolerance > 0 && tolerance < HUGE_VAL))
        return tolerance > 0 ? "its tolerance is infinite" : "its tolerance is not above 0";
    return motion->held >= 0 ? "its turn is longer than 2^20" : "its motion's held is below 0";
}

static pir_status check(const pir_scene *scene, const char *call, const pir_motion *motion, double tolerance) {
    const pir_status status = pir_motion_check(motion, tolerance);
    if (status != PIR_OK)
        return pir_fail(scene->report, status, "%s: %s", call, fault_of(motion, tolerance));
    if (!(length(motion->way) <= PIR_BOX_FARTHEST))
        return pir_fail(scene->report, PIR_ERR_LIMIT, "%s: its way is longer than 2^60", call);
    return PIR_OK;
}

static const pir_scene_met nothing = {
    .impact = {.body = PIR_SCENE_NONE, .piece_q = PIR_SCENE_NONE, .outcome = PIR_CAST_MISS, .time = 1}, .depth = -1};

/* Checks what is asked, and begins a flight that takes nothing yet. */
static pir_status begin(pir_scene *scene, const char *missing, const pir_scene_shape *shape, const pir_motion *motion,
                        double tolerance, struct flight *flight) {
    flight->scene = scene;
    flight->own_piece = 0;
    flight->motion = motion;
    flight->tolerance = tolerance;
    flight->until = 1;
    pir_status status = pir_scene_given(scene, "cast", !shape ? "shape" : !motion ? "motion" : missing);
    if (status == PIR_OK)
        status = check(scene, "cast", motion, tolerance);
    return status == PIR_OK ? pir_probe_of_shape(scene, shape, &flight->probe) : status;
}

pir_status pir_scene_cast(pir_scene *scene, const pir_scene_shape *shape, const pir_motion *motion, double tolerance,
                          pir_impact *ret_impact) {
    struct flight flight; // its points are written when they are needed
    pir_scene_met first = nothing;
    pir_status status = begin(scene, ret_impact ? NULL : "ret_impact", shape, motion, tolerance, &flight);
    if (status != PIR_OK)
        return status;
    flight.take = take_first;
    flight.first = &first;
    status = fly(&flight);
    if (status != PIR_OK)
        return status;
    pir_name_impact(scene, &first.impact);
    *ret_impact = first.impact;
    return PIR_OK;
}

pir_status pir_scene_cast_all(pir_scene *scene, const pir_scene_shape *shape, const pir_motion *motion,
                              double tolerance, size_t capacity, pir_impact *ret_impacts, size_t *ret_count) {
    struct flight flight; // as above
    const char *missing = !ret_impacts && capacity > 0 ? "ret_impacts" : !ret_count ? "ret_count" : NULL;
    pir_status status = begin(scene, missing, shape, motion, tolerance, &flight);
    if (status != PIR_OK)
        return status;
    flight.take = take_all;
    flight.capacity = capacity;
    flight.count = 0;
    status = fly(&flight);
    if (status != PIR_OK)
        return status;
    for (size_t i = 0; i < flight.count && i < capacity; i++) {
        ret_impacts[i] = scene->answers.met[i].impact;
        pir_name_impact(scene, &ret_impacts[i]);
    }
    *ret_count = flight.count;
    return PIR_OK;
}

pir_status pir_scene_fly_body(pir_scene *scene, uint32_t body, const pir_pose *from, const pir_motion *motion,
                              double tolerance, pir_impact *ret_impact) {
    const bool has_surface = pir_body_has_surface(&scene->bodies.body[body]);
    pir_scene_met first = nothing;
    pir_status status = PIR_OK;
    for (uint32_t p = scene->bodies.body[body].first; status == PIR_OK && p != PIR_PIECE_NONE;
         p = scene->bodies.piece[p].next) {
        struct flight flight;
        pir_place place;
        flight.scene = scene;
        flight.probe = pir_probe_of_piece(scene, &scene->bodies.piece[p]);
        flight.own_piece = scene->bodies.piece[p].number;
        flight.motion = motion;
        flight.tolerance = tolerance;
        flight.take = take_first;
        flight.first = &first;
        flight.until = first.impact.time;
        if (from && (pir_place_make(*from, &place) != PIR_OK ||
                     !pir_place_box(&place, &flight.probe.extent, flight.probe.radius, &flight.probe.box)))
            return PIR_ERR_LIMIT;
        flight.probe.pose = from ? *from : flight.probe.pose;
        status = has_surface ? fly_surface(&flight, body) : fly(&flight);
    }
    if (status != PIR_OK)
        return status;
    pir_name_impact(scene, &first.impact);
    *ret_impact = first.impact;
    return PIR_OK;
}

pir_status pir_scene_time_of_impact(pir_scene *scene, uint32_t id, const pir_motion *motion, double tolerance,
                                    pir_impact *ret_impact) {
    const char *missing = !motion ? "motion" : !ret_impact ? "ret_impact" : NULL;
    pir_status status = pir_scene_given(scene, "time of impact", missing);
    uint32_t body;
    if (status == PIR_OK)
        status = pir_scene_find_body(scene, "time of impact", id, &body);
    if (status != PIR_OK)
        return status;
    if (scene->bodies.body[body].sensor)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "time of impact: body %u is a sensor", (unsigned)id);
    status = check(scene, "time of impact", motion, tolerance);
    return status == PIR_OK ? pir_scene_fly_body(scene, body, NULL, motion, tolerance, ret_impact) : status;
}

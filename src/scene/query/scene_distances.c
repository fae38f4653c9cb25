/* SPDX-License-Identifier: MIT */
/*
 * Distances as accurate as is asked for. Of each piece these are tried in turn, until one settles: boxes; balls and
 * supports, where both bodies have coarse ones (far_bounds.h); a pair of the bodies.
 *
 * Settled means: apart, certainly within the cutoff, and known as accurately as is asked for; or certainly beyond the
 * cutoff. So what is told of which piece, but for the width of the bounds, is what pairs would tell.
 */
#include "scene/query/far_bounds.h"
#include "scene/query/near_pieces.h"
#include "scene/world/grow.h"

/* The bound that query.h promises of a distance, with a part in a thousand for the roundings here. */
#define PROMISE 1.001e-12

/* A question about one piece, and what is known. */
struct gauge {
    const pir_probe *probe;
    const pir_placed *placed; /* the probe, or NULL where it has no coarse bodies */
    pir_scene_piece *piece;
    double cutoff;
    pir_accuracy accuracy;
    pir_far_bounds bounds;
    pir_scene_distance known; /* its bounds are those above */
    bool beyond;              /* the cutoff */
};

/* The answers, as they are put together. */
struct distance_list {
    pir_scene *scene;
    size_t capacity, count;
};

static bool comes_before(const void *x, const void *y) {
    const pir_scene_distance *a = x, *b = y;
    return a->body != b->body ? a->body < b->body : a->piece < b->piece;
}

static pir_status put(struct distance_list *told, const pir_scene_distance *distance) {
    pir_scene *scene = told->scene;
    const pir_order order = {sizeof *distance, told->capacity, comes_before};
    const bool is_put = pir_put_in_order(&scene->allocator, &scene->answers.distance, &scene->answers.distance_capacity,
                                         &order, distance, &told->count);
    return is_put ? PIR_OK : PIR_ERR_MEMORY;
}

static double wanted(const struct gauge *gauge) {
    return fmax(gauge->accuracy.length, gauge->accuracy.part * gauge->bounds.least);
}

/* Whether the bounds that are known settle it. */
static bool is_settled(struct gauge *gauge, pir_settled by) {
    const pir_far_bounds *bounds = &gauge->bounds;
    gauge->known.settled = by;
    gauge->beyond = bounds->least > gauge->cutoff + bounds->slack;
    return gauge->beyond || (bounds->least > 0 && bounds->most <= gauge->cutoff - bounds->slack &&
                             bounds->most - bounds->least <= wanted(gauge) + 2 * bounds->slack);
}

static bool is_settled_without_a_pair(struct gauge *gauge, const pir_scene_piece *q) {
    const pir_scene_body *body = &gauge->probe->scene->bodies.body[q->body];
    if (is_settled(gauge, PIR_SETTLED_BY_BOXES))
        return true;
    // boxes are apart by what squares of doubles hold, or meet
    if (!gauge->placed || !q->extent.coarse || !(gauge->bounds.least > 0 && wanted(gauge) > 0))
        return false;
    const pir_placed placed = pir_placed_of(q->extent.coarse, body->unit, body->pose.translation, body->radius);
    pir_far_bounds_by_balls(&gauge->bounds, gauge->placed, &placed);
    if (is_settled(gauge, PIR_SETTLED_BY_COARSE))
        return true;
    pir_far_bounds_by_supports(&gauge->bounds, gauge->placed, &placed, wanted(gauge));
    return is_settled(gauge, PIR_SETTLED_BY_COARSE);
}

static pir_status ask(struct gauge *gauge) {
    pir_pair *pair;
    pir_pair_input input;
    pir_query_result result;
    pir_status status = pir_probe_pair(gauge->probe, gauge->piece, &pair, &input);
    input.cutoff = gauge->cutoff * (1 + 0x1p-40);
    if (status == PIR_OK)
        status = pir_pair_distance(pair, gauge->probe->scene->worker[0].workspace, &input, &result);
    if (status != PIR_OK)
        return status;
    pir_far_bounds *bounds = &gauge->bounds;
    bool apart = result.state == PIR_OUTSIDE;
    gauge->beyond = result.outcome == PIR_BEYOND_CUTOFF || result.distance > gauge->cutoff;
    gauge->known.state = result.state;
    gauge->known.settled = PIR_SETTLED_EXACTLY;
    // after too many steps a distance is a bound from above alone
    if (apart && result.outcome != PIR_STEP_LIMIT)
        bounds->least = fmax(bounds->least, result.distance - bounds->slack);
    bounds->most = apart ? result.distance + bounds->slack : 0;
    bounds->least = apart ? bounds->least : 0;
    return PIR_OK;
}

static pir_status settle(struct gauge *gauge, const pir_scene_piece *q) {
    pir_status status = is_settled_without_a_pair(gauge, q) ? PIR_OK : ask(gauge);
    gauge->known.least = gauge->bounds.least;
    gauge->known.most = gauge->bounds.most;
    return status;
}

/* --- the call --- */

/* The error of a distance in doubles, relative to sizes and coordinates, generously. */
static double slack_of(const pir_probe *probe, const pir_scene_piece *q) {
    const pir_scene_body *body = &probe->scene->bodies.body[q->body];
    pir_vec3 s = probe->pose.translation, t = body->pose.translation;
    double far = fabs(s.x) + fabs(s.y) + fabs(s.z) + fabs(t.x) + fabs(t.y) + fabs(t.z);
    return PROMISE * (2 * (probe->extent.reach + q->extent.reach) + probe->radius + body->radius + far);
}

static pir_status check(const pir_scene *scene, double cutoff, pir_accuracy accuracy) {
    if (isnan(cutoff) || isnan(accuracy.length) || isnan(accuracy.part))
        return pir_fail(scene->report, PIR_ERR_NOT_FINITE, "distances: %s is not a number",
                        isnan(cutoff)            ? "the cutoff"
                        : isnan(accuracy.length) ? "the accuracy's length"
                                                 : "the accuracy's part");
    if (cutoff < 0 || accuracy.length < 0 || accuracy.part < 0)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "distances: %s is below 0",
                        cutoff < 0            ? "the cutoff"
                        : accuracy.length < 0 ? "the accuracy's length"
                                              : "the accuracy's part");
    return PIR_OK;
}

struct distance_look {
    struct gauge asked; /* of no piece yet */
    pir_box box;        /* within which it lies */
    struct distance_list *told;
};

static pir_status look(void *context, pir_scene_piece *q) {
    const struct distance_look *hold = context;
    struct gauge gauge = hold->asked;
    if (!pir_box_meets(&hold->box, &q->tight))
        return PIR_OK;
    gauge.piece = q;
    gauge.bounds = pir_far_bounds_of_boxes(&gauge.probe->box, &q->tight, slack_of(gauge.probe, q));
    gauge.known = (pir_scene_distance){.body = q->body, .piece = q->number, .state = PIR_OUTSIDE};
    gauge.known.piece_user = pir_piece_user(&gauge.probe->scene->bodies, q);
    pir_status status = settle(&gauge, q);
    if (status == PIR_OK && !gauge.beyond)
        status = put(hold->told, &gauge.known);
    if (status != PIR_OK)
        return pir_fail(gauge.probe->scene->report, status, "distances: body %u, piece %u: %s", (unsigned)q->body,
                        (unsigned)q->number, pir_status_text(status));
    return PIR_OK;
}

pir_status pir_scene_distances(pir_scene *scene, const pir_scene_shape *shape, double cutoff, pir_accuracy accuracy,
                               size_t capacity, pir_scene_distance *ret_distances, size_t *ret_count) {
    struct distance_list told = {scene, capacity, 0};
    pir_probe probe;
    pir_place place;
    pir_placed placed;
    const char *missing = !shape                           ? "shape"
                          : !ret_distances && capacity > 0 ? "ret_distances"
                          : !ret_count                     ? "ret_count"
                                                           : NULL;
    pir_status status = pir_scene_given(scene, "distances", missing);
    if (status == PIR_OK)
        status = check(scene, cutoff, accuracy);
    if (status == PIR_OK)
        status = pir_probe_of_shape(scene, shape, &probe);
    if (status != PIR_OK)
        return status;
    struct gauge asked = {.probe = &probe, .cutoff = cutoff, .accuracy = accuracy};
    if (shape->coarse && pir_place_make(shape->pose, &place) == PIR_OK) {
        placed = pir_placed_of(shape->coarse, place.unit, place.pose.translation, shape->radius);
        asked.placed = &placed;
    }
    struct distance_look hold = {asked, pir_probe_wider(&probe, cutoff), &told};
    const double most = 0;
    status = pir_near_pieces(
        &(pir_near_search){.probe = &probe, .box = hold.box, .most = &most, .look = look, .context = &hold});
    if (status != PIR_OK)
        return status;
    for (size_t i = 0; i < told.count && i < capacity; i++) {
        ret_distances[i] = scene->answers.distance[i];
        ret_distances[i].user = scene->bodies.body[ret_distances[i].body].user;
        ret_distances[i].body = pir_body_id(&scene->bodies, ret_distances[i].body);
    }
    *ret_count = told.count;
    return PIR_OK;
}

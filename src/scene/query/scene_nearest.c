/* SPDX-License-Identifier: MIT */
/*
 * The nearest pieces to a shape, and the closest pairs of a scene. The best so far are kept in order. Once there are as
 * many as asked for, the last of them is the cutoff of the next question.
 */
#include "scene/query/near_pieces.h"
#include "scene/world/grow.h"
#include "scene/world/triangles.h"

struct best {
    pir_scene *scene;
    const char *call; /* in reports */
    double cutoff;
    double near_by;     /* what is farther is none of the best */
    size_t most, count; /* of the scene's room for such answers */
};

static bool comes_before(const void *one, const void *other) {
    const pir_scene_near *a = one, *b = other;
    if (a->result.distance != b->result.distance)
        return a->result.distance < b->result.distance;
    const uint32_t x[4] = {a->body_p, a->body_q, a->piece_p, a->piece_q};
    const uint32_t y[4] = {b->body_p, b->body_q, b->piece_p, b->piece_q};
    for (int k = 0; k < 4; k++)
        if (x[k] != y[k])
            return x[k] < y[k];
    return false;
}

static pir_status put(struct best *best, const pir_scene_near *near) {
    pir_scene *scene = best->scene;
    const pir_order order = {sizeof *near, best->most, comes_before};
    const bool is_put = pir_put_in_order(&scene->allocator, &scene->answers.near, &scene->answers.near_capacity, &order,
                                         near, &best->count);
    best->count = best->count < best->most ? best->count : best->most;
    return is_put ? PIR_OK : PIR_ERR_MEMORY;
}

/* How far an answer may be away to be one of the best. */
static double cutoff_of(const struct best *best) {
    if (best->count < best->most)
        return best->cutoff;
    return fmin(best->cutoff, best->scene->answers.near[best->count - 1].result.distance);
}

static pir_status fail(const struct best *best, pir_status status, const pir_scene_piece *q) {
    return pir_fail(best->scene->report, status, "%s: body %u, piece %u: %s", best->call, (unsigned)q->body,
                    (unsigned)q->number, pir_status_text(status));
}

static pir_status ask(const pir_probe *probe, uint32_t own_piece, pir_scene_piece *q, struct best *best) {
    pir_scene *scene = probe->scene;
    pir_pair *pair;
    pir_pair_input input;
    pir_scene_near near = {.body_p = probe->body,
                           .body_q = q->body,
                           .piece_p = own_piece,
                           .piece_q = q->number,
                           .piece_user_p = probe->piece_user,
                           .piece_user_q = pir_piece_user(&scene->bodies, q)};
    pir_status status = pir_probe_pair(probe, q, &pair, &input);
    if (status != PIR_OK)
        return fail(best, status, q);
    // below 0 distances are depths, which no cutoff leaves out; those that tie are asked for in full
    input.cutoff = fmax(cutoff_of(best), 0) * (1 + 0x1p-40);
    status = pir_pair_signed_distance(pair, scene->worker[0].workspace, &input, &near.result);
    near.result.steps = 0;
    if (status == PIR_OK && near.result.outcome != PIR_BEYOND_CUTOFF && near.result.distance <= best->cutoff)
        status = put(best, &near);
    best->near_by = fmax(cutoff_of(best), 0) * (1 + 0x1p-20);
    return status == PIR_OK ? PIR_OK : fail(best, status, q);
}

/* A shape, or a piece of a body, that is held against all pieces that are near. */
struct held_probe {
    const pir_probe *probe;
    uint32_t own_piece;
    pir_scene_piece *q; /* or else this, the probe, is held against the triangles of a surface, each as P */
    struct best *best;
};

static pir_status look(void *context, pir_scene_piece *piece) {
    const struct held_probe *held = context;
    pir_box near = pir_probe_wider(held->probe, held->best->near_by);
    if (!pir_box_meets(&near, &piece->tight) ||
        (held->probe->body != PIR_SCENE_NONE && piece->body < held->probe->body))
        return PIR_OK;
    return ask(held->probe, held->own_piece, piece, held->best);
}

static pir_near_search near_of(const struct held_probe *held) {
    return (pir_near_search){.probe = held->probe,
                             .box = pir_probe_wider(held->probe, held->best->cutoff),
                             .by = PIR_NEAR_DISTANCE,
                             .from = held->probe->box,
                             .most = &held->best->near_by};
}

/* Holds a probe against all pieces that are near; for a piece of a body against those of bodies after it. */
static pir_status hold(const pir_probe *probe, uint32_t own_piece, struct best *best) {
    struct held_probe held = {.probe = probe, .own_piece = own_piece, .best = best};
    pir_near_search near = near_of(&held);
    near.look = look;
    near.context = &held;
    return pir_near_pieces(&near);
}

/* Holds a triangle, as a probe, against a piece. */
static pir_status look_from_triangle(void *context, pir_scene_piece *triangle) {
    const struct held_probe *held = context;
    pir_scene *scene = held->probe->scene;
    pir_box near = pir_probe_wider(held->probe, held->best->near_by);
    if (!pir_box_meets(&near, &triangle->tight))
        return PIR_OK;
    pir_status status = pir_piece_ready(&scene->bodies.body[triangle->body], &scene->for_triangles, triangle);
    if (status != PIR_OK)
        return fail(held->best, status, triangle);
    const pir_probe probe = pir_probe_of_piece(scene, triangle);
    return ask(&probe, triangle->number, held->q, held->best);
}

/* Holds the triangles of a surface against all pieces of bodies after it that are near. */
static pir_status hold_surface(pir_scene *scene, uint32_t body, struct best *best) {
    const pir_scene_piece *whole = &scene->bodies.piece[scene->bodies.body[body].first];
    const pir_box box = pir_box_wider(&whole->tight, best->cutoff);
    pir_status status = PIR_OK;
    for (uint32_t leaf = pir_tree_first(&scene->tree, &box); leaf != PIR_TREE_NONE && status == PIR_OK;
         leaf = pir_tree_next(&scene->tree, &box, leaf)) {
        pir_scene_piece *q = &scene->bodies.piece[pir_tree_item(&scene->tree, leaf)];
        if (q->body < body || !pir_bodies_meet(&scene->bodies, body, q->body) || scene->bodies.body[q->body].sensor)
            continue;
        const pir_probe probe = pir_probe_of_piece(scene, q);
        struct held_probe held = {.probe = &probe, .q = q, .best = best};
        pir_near_search near = near_of(&held);
        near.look = look_from_triangle;
        near.context = &held;
        status = pir_near_triangles(&near, &scene->bodies.body[body]);
    }
    return status;
}

static pir_status check(const struct best *best, const char *missing) {
    const pir_status status = pir_scene_given(best->scene, best->call, missing);
    if (status != PIR_OK)
        return status;
    pir_report *report = best->scene->report;
    if (isnan(best->cutoff))
        return pir_fail(report, PIR_ERR_NOT_FINITE, "%s: the cutoff is not a number", best->call);
    if (best->cutoff < 0)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: the cutoff is %g, below 0", best->call, best->cutoff);
    if (best->most == 0)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: none is asked for, and at least 1 must be", best->call);
    return PIR_OK;
}

static void give(const struct best *best, pir_scene_near *ret_near, size_t *ret_count) {
    const pir_bodies *bodies = &best->scene->bodies;
    for (size_t i = 0; i < best->count; i++) {
        pir_scene_near near = best->scene->answers.near[i];
        near.user_p = near.body_p == PIR_SCENE_NONE ? 0 : bodies->body[near.body_p].user;
        near.user_q = bodies->body[near.body_q].user;
        near.body_p = near.body_p == PIR_SCENE_NONE ? PIR_SCENE_NONE : pir_body_id(bodies, near.body_p);
        near.body_q = pir_body_id(bodies, near.body_q);
        ret_near[i] = near;
    }
    *ret_count = best->count;
}

pir_status pir_scene_nearest(pir_scene *scene, const pir_scene_shape *shape, double cutoff, size_t most,
                             pir_scene_near *ret_near, size_t *ret_count) {
    struct best best = {scene, "nearest", cutoff, cutoff, most, 0};
    pir_probe probe;
    pir_status status = check(&best, !shape ? "shape" : !ret_near ? "ret_near" : !ret_count ? "ret_count" : NULL);
    if (status == PIR_OK)
        status = pir_probe_of_shape(scene, shape, &probe);
    if (status == PIR_OK)
        status = hold(&probe, 0, &best);
    if (status == PIR_OK)
        give(&best, ret_near, ret_count);
    return status;
}

pir_status pir_scene_closest_pairs(pir_scene *scene, double cutoff, size_t most, pir_scene_near *ret_near,
                                   size_t *ret_count) {
    struct best best = {scene, "closest pairs", cutoff, cutoff, most, 0};
    pir_status status = check(&best, !ret_near ? "ret_near" : !ret_count ? "ret_count" : NULL);
    for (uint32_t b = 0; status == PIR_OK && b < scene->bodies.body_end; b++) {
        const pir_scene_body *body = &scene->bodies.body[b];
        const bool is_seen = body->used && !body->sensor && !body->disabled;
        if (is_seen && pir_body_has_surface(body)) {
            status = hold_surface(scene, b, &best);
            continue;
        }
        for (uint32_t p = is_seen ? body->first : PIR_PIECE_NONE; p != PIR_PIECE_NONE && status == PIR_OK;
             p = scene->bodies.piece[p].next) {
            pir_probe probe = pir_probe_of_piece(scene, &scene->bodies.piece[p]);
            status = hold(&probe, scene->bodies.piece[p].number, &best);
        }
    }
    if (status == PIR_OK)
        give(&best, ret_near, ret_count);
    return status;
}

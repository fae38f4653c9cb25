/* SPDX-License-Identifier: MIT */
/* The bodies of a snapshot: see target_bodies.h. */
#include "scene/file/target_bodies.h"

#include <string.h>

#include "base/report.h"
#include "scene/change/changes.h"
#include "scene/world/grow.h"

static double take_double(const uint8_t **at) {
    const uint64_t bits = pir_snapshot_take(at, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

pir_snapshot_body pir_snapshot_body_at(const pir_snapshot *snapshot, uint32_t place) {
    const uint8_t *at = snapshot->body + (size_t)place * PIR_SNAPSHOT_BODY;
    pir_snapshot_body body;
    body.id = (uint32_t)pir_snapshot_take(&at, 4);
    body.pieces = (uint32_t)pir_snapshot_take(&at, 4);
    body.kind = (uint8_t)pir_snapshot_take(&at, 1);
    body.flags = (uint8_t)pir_snapshot_take(&at, 1);
    at += 2;
    body.category = (uint32_t)pir_snapshot_take(&at, 4);
    body.mask = (uint32_t)pir_snapshot_take(&at, 4);
    at += 4;
    body.user = pir_snapshot_take(&at, 8);
    body.shape = pir_snapshot_take(&at, 8);
    body.radius = take_double(&at);
    body.fast = take_double(&at);
    double *const part[7] = {&body.pose.rotation.x,   &body.pose.rotation.y,    &body.pose.rotation.z,
                             &body.pose.rotation.w,   &body.pose.translation.x, &body.pose.translation.y,
                             &body.pose.translation.z};
    for (int k = 0; k < 7; k++)
        *part[k] = take_double(&at);
    return body;
}

static uint32_t generation_at(const pir_snapshot *snapshot, uint32_t number) {
    const uint8_t *at = snapshot->generation + (size_t)4 * number;
    return (uint32_t)pir_snapshot_take(&at, 4);
}

/* --- checks --- */

static pir_status bad(const pir_snapshot *snapshot, uint32_t id, const char *what) {
    return pir_fail(snapshot->report, PIR_ERR_FORMAT, "snapshot: body %u: %s", (unsigned)id, what);
}

/* A body by itself; `least` is the least number that it may have. */
static pir_status check_body(const pir_snapshot *snapshot, const pir_snapshot_body *body, uint32_t place,
                             uint32_t least) {
    const uint8_t *bytes = snapshot->body + (size_t)place * PIR_SNAPSHOT_BODY;
    const uint8_t zeros[4] = {0};
    const uint32_t number = pir_body_number(body->id);
    if (number < least || number >= snapshot->counts.numbers)
        return bad(snapshot, body->id, "it is out of order, or has no number");
    if (body->id >> PIR_NUMBER_BITS != generation_at(snapshot, number) ||
        body->id >> PIR_NUMBER_BITS == PIR_GENERATIONS_LAST)
        return bad(snapshot, body->id, "its generation is another");
    if (body->kind > PIR_BODY_STATIC || body->flags > 15 || memcmp(bytes + 10, zeros, 2) != 0 ||
        memcmp(bytes + 20, zeros, 4) != 0)
        return bad(snapshot, body->id, "there is no such kind of body");
    if (!(body->radius >= 0 && body->radius < HUGE_VAL) || !(body->fast >= 0 && body->fast < HUGE_VAL) ||
        body->pieces < 1 || body->pieces > PIR_PIECES_MAX)
        return bad(snapshot, body->id, "no body has such a radius or such pieces");
    return PIR_OK;
}

static pir_status check_bodies(const pir_snapshot *snapshot) {
    uint32_t least = 0, users = 0;
    if (snapshot->counts.numbers >= PIR_BODIES_MAX)
        return pir_fail(snapshot->report, PIR_ERR_FORMAT, "snapshot: more than 2^20 numbers");
    for (uint32_t n = 0; n < snapshot->counts.numbers; n++)
        if (generation_at(snapshot, n) > PIR_GENERATIONS_LAST)
            return pir_fail(snapshot->report, PIR_ERR_FORMAT, "snapshot: number %u: no such generation", (unsigned)n);
    for (uint32_t i = 0; i < snapshot->counts.bodies; i++) {
        const pir_snapshot_body body = pir_snapshot_body_at(snapshot, i);
        const pir_status status = check_body(snapshot, &body, i, least);
        if (status != PIR_OK)
            return status;
        least = pir_body_number(body.id) + 1;
        users += body.flags & PIR_SNAPSHOT_USERS ? body.pieces : 0;
    }
    if (users != snapshot->counts.users)
        return pir_fail(snapshot->report, PIR_ERR_FORMAT, "snapshot: %u users of pieces, not %u",
                        (unsigned)snapshot->counts.users, (unsigned)users);
    return PIR_OK;
}

/* --- bodies that stay --- */

/* Whether a body of the scene is that of a snapshot, which may have changed. */
static bool is_same(const pir_scene *scene, const pir_snapshot_body *body) {
    const uint32_t number = pir_bodies_find(&scene->bodies, body->id);
    if (number == PIR_SCENE_NONE)
        return false;
    const pir_scene_body *of = &scene->bodies.body[number];
    return of->shape == body->shape && of->pieces == body->pieces && of->kind == body->kind &&
           of->radius == body->radius && of->fast == body->fast;
}

static bool same_pose(const pir_pose *a, const pir_pose *b) {
    return memcmp(&a->rotation, &b->rotation, sizeof a->rotation) == 0 &&
           memcmp(&a->translation, &b->translation, sizeof a->translation) == 0;
}

static void list_move(pir_scene *scene, uint32_t number, pir_pose pose) {
    scene->lists.moved[scene->lists.moved_count++] = (pir_scene_moved){.body = number, .pose = pose};
    scene->bodies.body[number].moved = scene->update;
}

/* Lists a body that stays, where it has another pose or is to find its pairs: it has none yet, or meets others. */
static void keep_body(pir_scene *scene, const pir_snapshot_body *body) {
    const uint32_t number = pir_body_number(body->id);
    pir_scene_body *of = &scene->bodies.body[number];
    const bool sensor = (body->flags & PIR_SNAPSHOT_SENSOR) != 0, disabled = (body->flags & PIR_SNAPSHOT_DISABLED) != 0;
    const bool changes =
        of->category != body->category || of->mask != body->mask || of->sensor != sensor || of->disabled != disabled;
    if (changes) {
        pir_scene_target *target = &scene->target;
        target->changed[target->changed_count++] =
            (pir_scene_changed){number, of->category, of->mask, of->sensor, of->disabled, of->fresh};
        of->category = body->category;
        of->mask = body->mask;
        of->sensor = sensor;
        of->disabled = disabled;
        of->fresh = true;
    }
    if (of->fresh || !same_pose(&of->pose, &body->pose))
        list_move(scene, number, body->pose);
}

/* --- bodies that go --- */

/* Notes what is under a number; a body leaves the tree, and keeps the rest. */
static void put_away(pir_scene *scene, uint32_t number) {
    pir_scene_target *target = &scene->target;
    pir_scene_body *body = &scene->bodies.body[number];
    target->away[target->away_count++] = (pir_scene_away){.number = number, .box = target->box_count, .body = *body};
    for (uint32_t i = body->used ? body->first : PIR_PIECE_NONE; i != PIR_PIECE_NONE; i = scene->bodies.piece[i].next) {
        pir_scene_piece *piece = &scene->bodies.piece[i];
        target->box[target->box_count++] = scene->tree.node[piece->node].box;
        pir_tree_remove(&scene->tree, piece->node);
    }
    scene->bodies.body_count -= body->used;
    body->used = false;
    body->first = PIR_PIECE_NONE;
}

/* --- bodies that come --- */

/* The options of a body from pieces in a list, whose polytopes are put into the target's arrays. */
static void take_pieces(pir_scene *scene, uint32_t first, pir_body_options *options) {
    pir_scene_target *target = &scene->target;
    options->piece_count = 0;
    for (uint32_t i = first; i != PIR_PIECE_NONE; i = scene->bodies.piece[i].next) {
        target->piece[options->piece_count] = scene->bodies.piece[i].extent.polytope;
        target->coarse[options->piece_count++] = scene->bodies.piece[i].extent.coarse;
    }
    options->pieces = target->piece;
    options->coarse = target->coarse;
}

static void take_shape_of(pir_scene *scene, const pir_scene_body *of, pir_body_options *options) {
    options->mesh = of->surface.mesh;
    options->field = of->surface.field;
    if (!pir_body_has_surface(of))
        take_pieces(scene, of->first, options);
}

/* A body, or one that was put away, with a shape; NULL where there is none. */
static const pir_scene_body *find_shape(const pir_scene *scene, uint64_t shape, uint32_t pieces) {
    const pir_bodies *bodies = &scene->bodies;
    for (uint32_t b = 0; b < bodies->body_end; b++)
        if (bodies->body[b].used && bodies->body[b].shape == shape && bodies->body[b].pieces == pieces)
            return &bodies->body[b];
    for (uint32_t i = 0; i < scene->target.away_count; i++) {
        const pir_scene_body *body = &scene->target.away[i].body;
        if (body->used && body->shape == shape && body->pieces == pieces)
            return body;
    }
    return NULL;
}

/* The shape of a body to be: one that is kept, or that of another body. */
static pir_status find_options(pir_scene *scene, const pir_snapshot *snapshot, const pir_snapshot_body *body,
                               pir_body_options *options) {
    const pir_scene_form *kept = pir_kept_shapes_find(&scene->shapes, body->shape);
    const pir_scene_body *other = kept ? NULL : find_shape(scene, body->shape, body->pieces);
    if (kept && (kept->pieces > 0 ? kept->pieces : 1) == body->pieces) {
        options->pieces = kept->piece;
        options->coarse = kept->coarse;
        options->piece_count = kept->pieces;
        options->mesh = kept->mesh;
        options->field = kept->field;
    } else if (other) {
        take_shape_of(scene, other, options);
    } else {
        const pir_scene_body *before = &scene->target.away[scene->target.away_count - 1].body;
        const char *has = !before->used                  ? "is none of the scene"
                          : pir_body_has_surface(before) ? "has another surface in the scene"
                                                         : "has another shape in the scene";
        return pir_fail(snapshot->report, PIR_ERR_ARGUMENT, "snapshot: body %u %s, and its own shape is not kept",
                        (unsigned)body->id, has);
    }
    if ((body->kind == PIR_BODY_MOVING || body->fast > 0) && !options->pieces)
        return bad(snapshot, body->id, "it has a surface and moves, or is fast");
    return PIR_OK;
}

/* Makes a body under its number, which was put away. */
static pir_status make_body(pir_scene *scene, const pir_snapshot *snapshot, const pir_snapshot_body *body) {
    const uint32_t number = pir_body_number(body->id);
    pir_body_options options = pir_body_options_default();
    pir_place place;
    pir_status status = find_options(scene, snapshot, body, &options);
    if (status != PIR_OK)
        return status;
    if (!options.pieces && pir_body_has_surface(&scene->target.away[scene->target.away_count - 1].body))
        return pir_fail(snapshot->report, PIR_ERR_ARGUMENT, "snapshot: body %u has another surface in the scene",
                        (unsigned)body->id);
    options.kind = (pir_body_kind)body->kind;
    options.pose = body->pose;
    options.radius = body->radius;
    options.fast = body->fast;
    options.category = body->category;
    options.mask = body->mask;
    options.sensor = (body->flags & PIR_SNAPSHOT_SENSOR) != 0;
    options.disabled = (body->flags & PIR_SNAPSHOT_DISABLED) != 0;
    status = pir_place_make(body->pose, &place);
    if (status != PIR_OK) {
        char of[48];
        snprintf(of, sizeof of, "snapshot: body %u", (unsigned)body->id);
        pir_place_fail(body->pose, status, of, snapshot->report);
        return PIR_ERR_FORMAT;
    }
    status = pir_scene_body_boxes(scene, &options, &place, scene->lists.box);
    if (status != PIR_OK)
        return bad(snapshot, body->id, "it reaches beyond 2^60");
    pir_bodies_put(&scene->bodies, number, body->id >> PIR_NUMBER_BITS, &options, &place);
    scene->target.away[scene->target.away_count - 1].is_made = true;
    pir_scene_put_leaves(scene, number, scene->lists.box);
    list_move(scene, number, body->pose);
    return PIR_OK;
}

/* --- all of them --- */

/* Room for all that is to come. */
static bool reserve(pir_scene *scene, const pir_snapshot *snapshot) {
    const pir_allocator *a = &scene->allocator;
    pir_scene_target *target = &scene->target;
    pir_scene_lists *lists = &scene->lists;
    const pir_snapshot_counts *counts = &snapshot->counts;
    uint32_t come = 0, most = 0;
    for (uint32_t i = 0; i < counts->bodies; i++) {
        const pir_snapshot_body body = pir_snapshot_body_at(snapshot, i);
        if (is_same(scene, &body))
            continue;
        come += body.pieces;
        most = body.pieces > most ? body.pieces : most;
    }
    return PIR_GROW(a, lists->moved, lists->moved_capacity, counts->bodies) &&
           PIR_GROW(a, scene->fresh, scene->fresh_capacity, counts->bodies) &&
           PIR_GROW(a, lists->asked, lists->asked_capacity, counts->contacts) &&
           PIR_GROW(a, scene->gone, scene->gone_capacity, counts->contacts + counts->ends) &&
           PIR_GROW(a, target->changed, target->changed_capacity, counts->bodies) &&
           (come == 0 || (pir_bodies_reach(&scene->bodies, a, counts->numbers) &&
                          pir_pieces_reserve(&scene->bodies, a, come) == PIR_OK &&
                          pir_tree_reserve(&scene->tree, a, scene->tree.leaves + come) &&
                          PIR_GROW(a, lists->box, lists->box_capacity, most) &&
                          PIR_GROW(a, target->piece, target->piece_capacity, most) &&
                          PIR_GROW(a, target->coarse, target->coarse_capacity, most))) &&
           PIR_GROW(a, target->away, target->away_capacity, scene->bodies.body_end + counts->bodies) &&
           PIR_GROW(a, target->box, target->box_capacity, scene->bodies.piece_count);
}

pir_status pir_target_apply(pir_scene *scene, const pir_snapshot *snapshot) {
    scene->target.away_count = scene->target.changed_count = scene->target.box_count = 0;
    pir_status status = check_bodies(snapshot);
    if (status != PIR_OK)
        return status;
    if (!reserve(scene, snapshot))
        return pir_fail(snapshot->report, PIR_ERR_MEMORY, "snapshot: no memory for %u bodies",
                        (unsigned)snapshot->counts.bodies);
    const uint32_t end = scene->bodies.body_end;
    uint32_t number = 0;
    for (uint32_t i = 0; i < snapshot->counts.bodies && status == PIR_OK; i++) {
        const pir_snapshot_body body = pir_snapshot_body_at(snapshot, i);
        for (; number < pir_body_number(body.id); number++)
            if (number < end && scene->bodies.body[number].used)
                put_away(scene, number);
        number++;
        if (is_same(scene, &body)) {
            keep_body(scene, &body);
            continue;
        }
        put_away(scene, pir_body_number(body.id));
        status = make_body(scene, snapshot, &body);
    }
    for (; number < end && status == PIR_OK; number++)
        if (scene->bodies.body[number].used)
            put_away(scene, number);
    return status;
}

/* --- the end --- */

/* Takes a body that was made out again. */
static void unmake(pir_scene *scene, uint32_t number) {
    pir_scene_end_pairs(scene, number, true);
    for (uint32_t i = scene->bodies.body[number].first; i != PIR_PIECE_NONE; i = scene->bodies.piece[i].next)
        pir_tree_remove(&scene->tree, scene->bodies.piece[i].node);
    pir_bodies_empty(&scene->bodies, number);
    scene->bodies.body_count--;
}

void pir_target_undo(pir_scene *scene) {
    pir_scene_target *target = &scene->target;
    pir_bodies *bodies = &scene->bodies;
    for (uint32_t i = 0; i < target->away_count; i++)
        if (target->away[i].is_made)
            unmake(scene, target->away[i].number);
    for (uint32_t i = 0; i < target->away_count; i++) {
        const pir_scene_away *away = &target->away[i];
        const pir_box *box = target->box + away->box;
        bodies->body[away->number] = away->body;
        bodies->body_count += away->body.used;
        for (uint32_t p = away->body.used ? away->body.first : PIR_PIECE_NONE; p != PIR_PIECE_NONE;
             p = bodies->piece[p].next)
            bodies->piece[p].node = pir_tree_insert(&scene->tree, box++, p);
        if (away->body.used && bodies->body_end <= away->number)
            bodies->body_end = away->number + 1;
    }
    pir_bodies_trim(bodies);
    for (uint32_t i = 0; i < target->changed_count; i++) {
        const pir_scene_changed *before = &target->changed[i];
        pir_scene_body *body = &bodies->body[before->number];
        body->category = before->category;
        body->mask = before->mask;
        body->sensor = before->sensor;
        body->disabled = before->disabled;
        body->fresh = before->fresh;
    }
    // pairs that were made by other rules; all rules are back by now
    for (uint32_t i = 0; i < target->changed_count; i++)
        pir_scene_end_pairs(scene, target->changed[i].number, false);
}

static void read_users(pir_scene *scene, const pir_snapshot *snapshot) {
    const uint8_t *at = snapshot->user;
    for (uint32_t i = 0; i < snapshot->counts.bodies; i++) {
        const pir_snapshot_body body = pir_snapshot_body_at(snapshot, i);
        pir_scene_body *of = &scene->bodies.body[pir_body_number(body.id)];
        of->user = body.user;
        for (uint32_t p = of->first; p != PIR_PIECE_NONE; p = scene->bodies.piece[p].next)
            scene->bodies.piece[p].user = body.flags & PIR_SNAPSHOT_USERS ? pir_snapshot_take(&at, 8) : 0;
        of->fresh = (body.flags & PIR_SNAPSHOT_FRESH) != 0;
        if (of->fresh)
            scene->fresh[scene->fresh_count++] = pir_body_number(body.id);
    }
}

/* Puts the bodies that go into their places again, and keeps those that came, or the reverse. */
static void exchange_bodies(pir_scene *scene) {
    for (uint32_t i = 0; i < scene->target.away_count; i++) {
        pir_scene_away *away = &scene->target.away[i];
        const pir_scene_body kept = away->body;
        away->body = scene->bodies.body[away->number];
        scene->bodies.body[away->number] = kept;
    }
}

void pir_target_commit(pir_scene *scene, const pir_snapshot *snapshot) {
    pir_scene_target *target = &scene->target;
    pir_bodies *bodies = &scene->bodies;
    // pieces know their bodies by numbers, and a triangle that goes is taken off the list of its body
    exchange_bodies(scene);
    for (uint32_t i = 0; i < target->away_count; i++)
        if (bodies->body[target->away[i].number].used)
            pir_scene_end_pairs(scene, target->away[i].number, true);
    for (uint32_t i = 0; i < target->away_count; i++)
        if (bodies->body[target->away[i].number].used)
            pir_bodies_empty(bodies, target->away[i].number);
    exchange_bodies(scene);
    for (uint32_t i = 0; i < target->changed_count; i++)
        pir_scene_end_pairs(scene, target->changed[i].number, false);
    for (uint32_t n = 0; n < bodies->body_slots; n++)
        if (!bodies->body[n].used)
            bodies->body[n] = (pir_scene_body){
                .used = false, .generation = (uint16_t)(n < snapshot->counts.numbers ? generation_at(snapshot, n) : 0)};
    pir_bodies_trim(bodies);
    scene->fresh_count = 0;
    read_users(scene, snapshot);
}

/* SPDX-License-Identifier: MIT */
/* Bodies that are removed or changed: see changes.h; and what callers read of bodies. */
#include "scene/change/changes.h"

#include "scene/world/grow.h"
#include "scene/world/triangles.h"

pir_status pir_scene_find_body(const pir_scene *scene, const char *call, uint32_t id, uint32_t *ret_body) {
    const uint32_t body = pir_bodies_find(&scene->bodies, id), number = pir_body_number(id);
    *ret_body = body;
    if (body != PIR_SCENE_NONE)
        return PIR_OK;
    if (id != PIR_SCENE_NONE && number < scene->bodies.body_slots &&
        scene->bodies.body[number].generation > id >> PIR_NUMBER_BITS)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "%s: body %u was removed, it was number %u", call,
                        (unsigned)id, (unsigned)number);
    return pir_fail(scene->report, PIR_ERR_ARGUMENT, "%s: there is no body %u", call, (unsigned)id);
}

/* --- pairs that go --- */

pir_scene_key pir_scene_key_of(const pir_scene *scene, uint32_t pair) {
    const uint32_t *of = scene->pairs.at[pair].piece;
    const pir_scene_piece *p = &scene->bodies.piece[of[0]], *q = &scene->bodies.piece[of[1]];
    const uint64_t first = pir_id_order(pir_body_id(&scene->bodies, p->body));
    return (pir_scene_key){first << 32 | pir_id_order(pir_body_id(&scene->bodies, q->body)),
                           (uint64_t)p->number << 32 | q->number};
}

pir_scene_gone pir_scene_name_contact(const pir_scene *scene, uint32_t pair) {
    pir_scene_gone gone = {.key = pir_scene_key_of(scene, pair)};
    for (int side = 0; side < 2; side++) {
        const pir_scene_piece *piece = &scene->bodies.piece[scene->pairs.at[pair].piece[side]];
        const pir_scene_body *body = &scene->bodies.body[piece->body];
        gone.user[side] = body->user;
        gone.piece_user[side] = pir_piece_user(&scene->bodies, piece);
        gone.sensor = gone.sensor || body->sensor;
    }
    return gone;
}

void pir_scene_drop_pair(pir_scene *scene, uint32_t pair) {
    pir_scene_piece *pieces = scene->bodies.piece;
    const uint32_t of[2] = {scene->pairs.at[pair].piece[0], scene->pairs.at[pair].piece[1]};
    pir_scene_pairs_drop(&scene->pairs, pair, &pieces[of[0]].first, &pieces[of[1]].first);
    for (int side = 0; side < 2; side++)
        if (pieces[of[side]].kind == PIR_PIECE_TRIANGLE && pieces[of[side]].first == PIR_END_NONE)
            pir_triangles_remove(&scene->bodies, of[side]);
}

/* Drops a pair, whose contact is gone where it has one: there is room for it. */
static void end_pair(pir_scene *scene, uint32_t pair) {
    if (scene->pairs.at[pair].touching) {
        scene->gone[scene->gone_count++] = pir_scene_name_contact(scene, pair);
        scene->touching--;
    }
    pir_scene_drop_pair(scene, pair);
}

/* Drops the pairs of a piece with bodies that its own does not meet, or all. */
static void end_pairs(pir_scene *scene, uint32_t piece, bool all) {
    for (uint32_t end = scene->bodies.piece[piece].first; end != PIR_END_NONE;) {
        const pir_scene_pair *pair = &scene->pairs.at[end / 2];
        const uint32_t number = end / 2, p = scene->bodies.piece[pair->piece[0]].body,
                       q = scene->bodies.piece[pair->piece[1]].body;
        end = pair->next[end % 2];
        if (all || !pir_bodies_meet(&scene->bodies, p, q))
            end_pair(scene, number);
    }
}

void pir_scene_end_pairs(pir_scene *scene, uint32_t body, bool all) {
    const pir_scene_piece *pieces = scene->bodies.piece;
    for (uint32_t i = pir_body_paired(&scene->bodies.body[body]); i != PIR_PIECE_NONE;) {
        const uint32_t next = pieces[i].next; // a triangle goes with its last pair
        end_pairs(scene, i, all);
        i = next;
    }
}

void pir_scene_take_out(pir_scene *scene, uint32_t body) {
    uint32_t kept = 0;
    pir_scene_end_pairs(scene, body, true);
    for (uint32_t i = scene->bodies.body[body].first; i != PIR_PIECE_NONE; i = scene->bodies.piece[i].next)
        pir_tree_remove(&scene->tree, scene->bodies.piece[i].node);
    for (uint32_t i = 0; scene->bodies.body[body].fresh && i < scene->fresh_count; i++)
        if (scene->fresh[i] != body)
            scene->fresh[kept++] = scene->fresh[i];
    scene->fresh_count = scene->bodies.body[body].fresh ? kept : scene->fresh_count;
    pir_bodies_remove(&scene->bodies, body);
}

void pir_scene_reconsider(pir_scene *scene, uint32_t body) {
    pir_scene_end_pairs(scene, body, false);
    if (!scene->bodies.body[body].fresh)
        scene->fresh[scene->fresh_count++] = body;
    scene->bodies.body[body].fresh = true;
}

/* --- the calls --- */

/* Finds a body that is to be changed, and makes room for one more that is fresh. */
static pir_status begin(pir_scene *scene, const char *call, uint32_t id, uint32_t *ret_body) {
    pir_status status = pir_scene_given(scene, call, NULL);
    if (status == PIR_OK)
        status = pir_scene_find_body(scene, call, id, ret_body);
    if (status != PIR_OK)
        return status;
    if (!PIR_GROW(&scene->allocator, scene->fresh, scene->fresh_capacity, scene->fresh_count + 1))
        return pir_fail(scene->report, PIR_ERR_MEMORY, "%s: %s", call, pir_status_text(PIR_ERR_MEMORY));
    return PIR_OK;
}

pir_status pir_scene_remove(pir_scene *scene, uint32_t body) {
    uint32_t number;
    pir_status status = pir_scene_given(scene, "remove", NULL);
    if (status == PIR_OK)
        status = pir_scene_find_body(scene, "remove", body, &number);
    if (status == PIR_OK)
        pir_scene_take_out(scene, number);
    return status;
}

pir_status pir_scene_set_filter(pir_scene *scene, uint32_t body, uint32_t category, uint32_t mask) {
    uint32_t number;
    const pir_status status = begin(scene, "filter", body, &number);
    if (status != PIR_OK)
        return status;
    scene->bodies.body[number].category = category;
    scene->bodies.body[number].mask = mask;
    pir_scene_reconsider(scene, number);
    return PIR_OK;
}

pir_status pir_scene_set_sensor(pir_scene *scene, uint32_t body, bool sensor) {
    uint32_t number;
    const pir_status status = begin(scene, "sensor", body, &number);
    if (status != PIR_OK)
        return status;
    scene->bodies.body[number].sensor = sensor;
    pir_scene_reconsider(scene, number);
    return PIR_OK;
}

pir_status pir_scene_set_disabled(pir_scene *scene, uint32_t body, bool disabled) {
    uint32_t number;
    const pir_status status = begin(scene, "disable", body, &number);
    if (status != PIR_OK)
        return status;
    scene->bodies.body[number].disabled = disabled;
    pir_scene_reconsider(scene, number);
    return PIR_OK;
}

pir_status pir_scene_set_user(pir_scene *scene, uint32_t body, uint64_t user) {
    uint32_t number;
    pir_status status = pir_scene_given(scene, "user", NULL);
    if (status == PIR_OK)
        status = pir_scene_find_body(scene, "user", body, &number);
    if (status == PIR_OK)
        scene->bodies.body[number].user = user;
    return status;
}

/* The convex piece of a body, which is told of in the name of a call. */
static pir_status find_piece(const pir_scene *scene, uint32_t body, uint32_t piece, uint32_t *ret_piece) {
    uint32_t number;
    pir_status status = pir_scene_given(scene, "piece", NULL);
    if (status == PIR_OK)
        status = pir_scene_find_body(scene, "piece", body, &number);
    if (status != PIR_OK)
        return status;
    if (pir_body_has_surface(&scene->bodies.body[number]))
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "piece: body %u has a surface", (unsigned)body);
    *ret_piece = pir_bodies_piece(&scene->bodies, number, piece);
    if (*ret_piece == PIR_PIECE_NONE)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "piece: body %u has %u pieces, and no number %u",
                        (unsigned)body, (unsigned)scene->bodies.body[number].pieces, (unsigned)piece);
    return PIR_OK;
}

pir_status pir_scene_set_piece_user(pir_scene *scene, uint32_t body, uint32_t piece, uint64_t user) {
    uint32_t found = PIR_PIECE_NONE;
    const pir_status status = find_piece(scene, body, piece, &found);
    if (status == PIR_OK)
        scene->bodies.piece[found].user = user;
    return status;
}

/* --- reading --- */

pir_status pir_scene_pose(const pir_scene *scene, uint32_t body, pir_pose *ret_pose) {
    uint32_t number;
    pir_status status = pir_scene_given(scene, "pose", ret_pose ? NULL : "ret_pose");
    if (status == PIR_OK)
        status = pir_scene_find_body(scene, "pose", body, &number);
    if (status == PIR_OK)
        *ret_pose = scene->bodies.body[number].pose;
    return status;
}

bool pir_scene_has(const pir_scene *scene, uint32_t body) {
    return scene && pir_bodies_find(&scene->bodies, body) != PIR_SCENE_NONE;
}

uint32_t pir_scene_next(const pir_scene *scene, uint32_t body) {
    uint32_t next = body == PIR_SCENE_NONE ? 0 : pir_body_number(body) + 1;
    while (scene && next < scene->bodies.body_end && !scene->bodies.body[next].used)
        next++;
    return scene && next < scene->bodies.body_end ? pir_body_id(&scene->bodies, next) : PIR_SCENE_NONE;
}

pir_status pir_scene_get_body(const pir_scene *scene, uint32_t body, pir_body_state *ret_state) {
    uint32_t number;
    pir_status status = pir_scene_given(scene, "body", ret_state ? NULL : "ret_state");
    if (status == PIR_OK)
        status = pir_scene_find_body(scene, "body", body, &number);
    if (status != PIR_OK)
        return status;
    const pir_scene_body *of = &scene->bodies.body[number];
    *ret_state = (pir_body_state){.kind = (pir_body_kind)of->kind,
                                  .pose = of->pose,
                                  .radius = of->radius,
                                  .piece_count = pir_body_has_surface(of) ? 0 : of->pieces,
                                  .mesh = of->surface.mesh,
                                  .field = of->surface.field,
                                  .category = of->category,
                                  .mask = of->mask,
                                  .sensor = of->sensor,
                                  .disabled = of->disabled,
                                  .user = of->user};
    return PIR_OK;
}

pir_status pir_scene_get_piece(const pir_scene *scene, uint32_t body, uint32_t piece, pir_polytope **ret_polytope,
                               uint64_t *ret_user) {
    uint32_t found = PIR_PIECE_NONE;
    const pir_status status = find_piece(scene, body, piece, &found);
    if (status == PIR_OK && ret_polytope)
        *ret_polytope = scene->bodies.piece[found].extent.polytope;
    if (status == PIR_OK && ret_user)
        *ret_user = scene->bodies.piece[found].user;
    return status;
}

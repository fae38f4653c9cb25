/* SPDX-License-Identifier: MIT */
/*
 * An update, in steps of which all that can fail come before the last:
 *
 *   1. places are checked, and boxes made for them;
 *   2. bodies go to their places, and pieces whose boxes leave those of the tree are put in anew;
 *   3. pairs that these lack are made;
 *   4. pairs of moved bodies are looked at, and asked where neither boxes nor distances tell;
 *   5. events are made, pairs without a meeting of boxes dropped.
 *
 * A failure from step 3 on takes bodies and boxes back to where they were. Pairs that were made stay: they are not in
 * contact, and more pairs than needed break no invariant.
 */
#include "scene/answer/ask.h"
#include "scene/answer/candidates.h"
#include "scene/answer/events.h"
#include "scene/world/grow.h"

/* --- 1. what is asked for --- */

/* A moved body, once; `moved` of a body is set to this update so that the second time is seen. */
static pir_status take_move(pir_scene *scene, const pir_scene_move *move) {
    if (!pir_bodies_has(&scene->bodies, move->body))
        return PIR_ERR_ARGUMENT;
    pir_scene_body *body = &scene->bodies.body[move->body];
    if (body->kind == PIR_BODY_STATIC || body->moved == scene->update)
        return PIR_ERR_ARGUMENT;
    pir_scene_moved *moved = &scene->lists.moved[scene->lists.moved_count];
    pir_status status = pir_place_make(move->pose, &moved->place);
    if (status != PIR_OK)
        return status;
    moved->body = move->body;
    body->moved = scene->update;
    scene->lists.moved_count++;
    return PIR_OK;
}

/* Fresh bodies that no move was given for stay where they are. */
static pir_status take_fresh(pir_scene *scene) {
    for (uint32_t i = 0; i < scene->fresh_count; i++) {
        pir_scene_body *body = &scene->bodies.body[scene->fresh[i]];
        pir_scene_moved *moved = &scene->lists.moved[scene->lists.moved_count];
        if (body->moved == scene->update)
            continue;
        pir_status status = pir_place_make(body->pose, &moved->place);
        if (status != PIR_OK)
            return status;
        moved->body = scene->fresh[i];
        body->moved = scene->update;
        scene->lists.moved_count++;
    }
    return PIR_OK;
}

static double around(const pir_scene *scene, const pir_scene_body *body) {
    return body->radius + 0.5 * scene->margin;
}

/* The boxes of all pieces at their new places, in the order of `moved` and of each body's list. */
static pir_status make_boxes(pir_scene *scene) {
    pir_scene_lists *lists = &scene->lists;
    uint32_t pieces = 0;
    for (uint32_t i = 0; i < lists->moved_count; i++)
        pieces += scene->bodies.body[lists->moved[i].body].pieces;
    if (!PIR_GROW(&scene->allocator, lists->box, lists->box_capacity, pieces) ||
        !PIR_GROW(&scene->allocator, lists->replaced, lists->replaced_capacity, pieces))
        return PIR_ERR_MEMORY;
    pir_box *box = lists->box;
    for (uint32_t i = 0; i < lists->moved_count; i++) {
        const pir_scene_body *body = &scene->bodies.body[lists->moved[i].body];
        for (uint32_t p = body->first; p != PIR_PIECE_NONE; p = scene->bodies.piece[p].next)
            if (!pir_place_box(&lists->moved[i].place, &scene->bodies.piece[p].extent, around(scene, body), box++))
                return PIR_ERR_LIMIT;
    }
    return PIR_OK;
}

static pir_status take_moves(pir_scene *scene, const pir_scene_move *moves, size_t count) {
    pir_scene_lists *lists = &scene->lists;
    if (count > scene->bodies.body_count)
        return PIR_ERR_ARGUMENT;
    uint32_t most = (uint32_t)count + scene->fresh_count;
    if (!PIR_GROW(&scene->allocator, lists->moved, lists->moved_capacity, most))
        return PIR_ERR_MEMORY;
    pir_status status = PIR_OK;
    for (size_t i = 0; i < count && status == PIR_OK; i++)
        status = take_move(scene, &moves[i]);
    if (status == PIR_OK)
        status = take_fresh(scene);
    return status == PIR_OK ? make_boxes(scene) : status;
}

/* --- 2. to the new places, and back --- */

static void put_in(pir_scene *scene, uint32_t piece, const pir_box *fat) {
    pir_tree_remove(&scene->tree, scene->bodies.piece[piece].node);
    scene->bodies.piece[piece].node = pir_tree_insert(&scene->tree, fat, piece);
}

/* Gives a piece its new box, and the tree one that holds it. */
static void place_piece(pir_scene *scene, uint32_t p, const pir_box *tight, pir_vec3 way) {
    pir_scene_piece *piece = &scene->bodies.piece[p];
    bool fresh = scene->bodies.body[piece->body].fresh;
    pir_box before = scene->tree.node[piece->node].box;
    piece->tight = *tight;
    bool held = pir_box_holds(&before, tight);
    if (!held) {
        pir_box fat = pir_scene_fat_box(tight, way);
        put_in(scene, p, &fat);
    }
    if (!held || fresh)
        scene->lists.replaced[scene->lists.replaced_count++] = (pir_scene_replaced){p, !held, before};
}

static void move_bodies(pir_scene *scene) {
    const pir_box *box = scene->lists.box;
    for (uint32_t i = 0; i < scene->lists.moved_count; i++) {
        const pir_scene_moved *moved = &scene->lists.moved[i];
        pir_scene_body *body = &scene->bodies.body[moved->body];
        pir_vec3 way = pir_vec_sub(moved->place.pose.translation, body->pose.translation);
        pir_bodies_travel(body, &moved->place);
        body->previous = body->pose;
        body->pose = moved->place.pose;
        body->unit = moved->place.unit;
        for (uint32_t p = body->first; p != PIR_PIECE_NONE; p = scene->bodies.piece[p].next)
            place_piece(scene, p, box++, pir_vec_scale(way, 2));
    }
}

/* Back to the poses and boxes from before move_bodies. */
static void move_back(pir_scene *scene) {
    for (uint32_t i = 0; i < scene->lists.replaced_count; i++)
        if (scene->lists.replaced[i].moved)
            put_in(scene, scene->lists.replaced[i].piece, &scene->lists.replaced[i].before);
    for (uint32_t i = 0; i < scene->lists.moved_count; i++) {
        pir_scene_body *body = &scene->bodies.body[scene->lists.moved[i].body];
        pir_place place;
        // this pose and these boxes have been made before
        pir_place_make(body->previous, &place);
        pir_bodies_travel(body, &place);
        body->pose = place.pose;
        body->unit = place.unit;
        for (uint32_t p = body->first; p != PIR_PIECE_NONE; p = scene->bodies.piece[p].next)
            pir_place_box(&place, &scene->bodies.piece[p].extent, around(scene, body), &scene->bodies.piece[p].tight);
    }
}

/* --- the call --- */

static pir_status answer(pir_scene *scene) {
    pir_status status = pir_scene_find_pairs(scene);
    if (status == PIR_OK)
        status = pir_scene_list_questions(scene);
    if (status == PIR_OK)
        status = pir_scene_ask(scene);
    return status == PIR_OK ? pir_scene_make_events(scene) : status;
}

pir_status pir_scene_update(pir_scene *scene, const pir_scene_move *moves, size_t count) {
    if (!scene || (!moves && count > 0))
        return PIR_ERR_ARGUMENT;
    pir_scene_lists *lists = &scene->lists;
    scene->update++;
    scene->event_count = scene->looked = 0;
    lists->moved_count = lists->replaced_count = lists->asked_count = lists->ended_count = 0;
    pir_status status = take_moves(scene, moves, count);
    if (status != PIR_OK)
        return status;
    move_bodies(scene);
    status = answer(scene);
    if (status != PIR_OK) {
        move_back(scene);
        return status;
    }
    pir_scene_drop_pairs(scene);
    for (uint32_t i = 0; i < scene->fresh_count; i++)
        scene->bodies.body[scene->fresh[i]].fresh = false;
    scene->fresh_count = 0;
    return PIR_OK;
}

/* SPDX-License-Identifier: MIT */
/* Bodies to new places, and back: see motion.h. */
#include "scene/answer/motion.h"

#include <stdio.h>

#include "scene/answer/share.h"
#include "scene/world/grow.h"

/* How many bodies are worth another thread: to make their boxes, and to bring them to places that are made. */
#define WORTH_MORE  64
#define WORTH_MOVES 256

/* The place of a moved body, and the boxes of its pieces there. */
static pir_status make_place(pir_scene *scene, pir_scene_moved *moved) {
    const pir_scene_body *body = &scene->bodies.body[moved->body];
    pir_box *box = scene->lists.box + moved->first;
    pir_status status = pir_place_make(moved->pose, &moved->place);
    for (uint32_t p = body->first; p != PIR_PIECE_NONE && status == PIR_OK; p = scene->bodies.piece[p].next)
        if (!pir_piece_box(body, &scene->bodies.piece[p], &moved->place, pir_scene_around(scene, body), box++))
            status = PIR_ERR_LIMIT;
    return status;
}

static void make_items(pir_scene *scene, uint32_t task, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; i++)
        pir_scene_worker_note(&scene->worker[task], make_place(scene, &scene->lists.moved[i]), i);
}

pir_status pir_scene_make_boxes(pir_scene *scene, const char *call, pir_report *report) {
    pir_scene_lists *lists = &scene->lists;
    uint32_t pieces = 0;
    for (uint32_t i = 0; i < lists->moved_count; i++) {
        lists->moved[i].first = pieces;
        pieces += scene->bodies.body[lists->moved[i].body].pieces;
    }
    if (!PIR_GROW(&scene->allocator, lists->box, lists->box_capacity, pieces) ||
        !PIR_GROW(&scene->allocator, lists->replaced, lists->replaced_capacity, pieces))
        return pir_fail(report, PIR_ERR_MEMORY, "%s: %s", call, pir_status_text(PIR_ERR_MEMORY));
    pir_scene_workers_begin(scene);
    pir_scene_share(scene, lists->moved_count, WORTH_MORE, make_items);
    pir_status status = pir_scene_workers_status(scene);
    if (status == PIR_OK)
        return PIR_OK;
    const pir_scene_moved *first = &lists->moved[pir_scene_workers_failed(scene)];
    char of[32];
    snprintf(of, sizeof of, "%s: body %u", call, (unsigned)pir_body_id(&scene->bodies, first->body));
    return pir_place_fail(first->pose, status, of, report);
}

static void put_in(pir_scene *scene, uint32_t piece, const pir_box *fat) {
    pir_tree_remove(&scene->tree, scene->bodies.piece[piece].node);
    scene->bodies.piece[piece].node = pir_tree_insert(&scene->tree, fat, piece);
}

/* Gives a piece its new box. Whether the tree has to get one that holds it, or pairs are to be found; else no piece. */
static pir_scene_replaced place_piece(pir_scene *scene, uint32_t p, const pir_box *tight) {
    pir_scene_piece *piece = &scene->bodies.piece[p];
    const pir_scene_body *body = &scene->bodies.body[piece->body];
    const pir_box before = scene->tree.node[piece->node].box;
    piece->tight = *tight;
    piece->moved = scene->update;
    const bool held = pir_box_holds(&before, tight);
    if (held && !body->fresh && !(piece->kind == PIR_PIECE_SURFACE && body->surface.drift > body->surface.skin))
        return (pir_scene_replaced){.piece = PIR_PIECE_NONE};
    return (pir_scene_replaced){p, !held, before};
}

/* Brings the boxes of a body's triangles to a place. That of the whole has been made there, so none is too far. */
static void place_triangles(pir_scene *scene, const pir_scene_body *body, const pir_place *place) {
    pir_scene_piece *pieces = scene->bodies.piece;
    for (uint32_t p = body->surface.triangles; p != PIR_PIECE_NONE; p = pieces[p].next) {
        pir_piece_box(body, &pieces[p], place, pir_scene_around(scene, body), &pieces[p].tight);
        pieces[p].moved = scene->update;
    }
}

/* Brings bodies to their places, and pieces to their boxes. Changes of the tree wait: `replaced` has a place for each
 * piece that has moved. */
static void move_items(pir_scene *scene, uint32_t task, uint32_t begin, uint32_t end) {
    (void)task;
    for (uint32_t i = begin; i < end; i++) {
        const pir_scene_moved *moved = &scene->lists.moved[i];
        pir_scene_body *body = &scene->bodies.body[moved->body];
        uint32_t at = moved->first;
        body->surface.previous_drift = body->surface.drift;
        pir_bodies_travel(body, &moved->place);
        body->previous = body->pose;
        body->pose = moved->place.pose;
        body->unit = moved->place.unit;
        for (uint32_t p = body->first; p != PIR_PIECE_NONE; p = scene->bodies.piece[p].next, at++)
            scene->lists.replaced[at] = place_piece(scene, p, &scene->lists.box[at]);
        if (pir_body_has_surface(body))
            place_triangles(scene, body, &moved->place);
    }
}

void pir_scene_move_bodies(pir_scene *scene) {
    pir_scene_lists *lists = &scene->lists;
    if (lists->moved_count == 0)
        return;
    pir_scene_share(scene, lists->moved_count, WORTH_MOVES, move_items);
    const pir_scene_moved *last = &lists->moved[lists->moved_count - 1];
    const uint32_t pieces = last->first + scene->bodies.body[last->body].pieces;
    for (uint32_t i = 0; i < pieces; i++) {
        const pir_scene_replaced replaced = lists->replaced[i];
        if (replaced.piece == PIR_PIECE_NONE)
            continue;
        if (replaced.moved) {
            const pir_scene_piece *piece = &scene->bodies.piece[replaced.piece];
            const pir_scene_body *body = &scene->bodies.body[piece->body];
            const pir_vec3 way = pir_vec_sub(body->pose.translation, body->previous.translation);
            const pir_box fat = pir_scene_fat_box(&piece->tight, pir_vec_scale(way, 2));
            put_in(scene, replaced.piece, &fat);
        }
        lists->replaced[lists->replaced_count++] = replaced;
    }
}

void pir_scene_move_back(pir_scene *scene) {
    for (uint32_t i = 0; i < scene->lists.replaced_count; i++)
        if (scene->lists.replaced[i].moved)
            put_in(scene, scene->lists.replaced[i].piece, &scene->lists.replaced[i].before);
    for (uint32_t i = 0; i < scene->lists.moved_count; i++) {
        pir_scene_body *body = &scene->bodies.body[scene->lists.moved[i].body];
        pir_place place;
        // this pose and these boxes have been made before
        pir_place_make(body->previous, &place);
        pir_bodies_travel(body, &place);
        body->surface.drift = body->surface.previous_drift;
        body->pose = place.pose;
        body->unit = place.unit;
        for (uint32_t p = body->first; p != PIR_PIECE_NONE; p = scene->bodies.piece[p].next)
            pir_piece_box(body, &scene->bodies.piece[p], &place, pir_scene_around(scene, body),
                          &scene->bodies.piece[p].tight);
        if (pir_body_has_surface(body))
            place_triangles(scene, body, &place);
    }
}

/* SPDX-License-Identifier: MIT */
/* The pairs that an update has to look at: see candidates.h. */
#include "scene/answer/candidates.h"

#include "scene/world/grow.h"

static const pir_box *fat_box(const pir_scene *scene, uint32_t piece) {
    return &scene->tree.node[scene->bodies.piece[piece].node].box;
}

/* Marks a piece's partners with this visit. */
static void mark_partners(pir_scene *scene, uint32_t piece) {
    pir_scene_piece *pieces = scene->bodies.piece;
    for (uint32_t end = pieces[piece].first; end != PIR_END_NONE; end = scene->pairs.at[end / 2].next[end % 2])
        pieces[scene->pairs.at[end / 2].piece[1 - end % 2]].mark = scene->visit;
}

/* A pair of two pieces, P being of the body with the lower number. */
static bool add_pair(pir_scene *scene, uint32_t a, uint32_t b) {
    pir_scene_piece *pieces = scene->bodies.piece;
    bool in_order = pieces[a].body < pieces[b].body;
    const uint32_t of[2] = {in_order ? a : b, in_order ? b : a};
    return pir_scene_pairs_add(&scene->pairs, &scene->allocator, of, &pieces[of[0]].first, &pieces[of[1]].first) !=
           PIR_END_NONE;
}

pir_status pir_scene_find_pairs(pir_scene *scene) {
    for (uint32_t i = 0; i < scene->lists.replaced_count; i++) {
        uint32_t piece = scene->lists.replaced[i].piece;
        const pir_box box = *fat_box(scene, piece);
        scene->visit++;
        mark_partners(scene, piece);
        for (uint32_t leaf = pir_tree_first(&scene->tree, &box); leaf != PIR_TREE_NONE;
             leaf = pir_tree_next(&scene->tree, &box, leaf)) {
            uint32_t other = pir_tree_item(&scene->tree, leaf);
            const pir_scene_piece *pieces = scene->bodies.piece;
            if (pieces[other].mark != scene->visit &&
                pir_bodies_meet(&scene->bodies, pieces[piece].body, pieces[other].body) &&
                !add_pair(scene, piece, other))
                return PIR_ERR_MEMORY;
        }
    }
    return PIR_OK;
}

/* Whether the distance of an earlier answer, less what the bodies have travelled since, rules a contact out. */
static bool stays_apart(const pir_scene *scene, const pir_scene_pair *pair, const pir_scene_body *p,
                        const pir_scene_body *q) {
    double travelled = (p->travel + q->travel) * (1 + 0x1p-50) - pair->travelled;
    return pair->apart > 0 && pair->apart - travelled > scene->margin;
}

static pir_status look(pir_scene *scene, uint32_t number) {
    pir_scene_lists *lists = &scene->lists;
    pir_scene_pair *pair = &scene->pairs.at[number];
    const pir_scene_piece *p = &scene->bodies.piece[pair->piece[0]], *q = &scene->bodies.piece[pair->piece[1]];
    const pir_scene_body *bodies = scene->bodies.body;
    scene->looked++;
    if (!pir_box_meets(&p->tight, &q->tight) || stays_apart(scene, pair, &bodies[p->body], &bodies[q->body])) {
        if (pair->touching && !PIR_GROW(&scene->allocator, lists->ended, lists->ended_capacity, lists->ended_count + 1))
            return PIR_ERR_MEMORY;
        if (pair->touching)
            lists->ended[lists->ended_count++] = number;
        return PIR_OK;
    }
    if (!PIR_GROW(&scene->allocator, lists->asked, lists->asked_capacity, lists->asked_count + 1))
        return PIR_ERR_MEMORY;
    lists->asked[lists->asked_count++] = number;
    return pir_scene_pairs_ready(&scene->pairs, &scene->allocator, number, p->extent.polytope, q->extent.polytope);
}

pir_status pir_scene_list_questions(pir_scene *scene) {
    const pir_scene_piece *pieces = scene->bodies.piece;
    for (uint32_t i = 0; i < scene->lists.moved_count; i++) {
        const pir_scene_body *body = &scene->bodies.body[scene->lists.moved[i].body];
        for (uint32_t piece = body->first; piece != PIR_PIECE_NONE; piece = pieces[piece].next)
            for (uint32_t end = pieces[piece].first; end != PIR_END_NONE;) {
                pir_scene_pair *pair = &scene->pairs.at[end / 2];
                bool is_new = pair->seen != scene->update;
                pir_status status = is_new ? look(scene, end / 2) : PIR_OK;
                if (status != PIR_OK)
                    return status;
                pair->seen = scene->update;
                end = pair->next[end % 2];
            }
    }
    return PIR_OK;
}

void pir_scene_drop_pairs(pir_scene *scene) {
    pir_scene_piece *pieces = scene->bodies.piece;
    for (uint32_t i = 0; i < scene->lists.replaced_count; i++)
        for (uint32_t end = pieces[scene->lists.replaced[i].piece].first; end != PIR_END_NONE;) {
            const pir_scene_pair *pair = &scene->pairs.at[end / 2];
            uint32_t number = end / 2, p = pair->piece[0], q = pair->piece[1];
            end = pair->next[end % 2];
            if (!pir_box_meets(fat_box(scene, p), fat_box(scene, q)))
                pir_scene_pairs_drop(&scene->pairs, number, &pieces[p].first, &pieces[q].first);
        }
}

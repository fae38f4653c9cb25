/* SPDX-License-Identifier: MIT */
/* Whether the invariants of a scene hold: for tests. */
#include "scene/world/scene.h"

/* The piece's leaf is its own, and holds its box. */
static bool leaf_is_valid(const pir_scene *scene, uint32_t piece) {
    const pir_scene_piece *p = &scene->bodies.piece[piece];
    const pir_box *box = &scene->tree.node[p->node].box;
    return pir_tree_item(&scene->tree, p->node) == piece && pir_box_holds(box, &p->tight);
}

/* The ends in a piece's list are of the piece, and link back; *ret_ends is increased by their number. */
static bool list_is_valid(const pir_scene *scene, uint32_t piece, uint32_t *ret_ends) {
    uint32_t before = PIR_END_NONE;
    for (uint32_t end = scene->bodies.piece[piece].first; end != PIR_END_NONE;) {
        const pir_scene_pair *pair = &scene->pairs.at[end / 2];
        if (pair->piece[end % 2] != piece || pair->previous[end % 2] != before || ++*ret_ends > 2 * scene->pairs.count)
            return false;
        if (scene->bodies.piece[pair->piece[0]].body >= scene->bodies.piece[pair->piece[1]].body)
            return false;
        before = end;
        end = pair->next[end % 2];
    }
    return true;
}

static bool has_pair(const pir_scene *scene, uint32_t piece, uint32_t other) {
    for (uint32_t end = scene->bodies.piece[piece].first; end != PIR_END_NONE;) {
        const pir_scene_pair *pair = &scene->pairs.at[end / 2];
        if (pair->piece[1 - end % 2] == other)
            return true;
        end = pair->next[end % 2];
    }
    return false;
}

/* The piece has a pair with each that it may meet and whose box meets its own, unless one of them is fresh. */
static bool has_all_pairs(const pir_scene *scene, uint32_t piece) {
    const pir_scene_piece *pieces = scene->bodies.piece;
    const pir_scene_body *bodies = scene->bodies.body;
    const pir_box *box = &scene->tree.node[pieces[piece].node].box;
    for (uint32_t leaf = pir_tree_first(&scene->tree, box); leaf != PIR_TREE_NONE;
         leaf = pir_tree_next(&scene->tree, box, leaf)) {
        uint32_t other = pir_tree_item(&scene->tree, leaf), a = pieces[piece].body, b = pieces[other].body;
        if (pir_bodies_meet(&scene->bodies, a, b) && !bodies[a].fresh && !bodies[b].fresh &&
            !has_pair(scene, piece, other))
            return false;
    }
    return true;
}

bool pir_scene_is_valid(const pir_scene *scene) {
    uint32_t pieces = 0, bodies = 0, ends = 0;
    if (!pir_tree_is_valid(&scene->tree) || scene->tree.leaves != scene->bodies.piece_count)
        return false;
    for (uint32_t b = 0; b < scene->bodies.body_end; b++) {
        uint32_t of_body = 0;
        bodies += scene->bodies.body[b].used;
        for (uint32_t p = scene->bodies.body[b].used ? scene->bodies.body[b].first : PIR_PIECE_NONE;
             p != PIR_PIECE_NONE; p = scene->bodies.piece[p].next) {
            const pir_scene_piece *piece = &scene->bodies.piece[p];
            if (piece->body != b || piece->number != of_body++ || !leaf_is_valid(scene, p) ||
                !list_is_valid(scene, p, &ends) || !has_all_pairs(scene, p))
                return false;
            pieces++;
        }
        if (scene->bodies.body[b].used && of_body != scene->bodies.body[b].pieces)
            return false;
    }
    return bodies == scene->bodies.body_count && pieces == scene->bodies.piece_count && ends == 2 * scene->pairs.count;
}

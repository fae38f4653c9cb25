/* SPDX-License-Identifier: MIT */
/* Whether the invariants of a scene hold: for tests. */
#include "scene/world/near_triangles.h"
#include "scene/world/triangles.h"

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

struct missing_pairs {
    const pir_scene *scene;
    const pir_scene_body *body;
    pir_place place;
    pir_walk_box box;       /* the piece's in the tree */
    uint32_t piece, number; /* of the body with the surface */
    bool misses;
};

static bool look_for_pair(void *context, const pir_met_triangle *met) {
    struct missing_pairs *missing = context;
    const pir_scene *scene = missing->scene;
    const uint32_t known = pir_triangles_find(&scene->bodies, missing->number, met->number);
    pir_scene_piece triangle = pir_triangle_piece(&scene->bodies, missing->number, met->number);
    pir_piece_box(missing->body, &triangle, &missing->place, pir_scene_around(scene, missing->body), &triangle.tight);
    missing->misses = pir_walk_box_meets(&missing->box, &met->tri) &&
                      pir_box_meets(&triangle.tight, &scene->tree.node[scene->bodies.piece[missing->piece].node].box) &&
                      (known == PIR_PIECE_NONE || !has_pair(scene, missing->piece, known));
    return !missing->misses;
}

static void measure(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    pir_walk_box_measure(&((const struct missing_pairs *)context)->box, boxes, ret_near);
}

/* The piece has a pair with each triangle of a surface whose tight box meets its box in the tree. */
static bool has_pairs_with_triangles(const pir_scene *scene, uint32_t piece, const pir_scene_body *body) {
    const double most = 0;
    struct missing_pairs missing = {
        .scene = scene, .body = body, .piece = piece, .number = (uint32_t)(body - scene->bodies.body)};
    if (pir_place_make(body->pose, &missing.place) != PIR_OK)
        return false;
    missing.box = pir_place_sees(&missing.place, &scene->tree.node[scene->bodies.piece[piece].node].box);
    pir_surface_walk(pir_body_surface_of(body), &(pir_walk){measure, look_for_pair, &missing, &most, NULL});
    return !missing.misses;
}

/* The piece has a pair with each that it may meet and whose box meets its own, unless one of them is fresh. */
static bool has_all_pairs(const pir_scene *scene, uint32_t piece) {
    const pir_scene_piece *pieces = scene->bodies.piece;
    const pir_scene_body *bodies = scene->bodies.body;
    const pir_box *box = &scene->tree.node[pieces[piece].node].box;
    for (uint32_t leaf = pir_tree_first(&scene->tree, box); leaf != PIR_TREE_NONE;
         leaf = pir_tree_next(&scene->tree, box, leaf)) {
        uint32_t other = pir_tree_item(&scene->tree, leaf), a = pieces[piece].body, b = pieces[other].body;
        if (!pir_bodies_meet(&scene->bodies, a, b) || bodies[a].fresh || bodies[b].fresh)
            continue;
        const bool of_surface = pieces[other].kind == PIR_PIECE_SURFACE;
        if (pieces[piece].kind == PIR_PIECE_CONVEX &&
            !(of_surface ? has_pairs_with_triangles(scene, piece, &bodies[b]) : has_pair(scene, piece, other)))
            return false;
    }
    return true;
}

/* All triangles that are pieces are of the body and in pairs, and the table finds them; their number is added. */
static bool triangles_are_valid(const pir_scene *scene, uint32_t body, uint32_t *ret_count, uint32_t *ret_ends) {
    uint32_t before = PIR_PIECE_NONE;
    for (uint32_t t = scene->bodies.body[body].surface.triangles; t != PIR_PIECE_NONE;) {
        const pir_scene_piece *piece = &scene->bodies.piece[t];
        if (piece->kind != PIR_PIECE_TRIANGLE || piece->body != body || piece->node != before ||
            piece->first == PIR_END_NONE || ++*ret_count > scene->bodies.triangle_count ||
            pir_triangles_find(&scene->bodies, body, piece->number) != t || !list_is_valid(scene, t, ret_ends))
            return false;
        before = t;
        t = piece->next;
    }
    return true;
}

/* Only contacts are kept. */
static bool records_are_valid(const pir_scene *scene) {
    bool valid = true;
    for (uint32_t i = 0; i < scene->pairs.capacity && valid; i++) {
        const pir_scene_pair *pair = &scene->pairs.at[i];
        valid = pair->touching ? scene->reuse > 0 || !(pair->kept || pair->united) : !pair->kept && !pair->united;
    }
    return valid;
}

bool pir_scene_is_valid(const pir_scene *scene) {
    uint32_t pieces = 0, bodies = 0, triangles = 0, ends = 0;
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
        if (pir_body_has_surface(&scene->bodies.body[b]) && !triangles_are_valid(scene, b, &triangles, &ends))
            return false;
    }
    return records_are_valid(scene) && bodies == scene->bodies.body_count && pieces == scene->bodies.piece_count &&
           triangles == scene->bodies.triangle_count && ends == 2 * scene->pairs.count;
}

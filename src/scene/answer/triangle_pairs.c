/* SPDX-License-Identifier: MIT */
/*
 * Pairs of pieces with triangles: see triangle_pairs.h. The surface's own tree is asked with the piece's box in the
 * tree of the scene, seen from the surface. A surface that moves drifts within its skin before it is asked again, so
 * triangles as near as that have pairs too.
 */
#include "scene/answer/triangle_pairs.h"

#include "scene/world/grow.h"
#include "scene/world/near_triangles.h"
#include "scene/world/triangles.h"

void pir_scene_mark_partners(pir_scene *scene, uint32_t piece) {
    pir_scene_piece *pieces = scene->bodies.piece;
    scene->visit++;
    for (uint32_t end = pieces[piece].first; end != PIR_END_NONE; end = scene->pairs.at[end / 2].next[end % 2])
        pieces[scene->pairs.at[end / 2].piece[1 - end % 2]].mark = scene->visit;
}

bool pir_scene_add_pair(pir_scene *scene, uint32_t a, uint32_t b) {
    pir_scene_piece *pieces = scene->bodies.piece;
    bool in_order = pieces[a].body < pieces[b].body;
    const uint32_t of[2] = {in_order ? a : b, in_order ? b : a};
    return pir_scene_pairs_add(&scene->pairs, &scene->allocator, of, &pieces[of[0]].first, &pieces[of[1]].first) !=
           PIR_END_NONE;
}

pir_box pir_scene_wide_triangle(const pir_scene *scene, const pir_scene_piece *triangle) {
    return pir_box_wider(&triangle->tight, scene->bodies.body[triangle->body].surface.skin);
}

/* Makes the pair of a piece and a triangle, where it lacks it and their boxes meet. */
static pir_status find_triangle(pir_scene *scene, uint32_t piece, const pir_place *place, uint32_t body,
                                uint32_t number) {
    uint32_t triangle = pir_triangles_find(&scene->bodies, body, number);
    pir_scene_piece *known = triangle == PIR_PIECE_NONE ? NULL : &scene->bodies.piece[triangle];
    if (known && known->mark == scene->visit)
        return PIR_OK;
    pir_scene_piece made = known ? *known : pir_triangle_piece(&scene->bodies, body, number);
    const pir_scene_body *of = &scene->bodies.body[body];
    if (!known)
        pir_piece_box(of, &made, place, pir_scene_around(scene, of), &made.tight);
    const pir_box wide = pir_scene_wide_triangle(scene, &made);
    if (!pir_box_meets(&wide, &scene->tree.node[scene->bodies.piece[piece].node].box))
        return PIR_OK;
    pir_status status = known ? PIR_OK : pir_triangles_add(&scene->bodies, &scene->allocator, &made, &triangle);
    if (status != PIR_OK)
        return status;
    if (!pir_scene_add_pair(scene, piece, triangle)) {
        if (!known)
            pir_triangles_remove(&scene->bodies, triangle);
        return PIR_ERR_MEMORY;
    }
    scene->bodies.piece[triangle].mark = scene->visit;
    return PIR_OK;
}

pir_status pir_scene_find_triangles(pir_scene *scene, uint32_t piece, uint32_t surface) {
    const uint32_t number = scene->bodies.piece[surface].body;
    const pir_scene_body *body = &scene->bodies.body[number];
    const pir_box *fat = &scene->tree.node[scene->bodies.piece[piece].node].box,
                  box = pir_box_wider(fat, body->surface.skin + pir_scene_around(scene, body));
    pir_place place;
    uint32_t count = 0;
    pir_status status = pir_place_make(body->pose, &place);
    if (status == PIR_OK)
        status = pir_scene_list_triangles(scene, body, &place, &box, &count);
    for (uint32_t i = 0; i < count && status == PIR_OK; i++)
        status = find_triangle(scene, piece, &place, number, scene->lists.triangle[i]);
    return status;
}

/* SPDX-License-Identifier: MIT */
/* Unions: see unions.h. */
#include "scene/answer/unions.h"

#include "scene/answer/events.h"

static bool is_solid(const pir_scene_piece *piece) {
    return piece->kind == PIR_PIECE_CONVEX && pir_polytope_dimension(piece->extent.polytope) == 3;
}

/*
 * Which side of a pair is part of a union, the other asks: a triangle, or else a piece of a body that does not move, or
 * of the one that has more pieces. −1 for none: two bodies of one piece, a question without contacts, a scene without
 * unions.
 */
static int union_side(const pir_scene *scene, uint32_t pair) {
    const uint32_t *of = scene->pairs.at[pair].piece;
    const pir_scene_piece *p = &scene->bodies.piece[of[0]], *q = &scene->bodies.piece[of[1]];
    const pir_scene_body *a = &scene->bodies.body[p->body], *b = &scene->bodies.body[q->body];
    if (scene->detail != PIR_SCENE_MANIFOLDS || a->sensor || b->sensor)
        return -1;
    if (p->kind == PIR_PIECE_TRIANGLE || q->kind == PIR_PIECE_TRIANGLE)
        return p->kind == PIR_PIECE_TRIANGLE ? 0 : 1;
    if (!scene->unions)
        return -1;
    int side = a->pieces > b->pieces ? 0 : 1;
    if (a->kind != PIR_BODY_MOVING || b->kind != PIR_BODY_MOVING)
        side = a->kind != PIR_BODY_MOVING ? 0 : 1;
    else if (a->pieces == 1 && b->pieces == 1)
        return -1;
    return is_solid(side == 0 ? p : q) ? side : -1;
}

/* Marks the pieces that ask: with `once` those of bodies of one piece that ask of one convex piece, the others with
   `more`. */
static void mark_askers(pir_scene *scene, uint64_t once, uint64_t more) {
    pir_scene_piece *pieces = scene->bodies.piece;
    for (uint32_t w = 0; w < scene->threads; w++)
        for (uint32_t i = 0; i < scene->worker[w].found_count; i++) {
            const uint32_t pair = scene->worker[w].found[i].pair;
            const int side = union_side(scene, pair);
            if (side < 0)
                continue;
            const uint32_t *of = scene->pairs.at[pair].piece;
            pir_scene_piece *asker = &pieces[of[1 - side]];
            const bool again = asker->mark == once || asker->mark == more;
            const bool of_pieces = scene->bodies.body[asker->body].pieces > 1;
            asker->mark = again || of_pieces || pieces[of[side]].kind == PIR_PIECE_TRIANGLE ? more : once;
        }
}

uint32_t pir_scene_list_union_items(pir_scene *scene) {
    const uint64_t once = ++scene->visit, more = ++scene->visit;
    const pir_scene_piece *pieces = scene->bodies.piece;
    uint32_t count = 0;
    mark_askers(scene, once, more);
    for (uint32_t w = 0; w < scene->threads; w++)
        for (uint32_t i = 0; i < scene->worker[w].found_count; i++) {
            pir_scene_found *found = &scene->worker[w].found[i];
            const int side = union_side(scene, found->pair);
            const uint32_t *of = scene->pairs.at[found->pair].piece;
            if (side < 0 || pieces[of[1 - side]].mark != more)
                continue;
            const pir_scene_piece *part = &pieces[of[side]];
            scene->lists.item[count++] = (pir_scene_item){
                {of[1 - side], (uint64_t)part->body << 32 | part->number}, NULL, found, found->pair, 0};
        }
    if (count > 1)
        pir_scene_sort_items(scene->lists.item, scene->lists.work, count);
    return count;
}

const pir_scene_piece *pir_scene_union_part(const pir_scene *scene, const pir_scene_item *item) {
    const uint32_t *of = scene->pairs.at[item->pair].piece;
    return &scene->bodies.piece[of[0] == item->key.bodies ? of[1] : of[0]];
}

/* --- groups --- */

/* Whether two parts are in one union, for sure where they are triangles, else because their boxes meet. */
static bool is_joined(const pir_scene *scene, const pir_scene_piece *p, const pir_scene_piece *q) {
    const pir_scene_body *a = &scene->bodies.body[p->body], *b = &scene->bodies.body[q->body];
    const bool one = p->body == q->body || (a->kind != PIR_BODY_MOVING && b->kind != PIR_BODY_MOVING);
    if (!one || a->radius != b->radius)
        return false;
    return (p->kind == PIR_PIECE_TRIANGLE && q->kind == PIR_PIECE_TRIANGLE) || pir_box_meets(&p->tight, &q->tight);
}

/* Puts a triangle into the group of the first one of its radius. */
static void group_triangle(const pir_scene *scene, pir_scene_item *item, uint32_t i) {
    const pir_scene_piece *part = pir_scene_union_part(scene, &item[i]);
    for (uint32_t k = 0; k < i && item[i].group == i; k++) {
        const pir_scene_piece *other = pir_scene_union_part(scene, &item[k]);
        if (other->kind == PIR_PIECE_TRIANGLE && is_joined(scene, part, other))
            item[i].group = k;
    }
}

/* Puts two groups together under the lower number. */
static void join(pir_scene_item *item, uint32_t count, uint32_t a, uint32_t b) {
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    for (uint32_t i = high; i < count; i++)
        if (item[i].group == high)
            item[i].group = low;
}

void pir_scene_group_items(const pir_scene *scene, pir_scene_item *item, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        item[i].group = i;
        if (pir_scene_union_part(scene, &item[i])->kind == PIR_PIECE_TRIANGLE)
            group_triangle(scene, item, i);
    }
    for (uint32_t i = 0; i < count; i++) {
        const pir_scene_piece *part = pir_scene_union_part(scene, &item[i]);
        for (uint32_t k = 0; k < count && part->kind == PIR_PIECE_CONVEX; k++)
            if (item[k].group != item[i].group && is_joined(scene, part, pir_scene_union_part(scene, &item[k])))
                join(item, count, item[k].group, item[i].group);
    }
}

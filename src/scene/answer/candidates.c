/* SPDX-License-Identifier: MIT */
/* The pairs that an update has to look at: see candidates.h. */
#include "scene/answer/candidates.h"

#include "exact/rotation.h"
#include "polytope/polytope.h"
#include "scene/answer/ask.h"
#include "scene/answer/share.h"
#include "scene/answer/triangle_pairs.h"
#include "scene/change/changes.h"
#include "scene/world/core_simplex.h"
#include "scene/world/grow.h"
#include "scene/world/surfaces.h"
#include "scene/world/triangles.h"

/* How many bodies or blocks of pairs are worth another thread. */
#define WORTH_MORE 64

/* Pairs in a block. */
#define BLOCK 16

static const pir_box *fat_box(const pir_scene *scene, uint32_t piece) {
    return &scene->tree.node[scene->bodies.piece[piece].node].box;
}

/* Pairs of a piece with another, or its triangles, whose box in the tree meets its own. */
static pir_status find_pair(pir_scene *scene, uint32_t piece, uint32_t other) {
    const pir_scene_piece *p = &scene->bodies.piece[piece], *q = &scene->bodies.piece[other];
    if (!pir_bodies_meet(&scene->bodies, p->body, q->body))
        return PIR_OK;
    if (q->kind == PIR_PIECE_SURFACE)
        return pir_scene_find_triangles(scene, piece, other);
    if (p->kind == PIR_PIECE_SURFACE) {
        pir_scene_mark_partners(scene, other);
        return pir_scene_find_triangles(scene, other, piece);
    }
    return q->mark == scene->visit || pir_scene_add_pair(scene, piece, other) ? PIR_OK : PIR_ERR_MEMORY;
}

pir_status pir_scene_find_pairs(pir_scene *scene) {
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < scene->lists.replaced_count; i++) {
        uint32_t piece = scene->lists.replaced[i].piece;
        const pir_box box = *fat_box(scene, piece);
        pir_scene_mark_partners(scene, piece);
        for (uint32_t leaf = pir_tree_first(&scene->tree, &box); leaf != PIR_TREE_NONE && status == PIR_OK;
             leaf = pir_tree_next(&scene->tree, &box, leaf))
            status = find_pair(scene, piece, pir_tree_item(&scene->tree, leaf));
    }
    return status;
}

/* Whether the distance of an earlier answer, less what the bodies have travelled since, rules a contact out. */
static bool stays_apart(const pir_scene *scene, const pir_scene_pair *pair, const pir_scene_body *p,
                        const pir_scene_body *q) {
    double travelled = (p->travel + q->travel) * (1 + 0x1p-50) - pair->travelled;
    return pair->apart > 0 && pair->apart - travelled > scene->margin;
}

pir_status pir_scene_note(pir_scene *scene, pir_scene_worker *worker, uint32_t pair, bool asks) {
    if (!PIR_GROW(&scene->allocator, worker->noted, worker->noted_capacity, worker->noted_count + 1))
        return PIR_ERR_MEMORY;
    worker->noted[worker->noted_count++] = (pir_scene_noted){pair, asks};
    return PIR_OK;
}

/* Polytopes with more vertices are asked by pairs at once. */
#define CORE_POINTS 64

/*
 * Whether doubles prove that a piece and a triangle, which are to be asked, are in no contact: so far apart as no pair
 * has to be made for. Seen from the piece, whose vertices stand as they are.
 */
static bool is_proven_apart(const pir_scene *scene, pir_scene_pair *pair) {
    const pir_scene_piece *pieces = scene->bodies.piece, *p = &pieces[pair->piece[0]], *q = &pieces[pair->piece[1]];
    const pir_scene_piece *triangle = p->kind == PIR_PIECE_TRIANGLE ? p : q, *piece = triangle == p ? q : p;
    if (triangle->kind != PIR_PIECE_TRIANGLE || piece->extent.polytope->vertex_count > CORE_POINTS || pair->touching)
        return false;
    const pir_scene_body *surface = &scene->bodies.body[triangle->body], *body = &scene->bodies.body[piece->body];
    const double around = surface->radius + body->radius,
                 enough = around + scene->margin + PIR_SKIN * 2 * fmin(surface->reach, body->reach);
    pir_rotation to, from;
    pir_vec3 corner[3];
    (void)pir_rotation_set(&to, surface->pose.rotation); // checked when they came
    (void)pir_rotation_set(&from, body->pose.rotation);
    pir_surface_triangle(pir_body_surface_of(surface), triangle->number, corner);
    const pir_vec3 away = pir_vec_sub(surface->pose.translation, body->pose.translation);
    for (int k = 0; k < 3; k++)
        corner[k] = pir_mat_apply_transposed(&from.r, pir_vec_add(pir_mat_apply(&to.r, corner[k]), away));
    const double gap =
        pir_core_gap(piece->extent.polytope->vertex, piece->extent.polytope->vertex_count, corner, enough);
    if (!(gap > around))
        return false;
    pir_scene_keep_apart(pair, surface, body, gap - around);
    return pair->apart > scene->margin;
}

/* Looks at a pair, and notes it where it has to be asked, or its contact is certain to have ended. */
static inline pir_status look(pir_scene *scene, pir_scene_worker *worker, uint32_t number) {
    pir_scene_pair *pair = &scene->pairs.at[number];
    const pir_scene_piece *p = &scene->bodies.piece[pair->piece[0]], *q = &scene->bodies.piece[pair->piece[1]];
    const pir_scene_body *bodies = scene->bodies.body;
    bool asks = pir_box_meets(&p->tight, &q->tight) && !stays_apart(scene, pair, &bodies[p->body], &bodies[q->body]) &&
                !is_proven_apart(scene, pair);
    worker->looked++;
    return asks || pair->touching ? pir_scene_note(scene, worker, number, asks) : PIR_OK;
}

/* Whether a piece's body has moved in this update. */
static inline bool has_moved(const pir_scene *scene, uint32_t piece) {
    return scene->bodies.piece[piece].moved == scene->update;
}

/* Looks at the pairs of moved bodies, by the lists of their pieces. Where both have moved, a pair is P's to look at. */
static void look_by_bodies(pir_scene *scene, uint32_t task, uint32_t begin, uint32_t end) {
    pir_scene_worker *worker = &scene->worker[task];
    const pir_scene_piece *pieces = scene->bodies.piece;
    for (uint32_t i = begin; i < end; i++) {
        const pir_scene_body *body = &scene->bodies.body[scene->lists.moved[i].body];
        for (uint32_t k = pir_body_paired(body); k != PIR_PIECE_NONE; k = pieces[k].next)
            for (uint32_t at = pieces[k].first; at != PIR_END_NONE; at = scene->pairs.at[at / 2].next[at % 2])
                if (at % 2 == 0 || !has_moved(scene, scene->pairs.at[at / 2].piece[0]))
                    pir_scene_worker_note(worker, look(scene, worker, at / 2), i);
    }
}

/* Looks by the table of pairs, a block at a time: memory is read in order, and a pair once. */
static void look_by_table(pir_scene *scene, uint32_t task, uint32_t begin, uint32_t end) {
    pir_scene_worker *worker = &scene->worker[task];
    uint32_t most = scene->pairs.capacity, last = end * BLOCK < most ? end * BLOCK : most;
    for (uint32_t i = begin * BLOCK; i < last; i++) {
        const uint32_t *piece = scene->pairs.at[i].piece;
        // one that is not used has the same piece twice
        if (piece[0] != piece[1] && (has_moved(scene, piece[0]) || has_moved(scene, piece[1])))
            pir_scene_worker_note(worker, look(scene, worker, i), i);
    }
}

static void look_at_all(pir_scene *scene) {
    uint32_t moved = scene->lists.moved_count, bodies = scene->bodies.body_count, pairs = scene->pairs.capacity;
    bool most_move = moved >= bodies - bodies / 4, most_used = scene->pairs.count >= pairs / 2;
    if (most_move && most_used)
        pir_scene_share(scene, (pairs + BLOCK - 1) / BLOCK, WORTH_MORE, look_by_table);
    else
        pir_scene_share(scene, moved, WORTH_MORE, look_by_bodies);
}

/* Gives a pair its pir_pair, and its triangle a polytope. */
static pir_status make_ready(pir_scene *scene, uint32_t pair) {
    pir_scene_piece *p = &scene->bodies.piece[scene->pairs.at[pair].piece[0]],
                    *q = &scene->bodies.piece[scene->pairs.at[pair].piece[1]];
    if (scene->pairs.at[pair].asked)
        return PIR_OK;
    pir_status status = pir_piece_ready(&scene->bodies.body[p->body], &scene->for_triangles, p);
    if (status == PIR_OK)
        status = pir_piece_ready(&scene->bodies.body[q->body], &scene->for_triangles, q);
    if (status == PIR_OK)
        status = pir_scene_pairs_ready(&scene->pairs, &scene->allocator, pair, p->extent.polytope, q->extent.polytope);
    return status;
}

/* Puts what a worker has noted on the lists. There is room. */
static pir_status list_noted(pir_scene *scene, const pir_scene_worker *worker) {
    pir_scene_lists *lists = &scene->lists;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < worker->noted_count && status == PIR_OK; i++) {
        const pir_scene_noted noted = worker->noted[i];
        if (!noted.asks) {
            lists->ended[lists->ended_count++] = noted.pair;
            continue;
        }
        lists->asked[lists->asked_count++] = noted.pair;
        status = make_ready(scene, noted.pair);
    }
    return status;
}

pir_status pir_scene_list_questions(pir_scene *scene) {
    pir_scene_lists *lists = &scene->lists;
    uint32_t most = 0;
    for (uint32_t i = 0; i < scene->threads; i++)
        scene->worker[i].noted_count = scene->worker[i].looked = 0;
    pir_scene_workers_begin(scene);
    look_at_all(scene);
    pir_status status = pir_scene_workers_status(scene);
    for (uint32_t i = 0; i < scene->threads; i++) {
        most += scene->worker[i].noted_count;
        scene->looked += scene->worker[i].looked;
    }
    if (!PIR_GROW(&scene->allocator, lists->asked, lists->asked_capacity, most) ||
        !PIR_GROW(&scene->allocator, lists->ended, lists->ended_capacity, most))
        status = PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < scene->threads && status == PIR_OK; i++)
        status = list_noted(scene, &scene->worker[i]);
    return status;
}

/* The box within which a piece may be without a new search for its pairs. */
static pir_box wide_box(const pir_scene *scene, uint32_t piece) {
    const pir_scene_piece *p = &scene->bodies.piece[piece];
    return p->kind == PIR_PIECE_TRIANGLE ? pir_scene_wide_triangle(scene, p) : *fat_box(scene, piece);
}

static void drop_pairs_of(pir_scene *scene, uint32_t piece) {
    for (uint32_t end = scene->bodies.piece[piece].first; end != PIR_END_NONE;) {
        const pir_scene_pair *pair = &scene->pairs.at[end / 2];
        const uint32_t number = end / 2;
        const pir_box p = wide_box(scene, pair->piece[0]), q = wide_box(scene, pair->piece[1]);
        end = pair->next[end % 2];
        if (!pir_box_meets(&p, &q))
            pir_scene_drop_pair(scene, number);
    }
}

void pir_scene_drop_pairs(pir_scene *scene) {
    const pir_scene_piece *pieces = scene->bodies.piece;
    for (uint32_t i = 0; i < scene->lists.replaced_count; i++) {
        const uint32_t piece = scene->lists.replaced[i].piece;
        pir_body_surface *surface = &scene->bodies.body[pieces[piece].body].surface;
        drop_pairs_of(scene, piece);
        if (pieces[piece].kind != PIR_PIECE_SURFACE)
            continue;
        surface->drift = 0;
        for (uint32_t t = surface->triangles; t != PIR_PIECE_NONE;) {
            const uint32_t next = pieces[t].next;
            drop_pairs_of(scene, t);
            t = next;
        }
    }
}

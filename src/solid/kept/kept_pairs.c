/* SPDX-License-Identifier: MIT */
/* See kept_pairs.h. The planes of a sum are those of solid/sum/convex.h, told by the table's signs. */
#include "solid/kept/kept_pairs.h"

#include <string.h>

/* A pair of which more signs have changed is listed from nothing. */
#define NOTED_MOST 16

struct pair_lister {
    pir_kept_pairs *pairs;
    pir_space *space;
    const pir_convexes *c[2];
    const pir_convex *piece[2];
    uint32_t count;   /* of keys so far */
    uint32_t touched; /* of keys that are to be looked at again */
};

static void push_key(struct pair_lister *l, pir_sum_facet_key key) {
    pir_kept_pairs *pairs = l->pairs;
    if (pir_space_grow(l->space, (void **)&pairs->key, &pairs->key_room, l->count, sizeof *pairs->key))
        pairs->key[l->count++] = key;
}

/* The place of a vertex among those of its piece. */
static uint32_t place_of(const pir_convexes *c, const pir_convex *piece, uint32_t point) {
    uint32_t at = 0;
    while (at < piece->vertex_count && c->vertex[piece->vertex + at] != point)
        at++;
    return at;
}

/* The vertex of piece k that is farthest along a normal of the other: the one from which no edge leads farther. */
static uint32_t farthest(struct pair_lister *l, int k, uint32_t normal) {
    const pir_convexes *c = l->c[k];
    const pir_convex *piece = l->piece[k];
    pir_kept_pairs *pairs = l->pairs;
    if (!pir_space_grow(l->space, (void **)&pairs->below, &pairs->below_room, piece->vertex_count,
                        sizeof *pairs->below))
        return 0;
    memset(pairs->below, 0, piece->vertex_count);
    const pir_sign_half *half = &pairs->table->half[k];
    const uint32_t column = half->column_of[normal];
    for (uint32_t e = piece->edge; e < piece->edge + piece->edge_count; e++) {
        const int sign = pir_sign_at(half, pairs->table->piece_edge[k][e].row, column);
        pairs->below[pairs->edge_at[k][e][sign < 0]] = 1;
    }
    uint32_t at = 0;
    while (at < piece->vertex_count && pairs->below[at])
        at++;
    if (at == piece->vertex_count) {
        pir_space_fault(l->space);
        return 0;
    }
    return c->vertex[piece->vertex + at];
}

/* Lists a face of piece k, with its vertex of the other. */
static void list_face(struct pair_lister *l, int k, uint32_t f) {
    push_key(l, (pir_sum_facet_key){(uint32_t)k, f, farthest(l, 1 - k, l->c[k]->face[f].normal), false});
}

/* Lists two edges, if their arcs cross. */
static void list_crossing(struct pair_lister *l, uint32_t i, uint32_t j) {
    const pir_sign_table *table = l->pairs->table;
    const int right = pir_arcs_cross(table->half, &table->piece_edge[0][i], &table->piece_edge[1][j]);
    if (right != 0)
        push_key(l, (pir_sum_facet_key){2, i, j, right < 0});
}

static void list_keys(struct pair_lister *l) {
    const pir_convex *p = l->piece[0], *q = l->piece[1];
    for (int k = 0; k < 2; k++)
        for (uint32_t f = l->piece[k]->face; f < l->piece[k]->face + l->piece[k]->face_count; f++)
            list_face(l, k, f);
    for (uint32_t i = p->edge; i < p->edge + p->edge_count; i++)
        for (uint32_t j = q->edge; j < q->edge + q->edge_count; j++)
            list_crossing(l, i, j);
}

static uint32_t make_plane(struct pair_lister *l, pir_sum_facet_key key) {
    if (key.kind < 2) {
        const pir_convex_face face = l->c[key.kind]->face[key.a];
        const uint32_t made = pir_space_add_plane(l->space, (const uint32_t[]){face.normal, PIR_SPACE_NONE}, false,
                                                  (const uint32_t[]){face.point, key.b});
        l->space->plane[made].body = (uint8_t)key.kind;
        return made;
    }
    const pir_convex_edge *e = &l->c[0]->edge[key.a], *g = &l->c[1]->edge[key.b];
    return pir_space_add_plane(l->space, (const uint32_t[]){e->direction, g->direction}, key.turned,
                               (const uint32_t[]){e->point, g->point});
}

/* Whether what a stands for comes before b in every list, whatever vertices are farthest. */
static bool comes_before(pir_sum_facet_key a, pir_sum_facet_key b) {
    if (a.kind != b.kind)
        return a.kind < b.kind;
    return a.a != b.a ? a.a < b.a : a.kind == 2 && a.b < b.b;
}

/* Puts a key among those that are to be looked at again, in the order of lists, once. */
static void touch(struct pair_lister *l, pir_sum_facet_key key) {
    pir_kept_pairs *pairs = l->pairs;
    if (!pir_space_grow(l->space, (void **)&pairs->touched, &pairs->touched_room, l->touched, sizeof *pairs->touched))
        return;
    uint32_t at = l->touched;
    while (at > 0 && comes_before(key, pairs->touched[at - 1]))
        at--;
    if (at > 0 && !comes_before(pairs->touched[at - 1], key))
        return;
    memmove(pairs->touched + at + 1, pairs->touched + at, (l->touched - at) * sizeof *pairs->touched);
    pairs->touched[at] = key;
    l->touched++;
}

/* Touches what rests on a sign, of edges of piece k with normals of the other: faces along the normal, and each edge
 * with those beside such a face. */
static void touch_changed(struct pair_lister *l, pir_sign_change change) {
    const pir_sign_table *table = l->pairs->table;
    const int k = (int)change.half, o = 1 - k;
    const pir_convex *p = l->piece[k], *q = l->piece[o];
    for (uint32_t f = q->face; f < q->face + q->face_count; f++)
        if (table->half[k].column_of[l->c[o]->face[f].normal] >> 1 == change.column)
            touch(l, (pir_sum_facet_key){(uint32_t)o, f, 0, false});
    for (uint32_t e = p->edge; e < p->edge + p->edge_count; e++) {
        if (table->piece_edge[k][e].row >> 1 != change.row)
            continue;
        for (uint32_t g = q->edge; g < q->edge + q->edge_count; g++)
            if (table->piece_edge[o][g].left >> 1 == change.column ||
                table->piece_edge[o][g].right >> 1 == change.column)
                touch(l, (pir_sum_facet_key){2, k == 0 ? e : g, k == 0 ? g : e, false});
    }
}

/* Lists the keys that a pair has, but for those that rest on signs which have changed: these are listed anew. */
static void amend_keys(struct pair_lister *l, const pir_kept_pair_sum *pair) {
    const pir_kept_pairs *pairs = l->pairs;
    for (uint32_t n = pair->noted; n > 0; n = pairs->note[n - 1].before)
        touch_changed(l, pairs->table->change[pairs->note[n - 1].change]);
    uint32_t old = 0;
    for (uint32_t i = 0; i < l->touched && l->space->status == PIR_OK; i++) {
        const pir_sum_facet_key key = pairs->touched[i];
        for (; old < pair->count && comes_before(pair->key[old], key); old++)
            push_key(l, pair->key[old]);
        old += old < pair->count && !comes_before(key, pair->key[old]);
        if (key.kind == 2)
            list_crossing(l, key.a, key.b);
        else
            list_face(l, (int)key.kind, key.a);
    }
    for (; old < pair->count; old++)
        push_key(l, pair->key[old]);
}

static void drop(pir_kept_pairs *pairs, pir_space *space, uint32_t plane) {
    const uint32_t before = pairs->is_dropped_room;
    if (!pir_space_grow(space, (void **)&pairs->dropped, &pairs->dropped_room, pairs->dropped_count,
                        sizeof *pairs->dropped) ||
        !pir_space_grow(space, (void **)&pairs->is_dropped, &pairs->is_dropped_room, plane, sizeof *pairs->is_dropped))
        return;
    memset(pairs->is_dropped + before, 0, pairs->is_dropped_room - before);
    pairs->is_dropped[plane] = 1;
    pairs->dropped[pairs->dropped_count++] = plane;
}

static void add(pir_kept_pairs *pairs, pir_space *space, uint32_t plane) {
    if (pir_space_grow(space, (void **)&pairs->added, &pairs->added_room, pairs->added_count, sizeof *pairs->added))
        pairs->added[pairs->added_count++] = plane;
}

/* The planes of the keys that are listed: those that the pair has, or new ones. The others of the pair are dropped. */
static void match(struct pair_lister *l, pir_kept_pair_sum *pair) {
    pir_kept_pairs *pairs = l->pairs;
    if (!pir_space_grow(l->space, (void **)&pairs->plane, &pairs->plane_room, l->count, sizeof *pairs->plane))
        return;
    uint32_t old = 0;
    for (uint32_t i = 0; i < l->count && l->space->status == PIR_OK; i++) {
        const pir_sum_facet_key key = pairs->key[i];
        for (; old < pair->count && comes_before(pair->key[old], key); old++)
            drop(pairs, l->space, pair->plane[old]);
        const bool met = old < pair->count && !comes_before(key, pair->key[old]);
        if (met && pair->key[old].b == key.b && pair->key[old].turned == key.turned) {
            pairs->plane[i] = pair->plane[old++];
            continue;
        }
        if (met)
            drop(pairs, l->space, pair->plane[old++]);
        pairs->plane[i] = make_plane(l, key);
        add(pairs, l->space, pairs->plane[i]);
    }
    for (; old < pair->count; old++)
        drop(pairs, l->space, pair->plane[old]);
}

static void list_pair(pir_kept_pairs *pairs, uint32_t at) {
    pir_sign_table *table = pairs->table;
    const uint32_t l = table->convexes[1].count;
    struct pair_lister lister = {.pairs = pairs,
                                 .space = table->space,
                                 .c = {&table->convexes[0], &table->convexes[1]},
                                 .piece = {&table->convexes[0].convex[at / l], &table->convexes[1].convex[at % l]}};
    pir_kept_pair_sum *pair = &pairs->pair[at];
    const uint32_t added = pairs->added_count, dropped = pairs->dropped_count;
    if (pair->noted > 0 && pair->noted_count <= NOTED_MOST)
        amend_keys(&lister, pair);
    else
        list_keys(&lister);
    pair->noted = pair->noted_count = 0;
    match(&lister, pair);
    if (!pir_space_grow(table->space, (void **)&pair->key, &pair->room, lister.count, sizeof *pair->key) ||
        !pir_space_grow(table->space, (void **)&pair->plane, &pair->plane_room, lister.count, sizeof *pair->plane))
        return;
    memcpy(pair->key, pairs->key, lister.count * sizeof *pair->key);
    memcpy(pair->plane, pairs->plane, lister.count * sizeof *pair->plane);
    pair->count = lister.count;
    pair->first_new = added;
    pair->new_count = pairs->added_count - added;
    pairs->has_changed[at] = pair->new_count > 0 || pairs->dropped_count > dropped;
}

/* Notes where the ends of all edges of a body's pieces are among their vertices. */
static void find_ends(pir_kept_pairs *pairs, int k) {
    const pir_convexes *c = &pairs->table->convexes[k];
    pairs->edge_at[k] = pir_memory_resize(&c->space->allocator, NULL, 0, c->edge_count, sizeof *pairs->edge_at[k]);
    if (!pairs->edge_at[k]) {
        c->space->status = PIR_ERR_MEMORY;
        return;
    }
    for (uint32_t i = 0; i < c->count; i++)
        for (uint32_t e = c->convex[i].edge; e < c->convex[i].edge + c->convex[i].edge_count; e++) {
            pairs->edge_at[k][e][0] = place_of(c, &c->convex[i], c->edge[e].point);
            pairs->edge_at[k][e][1] = place_of(c, &c->convex[i], c->edge[e].end);
        }
}

void pir_kept_pairs_init(pir_kept_pairs *pairs, pir_sign_table *table) {
    pir_space *space = table->space;
    *pairs = (pir_kept_pairs){.table = table, .count = table->convexes[0].count * table->convexes[1].count};
    pairs->pair = PIR_ZEROED(&space->allocator, pir_kept_pair_sum, pairs->count);
    pairs->has_changed = PIR_ZEROED(&space->allocator, uint8_t, pairs->count);
    if (!pairs->pair || !pairs->has_changed)
        space->status = PIR_ERR_MEMORY;
    for (int k = 0; k < 2 && space->status == PIR_OK; k++)
        find_ends(pairs, k);
    for (uint32_t i = 0; i < pairs->count && space->status == PIR_OK; i++)
        list_pair(pairs, i);
    pairs->added_count = 0;
    if (pairs->has_changed)
        memset(pairs->has_changed, 0, pairs->count * sizeof *pairs->has_changed);
}

void pir_kept_pairs_finish(pir_kept_pairs *pairs) {
    if (!pairs->table)
        return;
    pir_space *space = pairs->table->space;
    for (uint32_t i = 0; i < pairs->count && pairs->pair; i++) {
        pir_space_shrink(space, pairs->pair[i].key, pairs->pair[i].room, sizeof *pairs->pair[i].key);
        pir_space_shrink(space, pairs->pair[i].plane, pairs->pair[i].plane_room, sizeof *pairs->pair[i].plane);
    }
    PIR_FREE(&space->allocator, pairs->pair, pairs->count);
    PIR_FREE(&space->allocator, pairs->has_changed, pairs->count);
    for (int k = 0; k < 2; k++)
        PIR_FREE(&space->allocator, pairs->edge_at[k], pairs->table->convexes[k].edge_count);
    pir_space_shrink(space, pairs->changed, pairs->changed_room, sizeof *pairs->changed);
    pir_space_shrink(space, pairs->added, pairs->added_room, sizeof *pairs->added);
    pir_space_shrink(space, pairs->dropped, pairs->dropped_room, sizeof *pairs->dropped);
    pir_space_shrink(space, pairs->is_dropped, pairs->is_dropped_room, sizeof *pairs->is_dropped);
    pir_space_shrink(space, pairs->key, pairs->key_room, sizeof *pairs->key);
    pir_space_shrink(space, pairs->touched, pairs->touched_room, sizeof *pairs->touched);
    pir_space_shrink(space, pairs->note, pairs->note_room, sizeof *pairs->note);
    pir_space_shrink(space, pairs->plane, pairs->plane_room, sizeof *pairs->plane);
    pir_space_shrink(space, pairs->below, pairs->below_room, sizeof *pairs->below);
    *pairs = (pir_kept_pairs){0};
}

/* Notes a sign with the pairs that it is of. */
static void note_change(pir_kept_pairs *pairs, uint32_t number) {
    const pir_sign_table *table = pairs->table;
    const pir_sign_change change = table->change[number];
    const pir_sign_half *half = &table->half[change.half];
    const pir_list_of_lists *rows = &half->row_pieces, *columns = &half->column_pieces;
    for (uint32_t i = rows->start[change.row]; i < rows->start[change.row + 1]; i++)
        for (uint32_t j = columns->start[change.column]; j < columns->start[change.column + 1]; j++) {
            const uint32_t a = rows->entry[i], b = columns->entry[j];
            const uint32_t at = change.half == 0 ? a * table->convexes[1].count + b : b * table->convexes[1].count + a;
            pir_kept_pair_sum *pair = &pairs->pair[at];
            if (!pir_space_grow(table->space, (void **)&pairs->changed, &pairs->changed_room, pairs->changed_count,
                                sizeof *pairs->changed) ||
                !pir_space_grow(table->space, (void **)&pairs->note, &pairs->note_room, pairs->note_count,
                                sizeof *pairs->note))
                return;
            if (pair->noted == 0)
                pairs->changed[pairs->changed_count++] = at;
            pairs->note[pairs->note_count++] = (pir_pair_note){number, pair->noted};
            pair->noted = pairs->note_count;
            pair->noted_count++;
        }
}

void pir_kept_pairs_update(pir_kept_pairs *pairs) {
    pir_sign_table *table = pairs->table;
    pairs->changed_count = pairs->added_count = pairs->note_count = 0;
    for (uint32_t i = 0; i < table->change_count; i++)
        note_change(pairs, i);
    for (uint32_t i = 0; i < pairs->changed_count && table->space->status == PIR_OK; i++)
        list_pair(pairs, pairs->changed[i]);
}

void pir_kept_pairs_settle(pir_kept_pairs *pairs) {
    pir_space *space = pairs->table->space;
    for (uint32_t i = 0; i < pairs->dropped_count; i++) {
        const uint32_t plane = pairs->dropped[i];
        pairs->is_dropped[plane] = 0;
        if (pir_space_grow(space, (void **)&space->spare_planes.number, &space->spare_planes.room,
                           space->spare_planes.count, sizeof *space->spare_planes.number))
            space->spare_planes.number[space->spare_planes.count++] = plane;
    }
    pairs->dropped_count = 0;
    for (uint32_t i = 0; i < pairs->changed_count; i++)
        pairs->has_changed[pairs->changed[i]] = 0;
}

pir_space_box pir_kept_pair_box(const pir_kept_pairs *pairs, uint32_t pair) {
    const pir_convexes *convexes = pairs->table->convexes;
    const pir_space_box *a = &convexes[0].convex[pair / convexes[1].count].box;
    const pir_space_box *b = &convexes[1].convex[pair % convexes[1].count].box;
    pir_space_box box;
    for (int k = 0; k < 3; k++) {
        box.low[k] = a->low[k] + b->low[k] - 0x1p-48;
        box.high[k] = a->high[k] + b->high[k] + 0x1p-48;
    }
    return box;
}

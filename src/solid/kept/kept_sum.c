/* SPDX-License-Identifier: MIT */
/* See kept_sum.h. */
#include "solid/kept/kept_sum.h"

#include <math.h>
#include <string.h>

#include "base/sort.h"
#include "solid/space/identity.h"

/* The skin: pairs that may come near in so many steps as the last one are looked at in each frame; but never for a turn
 * by more than this. */
#define SKIN_STEPS 16
#define SKIN_MOST  .05

/* All candidates are listed anew where more than so many may have changed, each counted as often as it is found. */
#define TOUCHED_MOST 4096

/* --- the turn --- */

pir_quat pir_quat_of_length_1(pir_quat q) {
    const double most = fmax(fmax(fabs(q.x), fabs(q.y)), fmax(fabs(q.z), fabs(q.w)));
    const double x = q.x / most, y = q.y / most, z = q.z / most, w = q.w / most;
    const double length = sqrt(x * x + y * y + z * z + w * w);
    return (pir_quat){x / length, y / length, z / length, w / length};
}

double pir_angle_between(pir_quat a, pir_quat b) {
    const double plus[4] = {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
    const double minus[4] = {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
    double square[2] = {0};
    for (int k = 0; k < 4; k++) {
        square[0] += plus[k] * plus[k];
        square[1] += minus[k] * minus[k];
    }
    const double chord = sqrt(fmin(square[0], square[1])) + 0x1p-48;
    return 4 * asin(fmin(chord / 2, 1)) * (1 + 0x1p-40);
}

static void measure_body(pir_kept_sum *kept, uint32_t body) {
    const pir_space *space = kept->space;
    const pir_rest_list *points = &space->rest->points;
    double middle[3] = {0}, radius = 0, farthest = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < points->count; i++)
        if (points->item[i].body == body) {
            for (int k = 0; k < 3; k++)
                middle[k] += space->point[points->item[i].of].x[k];
            count++;
        }
    for (uint32_t i = 0; i < points->count; i++)
        if (points->item[i].body == body) {
            const double *x = space->point[points->item[i].of].x;
            double from[2] = {0};
            for (int k = 0; k < 3; k++) {
                from[0] += (x[k] - middle[k] / count) * (x[k] - middle[k] / count);
                from[1] += x[k] * x[k];
            }
            radius = fmax(radius, from[0]);
            farthest = fmax(farthest, from[1]);
        }
    kept->maker.diameter[body] = 2 * sqrt(radius) * (1 + 0x1p-40) + 0x1p-40;
    if (body == 0)
        kept->farthest = sqrt(farthest) * (1 + 0x1p-40) + 0x1p-40;
}

/* --- candidates --- */

static void push_key(pir_kept_sum *kept, pir_candidate_key key) {
    if (pir_space_grow(kept->space, (void **)&kept->key, &kept->key_room, kept->key_count, sizeof *kept->key))
        kept->key[kept->key_count++] = key;
}

/* The first facet of a body in the plane of one, facing the same way. */
static uint32_t first_in_plane(const pir_shell_body *body, uint32_t facet) {
    uint32_t first = 0;
    while (body->half[first] != body->half[facet])
        first++;
    return first;
}

/* Finds the first edge on the line of each. */
static void list_lines(pir_kept_sum *kept, int k) {
    const pir_shell_body *body = &kept->body[k];
    const uint32_t *row = kept->table.half[k].row_of;
    kept->line[k] = PIR_NEW(&kept->space->allocator, uint32_t, body->edge_count);
    if (!kept->line[k]) {
        kept->space->status = PIR_ERR_MEMORY;
        return;
    }
    for (uint32_t e = 0; e < body->edge_count; e++) {
        const pir_shell_body_edge *edge = &body->edge[e];
        uint32_t first = 0;
        while (first < e && (row[body->edge[first].direction] >> 1 != row[edge->direction] >> 1 ||
                             !pir_identity_of_way(kept->space, edge->direction, edge->a, body->edge[first].a)))
            first++;
        kept->line[k][e] = first;
    }
}

/* The order of candidates: by planes, and in one plane as they are made anew. */
static int compare_planes(pir_candidate_key a, pir_candidate_key b) {
    const uint32_t x[3] = {a.kind, a.plane[0], a.plane[1]}, y[3] = {b.kind, b.plane[0], b.plane[1]};
    for (int k = 0; k < 3; k++)
        if (x[k] != y[k])
            return x[k] < y[k] ? -1 : 1;
    return 0;
}

static bool key_before(pir_candidate_key a, pir_candidate_key b) {
    const int by_plane = compare_planes(a, b);
    if (by_plane != 0)
        return by_plane < 0;
    return a.a != b.a ? a.a < b.a : a.b < b.b;
}

/* The key of a facet of body k with a vertex of the other. */
static pir_candidate_key key_at_vertex(const pir_kept_sum *kept, int k, uint32_t f, uint32_t v) {
    const uint32_t first = first_in_plane(&kept->body[k], f);
    return (pir_candidate_key){k == 0 ? PIR_FACET_OF_P : PIR_FACET_OF_Q, {first, v}, f, v, false};
}

/* The key of two edges. */
static pir_candidate_key key_of_edges(const pir_kept_sum *kept, uint32_t i, uint32_t j) {
    return (pir_candidate_key){PIR_TWO_EDGES, {kept->line[0][i], kept->line[1][j]}, i, j, false};
}

/* The vertices of the other body from which no edge leads above a facet of body k, for all facets. */
static void list_at_vertices(pir_kept_sum *kept, int k) {
    const pir_shell_body *a = &kept->body[k], *b = &kept->body[1 - k];
    const pir_sign_half *half = &kept->table.half[1 - k];
    const pir_table_edge *table_edge = kept->table.edge[1 - k];
    const uint32_t points = b->source.point_count;
    if (!pir_space_grow(kept->space, (void **)&kept->below, &kept->below_room, points, sizeof *kept->below))
        return;
    for (uint32_t f = 0; f < a->source.facet_count; f++) {
        if (a->group[f] != f)
            continue;
        const uint32_t column = half->column_of[kept->space->plane[a->plane[f]].direction[0]];
        memset(kept->below, 2, points);
        for (uint32_t e = 0; e < b->edge_count; e++) {
            const pir_shell_body_edge *edge = &b->edge[e];
            const bool leads = pir_sign_at(half, table_edge[e].row, column) > 0;
            uint8_t *from = &kept->below[edge->a - b->first_point], *to = &kept->below[edge->b - b->first_point];
            *(leads ? from : to) = 1;
            *(leads ? to : from) &= 1;
        }
        for (uint32_t v = 0; v < points; v++)
            if (kept->below[v] == 0)
                push_key(kept, key_at_vertex(kept, k, f, v));
    }
}

/* Lists two convex edges, if their arcs cross. */
static void list_crossing(pir_kept_sum *kept, pir_candidate_key key) {
    const pir_sign_table *table = &kept->table;
    const int right = pir_arcs_cross(table->half, &table->edge[0][key.a], &table->edge[1][key.b]);
    if (right == 0)
        return;
    key.turned = right > 0;
    push_key(kept, key);
}

static void list_edges(pir_kept_sum *kept) {
    const pir_shell_body *p = &kept->body[0], *q = &kept->body[1];
    for (uint32_t i = 0; i < p->edge_count; i++)
        for (uint32_t j = 0; j < q->edge_count && p->edge[i].bend == PIR_BEND_CONVEX; j++)
            if (q->edge[j].bend == PIR_BEND_CONVEX)
                list_crossing(kept, key_of_edges(kept, i, j));
}

static bool listed_before(void *context, uint32_t a, uint32_t b) {
    const pir_candidate_key *key = context;
    return key_before(key[a], key[b]);
}

/* Puts the numbers 0 .. count into `order`, sorted. */
static bool sort(pir_kept_sum *kept, uint32_t count, bool (*before)(void *, uint32_t, uint32_t), void *context) {
    if (!pir_space_grow(kept->space, (void **)&kept->order, &kept->order_room, count, sizeof *kept->order) ||
        !pir_space_grow(kept->space, (void **)&kept->work, &kept->work_room, count, sizeof *kept->work))
        return false;
    for (uint32_t i = 0; i < count; i++)
        kept->order[i] = i;
    pir_sort(kept->order, count, kept->work, before, context);
    return true;
}

static void free_facet(pir_kept_sum *kept, pir_plane_facet *facet) {
    pir_kept_facet_finish(&kept->maker, facet);
    PIR_FREE(&kept->space->allocator, facet, 1);
}

/* Makes a facet spare, with the memory that it has. */
static void drop_facet(pir_kept_sum *kept, pir_plane_facet *facet) {
    pir_kept_facet_empty(&kept->maker, facet);
    if (pir_space_grow(kept->space, (void **)&kept->spare, &kept->spare_room, kept->spare_count, sizeof *kept->spare)) {
        kept->spare[kept->spare_count++] = facet;
        return;
    }
    free_facet(kept, facet);
}

static pir_plane_facet *new_facet(pir_kept_sum *kept) {
    if (kept->spare_count > 0)
        return kept->spare[--kept->spare_count];
    pir_plane_facet *facet = PIR_ZEROED(&kept->space->allocator, pir_plane_facet, 1);
    if (!facet)
        kept->space->status = PIR_ERR_MEMORY;
    return facet;
}

/* Gives a facet candidates; where those are others than it had, it is to be made anew. */
static void set_keys(pir_kept_sum *kept, pir_plane_facet *facet, const pir_candidate_key *key, uint32_t count) {
    bool same = facet->key_count == count;
    for (uint32_t i = 0; i < count && same; i++)
        same = facet->key[i].a == key[i].a && facet->key[i].b == key[i].b && facet->key[i].turned == key[i].turned;
    if (same || !pir_space_grow(kept->space, (void **)&facet->key, &facet->key_room, count, sizeof *facet->key))
        return;
    memcpy(facet->key, key, count * sizeof *key);
    facet->key_count = count;
    facet->based = false;
}

/* Brings the facets to the candidates that are listed. */
static void merge_facets(pir_kept_sum *kept) {
    uint32_t old = 0, count = 0;
    if (!pir_space_grow(kept->space, (void **)&kept->merged, &kept->merged_room, kept->key_count, sizeof *kept->merged))
        return;
    for (uint32_t i = 0, end; i < kept->key_count; i = end) {
        const pir_candidate_key key = kept->key[i];
        for (end = i + 1; end < kept->key_count && compare_planes(kept->key[end], key) == 0; end++)
            ;
        for (; old < kept->count && compare_planes(kept->facet[old]->key[0], key) < 0; old++)
            drop_facet(kept, kept->facet[old]);
        const bool known = old < kept->count && compare_planes(kept->facet[old]->key[0], key) == 0;
        kept->merged[count] = known ? kept->facet[old++] : new_facet(kept);
        if (kept->merged[count])
            set_keys(kept, kept->merged[count++], kept->key + i, end - i);
    }
    for (; old < kept->count; old++)
        drop_facet(kept, kept->facet[old]);
    kept->is_listed = false;
    pir_plane_facet **facet = kept->facet;
    const uint32_t room = kept->room;
    kept->facet = kept->merged;
    kept->room = kept->merged_room;
    kept->merged = facet;
    kept->merged_room = room;
    kept->count = count;
}

/* Makes what was listed the list before, and begins another. */
static void begin_list(pir_kept_sum *kept) {
    pir_candidate_key *const key = kept->key;
    const uint32_t room = kept->key_room;
    kept->key = kept->key_before;
    kept->key_room = kept->key_before_room;
    kept->key_before = key;
    kept->key_before_room = room;
    kept->key_before_count = kept->key_count;
    kept->key_count = 0;
}

/* Brings the facets to the candidates that the table tells. */
static void list_facets(pir_kept_sum *kept) {
    kept->key_count = 0;
    list_at_vertices(kept, 0);
    list_edges(kept);
    list_at_vertices(kept, 1);
    begin_list(kept);
    if (!sort(kept, kept->key_before_count, listed_before, kept->key_before))
        return;
    for (uint32_t i = 0; i < kept->key_before_count; i++)
        push_key(kept, kept->key_before[kept->order[i]]);
    merge_facets(kept);
}

/* --- candidates that change --- */

/* Puts a key among those that are to be looked at again. */
static void touch(pir_kept_sum *kept, pir_candidate_key key) {
    if (pir_space_grow(kept->space, (void **)&kept->touched, &kept->touched_room, kept->touched_count,
                       sizeof *kept->touched))
        kept->touched[kept->touched_count++] = key;
}

/* Touches the candidates that rest on a sign, of an edge e of body k with a column of normals of the other: with the
 * facets that have such a normal the ends of e, and e with the edges beside them. */
static void touch_edge(pir_kept_sum *kept, int k, uint32_t e, uint32_t column) {
    const pir_shell_body *a = &kept->body[k], *b = &kept->body[1 - k];
    const pir_sign_half *half = &kept->table.half[k];
    const pir_table_edge *other = kept->table.edge[1 - k];
    for (uint32_t f = 0; f < b->source.facet_count; f++) {
        if (b->group[f] != f || half->column_of[kept->space->plane[b->plane[f]].direction[0]] >> 1 != column)
            continue;
        touch(kept, key_at_vertex(kept, 1 - k, f, a->edge[e].a - a->first_point));
        touch(kept, key_at_vertex(kept, 1 - k, f, a->edge[e].b - a->first_point));
    }
    for (uint32_t g = 0; g < b->edge_count && a->edge[e].bend == PIR_BEND_CONVEX; g++)
        if (b->edge[g].bend == PIR_BEND_CONVEX && (other[g].left >> 1 == column || other[g].right >> 1 == column))
            touch(kept, k == 0 ? key_of_edges(kept, e, g) : key_of_edges(kept, g, e));
}

/* Touches all candidates that rest on signs which have changed; false where these are many. */
static bool touch_changed(pir_kept_sum *kept) {
    const pir_sign_table *table = &kept->table;
    kept->touched_count = 0;
    for (uint32_t i = 0; i < table->change_count && kept->touched_count <= TOUCHED_MOST; i++) {
        const pir_sign_change change = table->change[i];
        const pir_sign_half *half = &table->half[change.half];
        if (!half->row_is_outer[change.row] || !half->column_is_outer[change.column])
            continue;
        for (uint32_t e = 0; e < kept->body[change.half].edge_count; e++)
            if (table->edge[change.half][e].row >> 1 == change.row)
                touch_edge(kept, (int)change.half, e, change.column);
    }
    return kept->touched_count <= TOUCHED_MOST;
}

/* Lists a facet with a vertex, if no edge leads from there above the facet. */
static void list_at_vertex(pir_kept_sum *kept, pir_candidate_key key) {
    const int k = key.kind == PIR_FACET_OF_P ? 0 : 1;
    const pir_shell_body *a = &kept->body[k], *b = &kept->body[1 - k];
    const pir_sign_half *half = &kept->table.half[1 - k];
    const uint32_t column = half->column_of[kept->space->plane[a->plane[key.a]].direction[0]];
    const uint32_t vertex = b->first_point + key.b;
    for (uint32_t e = 0; e < b->edge_count; e++) {
        const bool begins = b->edge[e].a == vertex;
        if ((begins || b->edge[e].b == vertex) &&
            (pir_sign_at(half, kept->table.edge[1 - k][e].row, column) > 0) == begins)
            return;
    }
    push_key(kept, key);
}

/* Likewise, from those that the facets have: only candidates that rest on signs which have changed are looked at. */
static void amend_facets(pir_kept_sum *kept) {
    if (!touch_changed(kept)) {
        list_facets(kept);
        return;
    }
    uint32_t old = 0;
    if (kept->touched_count == 0 || !sort(kept, kept->touched_count, listed_before, kept->touched))
        return;
    begin_list(kept);
    const pir_candidate_key *before = kept->key_before;
    for (uint32_t i = 0; i < kept->touched_count && kept->space->status == PIR_OK; i++) {
        const pir_candidate_key key = kept->touched[kept->order[i]];
        if (i > 0 && !key_before(kept->touched[kept->order[i - 1]], key))
            continue;
        for (; old < kept->key_before_count && key_before(before[old], key); old++)
            push_key(kept, before[old]);
        old += old < kept->key_before_count && !key_before(key, before[old]);
        if (key.kind == PIR_TWO_EDGES)
            list_crossing(kept, key);
        else
            list_at_vertex(kept, key);
    }
    for (; old < kept->key_before_count; old++)
        push_key(kept, before[old]);
    merge_facets(kept);
}

/* --- what is near --- */

static void make_boxes(pir_kept_sum *kept, double step) {
    pir_space *space = kept->space;
    const uint32_t count = kept->pairs.count;
    if (!pir_space_grow(space, (void **)&kept->box, &kept->box_room, count, sizeof *kept->box))
        return;
    for (uint32_t i = 0; i < count; i++)
        kept->box[i] = pir_kept_pair_box(&kept->pairs, i);
    if (kept->has_boxes)
        pir_boxes_replace(&kept->boxes, kept->box);
    else
        kept->has_boxes = pir_boxes_init(&kept->boxes, &space->allocator, kept->box, count);
    if (!kept->has_boxes)
        space->status = PIR_ERR_MEMORY;
    const double turn = fmin(SKIN_STEPS * step, SKIN_MOST);
    kept->boxes_turn = kept->maker.turn;
    kept->skin = turn * fmin(kept->maker.diameter[0], kept->maker.diameter[1]);
    kept->near_until = kept->maker.turn + turn * (1 - 0x1p-40) - PIR_TURN_SLACK;
}

/* The pairs whose sums are nearer to a facet's candidates than the skin, of the box that those have: the boxes of the
 * sums have moved since. */
static uint32_t find_near(pir_kept_sum *kept, pir_space_box box) {
    const double moved = kept->skin + (kept->maker.turn - kept->boxes_turn) * kept->farthest + 0x1p-40;
    for (int k = 0; k < 3; k++) {
        box.low[k] -= moved;
        box.high[k] += moved;
    }
    return pir_boxes_find(&kept->boxes, &box, kept->found);
}

/* --- all --- */

/* Makes a box hold the candidates of a key, before they are there. */
static void add_key(const pir_kept_sum *kept, pir_candidate_key key, pir_space_box *ret_box) {
    const pir_shell_body *p = &kept->body[0], *q = &kept->body[1];
    pir_space_box box[2] = {PIR_SPACE_BOX_EMPTY, PIR_SPACE_BOX_EMPTY};
    const pir_space_point *point = kept->space->point;
    if (key.kind == PIR_TWO_EDGES) {
        pir_space_box_add(&box[0], &point[p->edge[key.a].a]);
        pir_space_box_add(&box[0], &point[p->edge[key.a].b]);
        pir_space_box_add(&box[1], &point[q->edge[key.b].a]);
        pir_space_box_add(&box[1], &point[q->edge[key.b].b]);
    } else {
        const pir_shell_body *a = key.kind == PIR_FACET_OF_P ? p : q, *b = key.kind == PIR_FACET_OF_P ? q : p;
        for (uint32_t part = 0; part < a->part_count; part++)
            for (uint32_t i = a->part_start[part]; i < a->part_start[part + 1]; i++)
                if (a->group[a->part_facet[part]] == key.a)
                    pir_space_box_add(&box[0], &point[a->part_corner[i]]);
        pir_space_box_add(&box[1], &point[b->first_point + key.b]);
    }
    for (int k = 0; k < 3; k++) {
        ret_box->low[k] = fmin(ret_box->low[k], box[0].low[k] + box[1].low[k] - 0x1p-48);
        ret_box->high[k] = fmax(ret_box->high[k], box[0].high[k] + box[1].high[k] + 0x1p-48);
    }
}

static void make_facet(pir_kept_sum *kept, pir_plane_facet *facet) {
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    for (uint32_t i = 0; i < facet->key_count; i++)
        add_key(kept, facet->key[i], &box);
    const uint32_t count = find_near(kept, box);
    pir_kept_facet_make(&kept->maker, facet, kept->found, count);
}

static void update_facet(pir_kept_sum *kept, pir_plane_facet *facet, bool meets) {
    pir_facet_maker *maker = &kept->maker;
    bool upright = false;
    if (facet->based) {
        pir_kept_facet_follow(maker, facet);
        if (meets) {
            const uint32_t count = find_near(kept, pir_kept_facet_box(maker, facet));
            pir_kept_facet_meet(maker, facet, kept->found, count);
        }
        // sides of a facet that stands are told by its walls, too
        upright = pir_kept_facet_is_upright(maker, facet);
        if (pir_kept_facet_stands(maker, facet) && upright)
            return;
    }
    if (!upright)
        make_facet(kept, facet);
    if (kept->space->status == PIR_OK)
        pir_kept_facet_clip(maker, facet);
}

static bool update_facets(pir_kept_sum *kept, bool meets) {
    pir_space *space = kept->space;
    kept->maker.made = kept->maker.looked = 0;
    pir_space_begin_stage(space, "clipping candidates", kept->count);
    for (uint32_t i = 0; i < kept->count && space->status == PIR_OK; i++, space->stage.done++)
        update_facet(kept, kept->facet[i], meets);
    pir_kept_pairs_settle(&kept->pairs);
    space->reuses = false;
    kept->points = space->point_count;
    kept->planes = space->plane_count;
    return kept->valid = space->status == PIR_OK;
}

bool pir_kept_sum_make(pir_kept_sum *kept, const pir_shell_body body[2], pir_convexes convexes[2], pir_quat rotation) {
    pir_space *space = body[0].space;
    *kept =
        (pir_kept_sum){.space = space, .body = body, .convexes = convexes, .rotation = pir_quat_of_length_1(rotation)};
    pir_sign_table_init(&kept->table, body, convexes);
    for (int k = 0; k < 2 && space->status == PIR_OK; k++)
        list_lines(kept, k);
    if (space->status != PIR_OK || !pir_sign_table_make(&kept->table, 0))
        return false;
    kept->maker = (pir_facet_maker){.space = space, .body = body, .pairs = &kept->pairs};
    pir_polygons_init(&kept->maker.polygons, space);
    pir_kept_glue_init(&kept->glue, space);
    measure_body(kept, 0);
    measure_body(kept, 1);
    space->reuses = true;
    pir_space_begin_stage(space, "adding pairs of pieces", 0);
    pir_kept_pairs_init(&kept->pairs, &kept->table);
    kept->found = PIR_NEW(&space->allocator, uint32_t, kept->pairs.count);
    if (!kept->found)
        space->status = PIR_ERR_MEMORY;
    if (space->status == PIR_OK)
        make_boxes(kept, 0x1p-10);
    if (space->status == PIR_OK)
        list_facets(kept);
    return update_facets(kept, false);
}

void pir_kept_sum_begin(pir_kept_sum *kept) {
    kept->space->point_count = kept->points;
    kept->space->plane_count = kept->planes;
}

bool pir_kept_sum_update(pir_kept_sum *kept, pir_quat rotation) {
    pir_space *space = kept->space;
    const pir_quat to = pir_quat_of_length_1(rotation);
    const double step = pir_angle_between(kept->rotation, to);
    kept->valid = false;
    kept->rotation = to;
    kept->maker.turn += step + PIR_TURN_SLACK;
    kept->maker.step = step;
    if (!pir_sign_table_update(&kept->table, kept->maker.turn))
        return false;
    space->reuses = true;
    pir_kept_pairs_update(&kept->pairs);
    if (space->status == PIR_OK)
        amend_facets(kept);
    const bool meets = kept->maker.turn >= kept->near_until;
    if (space->status == PIR_OK && meets)
        make_boxes(kept, step);
    return update_facets(kept, meets);
}

static bool first_before(void *context, uint32_t a, uint32_t b) {
    pir_plane_facet *const *facet = context;
    const pir_candidate_key x = facet[a]->key[0], y = facet[b]->key[0];
    if (x.kind != y.kind)
        return x.kind < y.kind;
    return x.a != y.a ? x.a < y.a : x.b < y.b;
}

/* Lists the facets by their first candidates. */
static bool list_by_candidates(pir_kept_sum *kept) {
    pir_space *space = kept->space;
    if (kept->is_listed)
        return true;
    if (!sort(kept, kept->count, first_before, kept->facet) ||
        !pir_space_grow(space, (void **)&kept->by_candidate, &kept->by_candidate_room, kept->count,
                        sizeof *kept->by_candidate))
        return false;
    memcpy(kept->by_candidate, kept->order, kept->count * sizeof *kept->order);
    return kept->is_listed = true;
}

bool pir_kept_sum_glue(pir_kept_sum *kept, pir_sum_boundary *boundary) {
    pir_space *space = kept->space;
    if (!list_by_candidates(kept))
        return false;
    pir_sum_boundary_begin(boundary, space);
    for (uint32_t i = 0; i < kept->count; i++) {
        boundary->candidates += kept->facet[i]->candidates.count;
        boundary->survivors += kept->facet[i]->survivors;
    }
    if (!pir_kept_glue_make(&kept->glue, kept->facet, kept->by_candidate, kept->count, &boundary->loops,
                            &boundary->edges))
        return false;
    pir_sum_boundary_end(boundary);
    return space->status == PIR_OK;
}

void pir_kept_sum_finish(pir_kept_sum *kept) {
    pir_space *space = kept->space;
    if (!space)
        return;
    for (uint32_t i = 0; i < kept->count; i++)
        free_facet(kept, kept->facet[i]);
    for (uint32_t i = 0; i < kept->spare_count; i++)
        free_facet(kept, kept->spare[i]);
    pir_space_shrink(space, kept->spare, kept->spare_room, sizeof(pir_plane_facet *));
    pir_space_shrink(space, kept->facet, kept->room, sizeof(pir_plane_facet *));
    pir_space_shrink(space, kept->merged, kept->merged_room, sizeof(pir_plane_facet *));
    pir_space_shrink(space, kept->key, kept->key_room, sizeof *kept->key);
    pir_space_shrink(space, kept->key_before, kept->key_before_room, sizeof *kept->key_before);
    pir_space_shrink(space, kept->touched, kept->touched_room, sizeof *kept->touched);
    pir_space_shrink(space, kept->order, kept->order_room, sizeof *kept->order);
    pir_space_shrink(space, kept->work, kept->work_room, sizeof *kept->work);
    for (int k = 0; k < 2; k++)
        PIR_FREE(&space->allocator, kept->line[k], kept->body[k].edge_count);
    pir_space_shrink(space, kept->below, kept->below_room, sizeof *kept->below);
    if (kept->has_boxes)
        pir_boxes_finish(&kept->boxes, &space->allocator);
    pir_space_shrink(space, kept->box, kept->box_room, sizeof *kept->box);
    PIR_FREE(&space->allocator, kept->found, kept->pairs.count);
    pir_space_shrink(space, kept->by_candidate, kept->by_candidate_room, sizeof *kept->by_candidate);
    pir_kept_glue_finish(&kept->glue);
    pir_facet_maker_finish(&kept->maker);
    pir_kept_pairs_finish(&kept->pairs);
    pir_sign_table_finish(&kept->table);
    *kept = (pir_kept_sum){0};
}

/* SPDX-License-Identifier: MIT */
/*
 * Changes of the true sum: see facet_changes.h.
 *
 * Arcs lead from f to f' and from g to g', with f × f' a positive multiple of the edge d of P, and g × g' of the
 * edge e of Q. They can meet at N = ±(d × e). Its dot product with d × f, the way of the first arc at f, is |d|²
 * (e·f), and so on at all four ends: both arcs hold N = d × e within when e·f > 0, e·f' < 0, d·g < 0 and d·g' >
 * 0, and −N when all four are the other way round.
 *
 * Most instants are of one mover that crosses one arc. Then the arcs that end at the mover cross the arc before when
 * their other ends are beyond it, and after when they are not.
 */
#include "motion/facet_changes.h"

#include <string.h>

#include "base/memory.h"
#include "base/sort.h"

/* --- lists --- */

static bool reserve_faces(pir_face_list *list, const pir_allocator *a, uint32_t count) {
    if (count <= list->room)
        return true;
    pir_witness *grown = PIR_RESIZE(a, list->at, list->room, count);
    if (!grown)
        return false;
    list->at = grown;
    list->room = count;
    return true;
}

bool pir_face_list_add(pir_face_list *list, const pir_allocator *allocator, pir_witness faces) {
    if (list->count == list->room && !reserve_faces(list, allocator, 2 * list->room + 16))
        return false;
    list->at[list->count++] = faces;
    return true;
}

static bool reserve_pairs(pir_changes *changes, const pir_allocator *a, uint32_t count) {
    if (count <= changes->pair_room)
        return true;
    uint64_t *pair = PIR_NEW(a, uint64_t, count), *sorting = PIR_NEW(a, uint64_t, count);
    if (!pair || !sorting) {
        PIR_FREE(a, pair, count);
        PIR_FREE(a, sorting, count);
        return false;
    }
    PIR_FREE(a, changes->pair, changes->pair_room);
    PIR_FREE(a, changes->sorting, changes->pair_room);
    changes->pair = pair;
    changes->sorting = sorting;
    changes->pair_room = count;
    return true;
}

static uint32_t most_sides(const pir_polytope *p) {
    uint32_t most = 0;
    for (uint32_t f = 0; f < p->facet_count; f++)
        if (p->loop_start[f + 1] - p->loop_start[f] > most)
            most = p->loop_start[f + 1] - p->loop_start[f];
    return most;
}

bool pir_changes_init(pir_changes *changes, const pir_movers *movers) {
    const pir_allocator *a = &movers->allocator;
    const uint32_t p = most_sides(movers->operand[0]), q = most_sides(movers->operand[1]), most = p > q ? p : q;
    *changes = (pir_changes){.stop = PIR_NEW(a, pir_stop, movers->count)};
    if (changes->stop && reserve_faces(&changes->lost, a, 8 * most + 8) &&
        reserve_faces(&changes->gained, a, 8 * most + 8) && reserve_pairs(changes, a, most))
        return true;
    pir_changes_finish(changes, movers);
    return false;
}

void pir_changes_finish(pir_changes *changes, const pir_movers *movers) {
    const pir_allocator *a = &movers->allocator;
    PIR_FREE(a, changes->lost.at, changes->lost.room);
    PIR_FREE(a, changes->gained.at, changes->gained.room);
    PIR_FREE(a, changes->stop, movers->count);
    PIR_FREE(a, changes->pair, changes->pair_room);
    PIR_FREE(a, changes->sorting, changes->pair_room);
    *changes = (pir_changes){.stops = 0};
}

static bool is_before(const pir_witness *a, const pir_witness *b) {
    if (a->p.kind != b->p.kind)
        return a->p.kind > b->p.kind;
    if (a->p.index != b->p.index)
        return a->p.index < b->p.index;
    return a->q.kind != b->q.kind ? a->q.kind > b->q.kind : a->q.index < b->q.index;
}

static bool is_same(const pir_witness *a, const pir_witness *b) {
    return !is_before(a, b) && !is_before(b, a);
}

/* Facets of P first, then edges, then vertices, each by number. Few are told at a time, and most are in order. */
static void sort_faces(pir_face_list *list) {
    for (uint32_t i = 1; i < list->count; i++) {
        const pir_witness moved = list->at[i];
        uint32_t k = i;
        for (; k > 0 && is_before(&moved, &list->at[k - 1]); k--)
            list->at[k] = list->at[k - 1];
        list->at[k] = moved;
    }
}

/* Features of a body and of the other one, as a facet of the sum. */
static inline pir_witness faces_of(int body, pir_feature own, pir_feature other) {
    return body == 0 ? (pir_witness){own, other} : (pir_witness){other, own};
}

static inline void add_faces(pir_face_list *list, pir_witness faces) {
    PIR_ASSERT(list->count < list->room);
    list->at[list->count++] = faces;
}

pir_witness pir_changes_faces(const pir_movers *movers, uint32_t m) {
    const pir_mover *mover = &movers->mover[m];
    const pir_polytope *other = pir_mover_ground(movers, m)->polytope;
    const pir_feature own = {PIR_FEATURE_FACET, pir_mover_facet(movers, m)};
    pir_feature under = {PIR_FEATURE_VERTEX, mover->cell};
    if (mover->pinned != PIR_NONE)
        under = (pir_feature){PIR_FEATURE_FACET, mover->pinned};
    else if (mover->on != PIR_NONE)
        under = (pir_feature){PIR_FEATURE_EDGE, other->edge[mover->on]};
    return faces_of(pir_mover_body(movers, m), own, under);
}

/* --- movers that each cross one arc --- */

/*
 * Adds what changes where a mover leaves its cell through one arc. False where it may not be that, or where doubles
 * cannot tell which arcs crossed.
 */
static bool add_crossing(pir_changes *changes, const pir_movers *movers, uint32_t m) {
    const pir_mover *mover = &movers->mover[m];
    if (!mover->next.alone || !mover->next.simple || mover->on != PIR_NONE)
        return false;
    const int body = pir_mover_body(movers, m);
    const pir_ground *own = &movers->body[body], *ground = &movers->body[1 - body];
    const uint32_t f = m - own->first, half = mover->next.half, target = ground->polytope->target[half];
    const uint32_t start = own->polytope->loop_start[f], end = own->polytope->loop_start[f + 1];
    const pir_feature facet = {PIR_FEATURE_FACET, f}, arc = {PIR_FEATURE_EDGE, ground->polytope->edge[half]};
    if (changes->lost.room - changes->lost.count <= end - start ||
        changes->gained.room - changes->gained.count <= end - start)
        return false;
    for (uint32_t i = start; i < end; i++) {
        const pir_across across = own->polytope->across[i];
        const int sign = pir_movers_filter(movers, own->first + across.facet, half);
        if (sign == 0)
            return false;
        add_faces(sign > 0 ? &changes->lost : &changes->gained,
                  faces_of(body, (pir_feature){PIR_FEATURE_EDGE, across.edge}, arc));
    }
    add_faces(&changes->lost, faces_of(body, facet, (pir_feature){PIR_FEATURE_VERTEX, mover->cell}));
    add_faces(&changes->gained, faces_of(body, facet, (pir_feature){PIR_FEATURE_VERTEX, target}));
    return true;
}

/*
 * Moves every mover of the instant across its arc. False where one of them does not just do that; all are as they were
 * then. No two of them change the same pair of arcs: both of these would lie on one great circle, and an end of one,
 * beside the mover, would have a sign of zero.
 */
static bool cross_alone(pir_changes *changes, pir_movers *movers, pir_queue *queue) {
    const uint32_t first = queue->item[0];
    uint32_t count = 0;
    bool crosses = true;
    changes->lost.count = changes->gained.count = 0;
    do {
        const uint32_t m = pir_queue_pop(queue, movers);
        changes->stop[count++].mover = m;
        crosses = add_crossing(changes, movers, m);
    } while (crosses && queue->count > 0 && pir_movers_order(movers, first, queue->item[0]) == 0);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t m = changes->stop[i].mover;
        pir_mover *mover = &movers->mover[m];
        if (crosses) {
            mover->cell = pir_mover_ground(movers, m)->polytope->target[mover->next.half];
            pir_movers_follow(movers, m);
        }
        if (mover->next.half != PIR_NONE)
            pir_queue_push(queue, movers, m);
    }
    return crosses;
}

/* --- any number of movers --- */

/* Where a mover is at now, which is its instant. */
static pir_stop stop_of(pir_movers *movers, uint32_t m) {
    const pir_mover *mover = &movers->mover[m];
    const pir_polytope *other = pir_mover_ground(movers, m)->polytope;
    pir_stop stop = {m, mover->next.half, PIR_NONE, pir_changes_faces(movers, m)};
    bool alone = mover->next.alone && mover->on == PIR_NONE;
    // another side may have a double root, or one that lasts
    for (uint32_t h = other->ring_start[mover->cell]; alone && h < other->ring_start[mover->cell + 1]; h++)
        alone = h == mover->next.half || pir_movers_sign(movers, m, h, PIR_AT) != 0;
    if (!alone) {
        stop.half = PIR_NONE;
        stop.corner = pir_movers_corner(movers, m);
    }
    return stop;
}

/* The sides of a mover's facet, and those of the arc or the point that it meets. */
static uint32_t pairs_of(const pir_movers *movers, const pir_stop *stop) {
    const pir_polytope *own = movers->body[pir_mover_body(movers, stop->mover)].polytope;
    const pir_polytope *other = pir_mover_ground(movers, stop->mover)->polytope;
    const uint32_t f = pir_mover_facet(movers, stop->mover), g = stop->corner;
    const uint32_t sides = own->loop_start[f + 1] - own->loop_start[f];
    return g == PIR_NONE ? sides : sides * (other->loop_start[g + 1] - other->loop_start[g]);
}

static void add_pair(pir_changes *changes, int body, uint32_t own, uint32_t other) {
    PIR_ASSERT(changes->pairs < changes->pair_room);
    changes->pair[changes->pairs++] = body == 0 ? (uint64_t)own << 32 | other : (uint64_t)other << 32 | own;
}

static void list_pairs(pir_changes *changes, const pir_movers *movers, const pir_stop *stop) {
    const int body = pir_mover_body(movers, stop->mover);
    const pir_polytope *own = movers->body[body].polytope, *other = movers->body[1 - body].polytope;
    const uint32_t f = pir_mover_facet(movers, stop->mover), g = stop->corner;
    for (uint32_t i = own->loop_start[f]; i < own->loop_start[f + 1]; i++) {
        if (g == PIR_NONE) {
            add_pair(changes, body, own->across[i].edge, other->edge[stop->half]);
            continue;
        }
        for (uint32_t k = other->loop_start[g]; k < other->loop_start[g + 1]; k++)
            add_pair(changes, body, own->across[i].edge, other->across[k].edge);
    }
}

bool pir_changes_cross(pir_movers *movers, uint32_t edge_p, uint32_t edge_q, pir_when when) {
    const pir_polytope *p = movers->operand[0], *q = movers->operand[1];
    const uint32_t half_p = p->edge_half[edge_p], half_q = q->edge_half[edge_q], first = movers->body[1].first;
    const int sign = pir_movers_sign(movers, p->arc_ends[edge_p].from, half_q, when);
    return sign != 0 && pir_movers_sign(movers, p->arc_ends[edge_p].to, half_q, when) == -sign &&
           pir_movers_sign(movers, first + q->arc_ends[edge_q].from, half_p, when) == -sign &&
           pir_movers_sign(movers, first + q->arc_ends[edge_q].to, half_p, when) == sign;
}

static void look_at_pairs(pir_changes *changes, pir_movers *movers) {
    for (uint32_t i = 0; i < changes->pairs; i++) {
        const uint64_t pair = changes->pair[i];
        if (i > 0 && pair == changes->pair[i - 1])
            continue;
        const uint32_t edge_p = (uint32_t)(pair >> 32), edge_q = (uint32_t)pair;
        const bool before = pir_changes_cross(movers, edge_p, edge_q, PIR_BEFORE);
        if (before != pir_changes_cross(movers, edge_p, edge_q, PIR_AFTER))
            add_faces(before ? &changes->lost : &changes->gained,
                      (pir_witness){{PIR_FEATURE_EDGE, edge_p}, {PIR_FEATURE_EDGE, edge_q}});
    }
}

/* The cell that a mover at a facet's point is in just after: the facet's farthest corner along the mover's normal. */
static uint32_t cell_beyond(pir_movers *movers, uint32_t m, uint32_t corner) {
    const pir_polytope *other = pir_mover_ground(movers, m)->polytope;
    const uint32_t start = other->loop_start[corner], end = other->loop_start[corner + 1];
    int before = pir_movers_sign(movers, m, other->loop[end - 1], PIR_AFTER);
    for (uint32_t k = start; k < end; k++) {
        const int sign = pir_movers_sign(movers, m, other->loop[k], PIR_AFTER);
        if (before > 0 && sign <= 0)
            return other->origin[other->loop[k]];
        before = sign;
    }
    return movers->mover[m].cell;
}

static void move_on(pir_changes *changes, pir_movers *movers, const pir_stop *stop) {
    const uint32_t m = stop->mover;
    pir_mover *mover = &movers->mover[m];
    if (stop->corner != PIR_NONE)
        mover->cell = cell_beyond(movers, m, stop->corner);
    else if (pir_movers_sign(movers, m, stop->half, PIR_AFTER) > 0)
        mover->cell = pir_mover_ground(movers, m)->polytope->target[stop->half];
    pir_movers_follow(movers, m);
    const pir_witness after = pir_changes_faces(movers, m);
    if (is_same(&stop->before, &after))
        return;
    add_faces(&changes->lost, stop->before);
    add_faces(&changes->gained, after);
}

/* Stably, by bytes from the lowest on. */
static void sort_pairs(pir_changes *changes) {
    uint64_t *from = changes->pair, *to = changes->sorting;
    if (changes->pairs < 24) {
        pir_sort_short(from, changes->pairs);
        return;
    }
    for (int shift = 0; shift < 64; shift += 8) {
        uint32_t start[257] = {0};
        for (uint32_t i = 0; i < changes->pairs; i++)
            start[(from[i] >> shift & 255) + 1]++;
        for (int b = 0; b < 256; b++)
            start[b + 1] += start[b];
        for (uint32_t i = 0; i < changes->pairs; i++)
            to[start[from[i] >> shift & 255]++] = from[i];
        uint64_t *sorted = to;
        to = from;
        from = sorted;
    }
}

/* Takes all movers of the instant from the queue, and makes room for what may change; PIR_ERR_MEMORY puts them back. */
static pir_status gather(pir_changes *changes, pir_movers *movers, pir_queue *queue) {
    const pir_allocator *a = &movers->allocator;
    const uint32_t first = queue->item[0];
    uint64_t pairs = 0;
    changes->stops = changes->pairs = 0;
    while (queue->count > 0 && pir_movers_order(movers, first, queue->item[0]) == 0) {
        pir_stop *stop = &changes->stop[changes->stops++];
        *stop = stop_of(movers, pir_queue_pop(queue, movers));
        pairs += pairs_of(movers, stop);
    }
    const uint64_t most = pairs + changes->stops;
    if (most <= UINT32_MAX && reserve_pairs(changes, a, (uint32_t)pairs) &&
        reserve_faces(&changes->lost, a, (uint32_t)most) && reserve_faces(&changes->gained, a, (uint32_t)most))
        return PIR_OK;
    for (uint32_t i = 0; i < changes->stops; i++)
        pir_queue_push(queue, movers, changes->stop[i].mover);
    return PIR_ERR_MEMORY;
}

pir_status pir_changes_make(pir_changes *changes, pir_movers *movers, pir_queue *queue) {
    const pir_now was = movers->now;
    pir_movers_advance(movers, queue->item[0]);
    if (cross_alone(changes, movers, queue)) {
        sort_faces(&changes->lost);
        sort_faces(&changes->gained);
        return PIR_OK;
    }
    const pir_status status = gather(changes, movers, queue);
    if (status != PIR_OK) {
        movers->now = was;
        return status;
    }
    changes->lost.count = changes->gained.count = 0;
    for (uint32_t i = 0; i < changes->stops; i++)
        list_pairs(changes, movers, &changes->stop[i]);
    sort_pairs(changes);
    look_at_pairs(changes, movers);
    for (uint32_t i = 0; i < changes->stops; i++) {
        move_on(changes, movers, &changes->stop[i]);
        if (movers->mover[changes->stop[i].mover].next.half != PIR_NONE)
            pir_queue_push(queue, movers, changes->stop[i].mover);
    }
    sort_faces(&changes->lost);
    sort_faces(&changes->gained);
    return PIR_OK;
}

/* SPDX-License-Identifier: MIT */
/* Reading records, in the order in which recorder.c writes them. */
#include "cspace/record/replay.h"

#include "base/layout.h"

/* --- memory --- */

static pir_layout layout_of(pir_record_replay *replay) {
    return (pir_layout){{PIR_ROW(replay->fv, replay->p->facet_count), PIR_ROW(replay->vf, replay->q->facet_count),
                         PIR_ROW(replay->slots.first, replay->p->edge_count)}};
}

static void empty(pir_record_replay *replay) {
    replay->begun = false;
    replay->slots.used = replay->slots.count = 0;
    replay->slots.free = PIR_NO_EDGE;
    for (uint32_t e = 0; e < replay->p->edge_count; e++)
        replay->slots.first[e] = PIR_NO_EDGE;
}

bool pir_record_replay_init(pir_record_replay *replay, const pir_polytope *minus_p, const pir_polytope *q,
                            const pir_allocator *allocator) {
    *replay = (pir_record_replay){.allocator = *allocator, .p = minus_p, .q = q};
    pir_layout layout = layout_of(replay);
    if (!pir_layout_new(allocator, &layout) || !pir_ring_ranks_init(&replay->ranks_p, minus_p, allocator) ||
        !pir_ring_ranks_init(&replay->ranks_q, q, allocator))
        return false;
    empty(replay);
    return true;
}

void pir_record_replay_finish(pir_record_replay *replay) {
    if (!replay->p)
        return;
    pir_layout layout = layout_of(replay);
    pir_layout_free(&replay->allocator, &layout);
    pir_ring_ranks_finish(&replay->ranks_p, &replay->allocator);
    pir_ring_ranks_finish(&replay->ranks_q, &replay->allocator);
    PIR_FREE(&replay->allocator, replay->slots.next, replay->slots.room);
    PIR_FREE(&replay->allocator, replay->slots.other, replay->slots.room);
    PIR_FREE(&replay->allocator, replay->ordered, replay->ordered_room);
    *replay = (pir_record_replay){0};
}

static pir_status grow(pir_record_replay *replay) {
    pir_record_replay_slots *slots = &replay->slots;
    if (slots->room > UINT32_MAX / 4)
        return PIR_ERR_LIMIT;
    uint32_t room = slots->room ? 2 * slots->room : 256;
    uint32_t *next = PIR_NEW(&replay->allocator, uint32_t, room), *other = PIR_NEW(&replay->allocator, uint32_t, room);
    if (!next || !other) {
        PIR_FREE(&replay->allocator, next, room);
        PIR_FREE(&replay->allocator, other, room);
        return PIR_ERR_MEMORY;
    }
    for (uint32_t i = 0; i < slots->used; i++) {
        next[i] = slots->next[i];
        other[i] = slots->other[i];
    }
    PIR_FREE(&replay->allocator, slots->next, slots->room);
    PIR_FREE(&replay->allocator, slots->other, slots->room);
    slots->next = next;
    slots->other = other;
    slots->room = room;
    return PIR_OK;
}

/* --- crossings as a set --- */

static pir_status enter(pir_record_replay *replay, uint32_t e, uint32_t g) {
    pir_record_replay_slots *slots = &replay->slots;
    uint32_t slot = slots->free;
    if (slot != PIR_NO_EDGE) {
        slots->free = slots->next[slot];
    } else {
        pir_status status = slots->used < slots->room ? PIR_OK : grow(replay);
        if (status != PIR_OK)
            return status;
        slot = slots->used++;
    }
    slots->other[slot] = g;
    slots->next[slot] = slots->first[e];
    slots->first[e] = slot;
    slots->count++;
    return PIR_OK;
}

/* Takes the crossing out where it is there, enters it where it is not. */
static pir_status toggle(pir_record_replay *replay, uint32_t e, uint32_t g) {
    pir_record_replay_slots *slots = &replay->slots;
    for (uint32_t *link = &slots->first[e]; *link != PIR_NO_EDGE; link = &slots->next[*link]) {
        uint32_t slot = *link;
        if (slots->other[slot] != g)
            continue;
        *link = slots->next[slot];
        slots->next[slot] = slots->free;
        slots->free = slot;
        slots->count--;
        return PIR_OK;
    }
    return enter(replay, e, g);
}

/* --- records --- */

/* A count that is followed by at least so many numbers. */
static uint32_t scan_count(pir_record_scan *scan, uint32_t most) {
    uint32_t count = pir_record_scan_number(scan, most);
    if (count > 2 * (uint64_t)(scan->end - scan->at))
        scan->broken = true;
    return scan->broken ? 0 : count;
}

/* Takes out all crossings of edge e of −P. */
static void clear_edge(pir_record_replay *replay, uint32_t e) {
    pir_record_replay_slots *slots = &replay->slots;
    while (slots->first[e] != PIR_NO_EDGE) {
        uint32_t slot = slots->first[e];
        slots->first[e] = slots->next[slot];
        slots->next[slot] = slots->free;
        slots->free = slot;
        slots->count--;
    }
}

/* The crossings of edge e of −P, which has none yet, from cell to cell: at most as many as there are cells. */
static pir_status scan_way(pir_record_replay *replay, uint32_t e, pir_record_scan *scan) {
    const pir_polytope *p = replay->p, *q = replay->q;
    uint32_t half = p->edge_half[e], cell = replay->fv[p->left[half]], end = replay->fv[pir_right(p, half)];
    for (uint32_t steps = 0; cell != end; steps++) {
        uint32_t step = pir_record_scan_number(scan, q->vertex_count);
        uint32_t side = step == 0 ? pir_half_between(&replay->ranks_q, cell, end)
                                  : pir_half_of_rank(&replay->ranks_q, cell, step - 1);
        if (scan->broken || side == PIR_NO_HALF || steps == q->vertex_count)
            return PIR_ERR_FORMAT;
        // the chain takes each at its front: the order is found again from the cells
        pir_status status = enter(replay, e, q->edge[side]);
        if (status != PIR_OK)
            return status;
        cell = q->target[side];
    }
    return PIR_OK;
}

/* The cell of a facet, as seen from the cell `near`; UINT32_MAX where there is none. */
static uint32_t scan_cell_from(const pir_ring_ranks *other, uint32_t near, pir_record_scan *scan) {
    uint32_t ring = pir_ring_size(other, near);
    uint32_t step = pir_record_scan_number(scan, ring + 1);
    if (step == 0)
        return near;
    if (step > ring)
        return pir_record_scan_number(scan, other->of->vertex_count - 1);
    uint32_t half = pir_half_of_rank(other, near, step - 1);
    return half == PIR_NO_HALF ? UINT32_MAX : other->of->target[half];
}

/* The cells of all facets of an operand. */
static pir_status scan_all_cells(pir_record_replay *replay, bool of_p, pir_record_scan *scan) {
    const pir_ring_ranks *own = of_p ? &replay->ranks_p : &replay->ranks_q,
                         *other = of_p ? &replay->ranks_q : &replay->ranks_p;
    uint32_t *cell = of_p ? replay->fv : replay->vf;
    for (uint32_t f = 0; f < own->of->facet_count; f++) {
        uint32_t guide = own->guide[f];
        cell[f] = guide == PIR_NO_GUIDE ? pir_record_scan_number(scan, other->of->vertex_count - 1)
                                        : scan_cell_from(other, cell[guide], scan);
        if (scan->broken || cell[f] == UINT32_MAX)
            return PIR_ERR_FORMAT;
    }
    return PIR_OK;
}

static pir_status scan_whole(pir_record_replay *replay, pir_record_scan *scan) {
    empty(replay);
    pir_status status = scan_all_cells(replay, true, scan);
    if (status == PIR_OK)
        status = scan_all_cells(replay, false, scan);
    for (uint32_t e = 0; status == PIR_OK && e < replay->p->edge_count; e++)
        status = scan_way(replay, e, scan);
    return status;
}

/* Toggles the crossings that a facet passes with the edge `passed` of the other operand. */
static pir_status pass(pir_record_replay *replay, bool of_p, uint32_t f, uint32_t passed) {
    const pir_polytope *of = of_p ? replay->p : replay->q;
    pir_status status = PIR_OK;
    for (uint32_t i = of->loop_start[f]; status == PIR_OK && i < of->loop_start[f + 1]; i++) {
        uint32_t own = of->edge[of->loop[i]];
        status = of_p ? toggle(replay, own, passed) : toggle(replay, passed, own);
    }
    return status;
}

static pir_status scan_cells(pir_record_replay *replay, bool of_p, pir_record_scan *scan) {
    const pir_polytope *of = of_p ? replay->p : replay->q;
    const pir_ring_ranks *other = of_p ? &replay->ranks_q : &replay->ranks_p;
    uint32_t *cell = of_p ? replay->fv : replay->vf;
    uint32_t count = scan_count(scan, of->facet_count);
    uint64_t f = 0;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; status == PIR_OK && i < count; i++) {
        f += pir_record_scan_number(scan, of->facet_count);
        uint32_t step = pir_record_scan_number(scan, other->of->vertex_count);
        if (scan->broken || f >= of->facet_count)
            return PIR_ERR_FORMAT;
        if (step == 0) {
            cell[f] = pir_record_scan_number(scan, other->of->vertex_count - 1);
            continue;
        }
        uint32_t half = pir_half_of_rank(other, cell[f], step - 1);
        if (half == PIR_NO_HALF)
            return PIR_ERR_FORMAT;
        cell[f] = other->of->target[half];
        status = pass(replay, of_p, (uint32_t)f, other->of->edge[half]);
    }
    return scan->broken ? PIR_ERR_FORMAT : status;
}

static pir_status scan_changes(pir_record_replay *replay, pir_record_scan *scan) {
    const uint32_t edges = replay->p->edge_count;
    pir_status status = scan_cells(replay, true, scan);
    if (status == PIR_OK)
        status = scan_cells(replay, false, scan);
    uint32_t count = status == PIR_OK ? scan_count(scan, edges) : 0;
    uint64_t e = 0;
    for (uint32_t i = 0; status == PIR_OK && i < count; i++) {
        e += pir_record_scan_number(scan, edges);
        if (scan->broken || e >= edges)
            return PIR_ERR_FORMAT;
        clear_edge(replay, (uint32_t)e);
        status = scan_way(replay, (uint32_t)e, scan);
    }
    return status;
}

pir_status pir_record_replay_record(pir_record_replay *replay, const uint8_t *bytes, size_t size) {
    pir_record_scan scan = {bytes, bytes + size, false, false};
    uint32_t kind = pir_record_scan_number(&scan, PIR_RECORD_WHOLE);
    pir_status status = PIR_ERR_FORMAT;
    if (!scan.broken && kind == PIR_RECORD_WHOLE)
        status = scan_whole(replay, &scan);
    else if (!scan.broken && replay->begun)
        status = scan_changes(replay, &scan);
    if (status == PIR_OK && !pir_record_scan_ended(&scan))
        status = PIR_ERR_FORMAT;
    replay->begun = status == PIR_OK;
    return status;
}

/* --- the order along arcs --- */

/* The halfedge of edge g that leaves vertex v, or PIR_NO_EDGE where the edge does not end there. */
static uint32_t half_from(const pir_polytope *q, uint32_t g, uint32_t v) {
    uint32_t half = q->edge_half[g];
    if (q->origin[half] == v)
        return half;
    return q->target[half] == v ? q->twin[half] : PIR_NO_EDGE;
}

/*
 * The crossings of edge e from cell to cell into `ordered`: those that are left are searched for the one that leaves
 * the cell, and the one found takes the place of the first. False where none does, or the last leads elsewhere.
 */
static bool order_edge(const pir_record_replay *replay, uint32_t e, pir_record_replay_crossing *ordered,
                       uint32_t count) {
    const pir_polytope *p = replay->p, *q = replay->q;
    uint32_t half = p->edge_half[e], cell = replay->fv[p->left[half]], i = 0;
    for (uint32_t slot = replay->slots.first[e]; slot != PIR_NO_EDGE; slot = replay->slots.next[slot])
        ordered[i++] = (pir_record_replay_crossing){e, replay->slots.other[slot]};
    for (i = 0; i < count; i++) {
        uint32_t at = i, leaves = PIR_NO_EDGE;
        for (; at < count; at++)
            if ((leaves = half_from(q, ordered[at].half, cell)) != PIR_NO_EDGE)
                break;
        if (at == count)
            return false;
        ordered[at].half = ordered[i].half;
        ordered[i].half = leaves;
        cell = q->target[leaves];
    }
    return cell == replay->fv[pir_right(p, half)];
}

pir_status pir_record_replay_crossings(pir_record_replay *replay, const pir_record_replay_crossing **ret_crossings,
                                       uint32_t *ret_count) {
    const pir_record_replay_slots *slots = &replay->slots;
    if (!replay->begun)
        return PIR_ERR_FORMAT;
    if (!replay->ordered || slots->count > replay->ordered_room) {
        pir_record_replay_crossing *room = PIR_NEW(&replay->allocator, pir_record_replay_crossing, slots->room);
        if (!room)
            return PIR_ERR_MEMORY;
        PIR_FREE(&replay->allocator, replay->ordered, replay->ordered_room);
        replay->ordered = room;
        replay->ordered_room = slots->room;
    }
    uint32_t at = 0;
    for (uint32_t e = 0; e < replay->p->edge_count; e++) {
        uint32_t count = 0;
        for (uint32_t slot = slots->first[e]; slot != PIR_NO_EDGE; slot = slots->next[slot])
            count++;
        if (!order_edge(replay, e, replay->ordered + at, count))
            return PIR_ERR_FORMAT;
        at += count;
    }
    *ret_crossings = replay->ordered;
    *ret_count = slots->count;
    return PIR_OK;
}

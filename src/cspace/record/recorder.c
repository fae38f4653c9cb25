/* SPDX-License-Identifier: MIT */
/*
 * Records of a sum. docs/slices.md says what they are; here is how they are made.
 *
 * The reader toggles the crossings that facets pass as they go to neighbouring cells. What it gets so is mostly right.
 * To know for which edges of −P it is not, the crossings of before and those of now are toggled here, and those that
 * facets pass: edges for which something remains are written as ways from cell to cell. Where the sum has gone through
 * one update, it has done what the reader will do, but for the edges that its journal names: only these are toggled.
 */
#include "cspace/record/recorder.h"

#include "base/layout.h"

#include <string.h>

/* Of so many facets that change more than one, the record is whole: that takes less room. */
#define FEW_OF 2

/* Numbers that are compared at a time. */
#define BLOCK 8

static uint32_t facets_of(const pir_recorder *recorder) {
    return recorder->pairing->p->facet_count + recorder->pairing->q->facet_count;
}

/* --- memory --- */

static pir_layout layout_of(pir_recorder *recorder) {
    const pir_polytope *p = recorder->pairing->p, *q = recorder->pairing->q;
    return (pir_layout){{PIR_ROW(recorder->fv, p->facet_count), PIR_ROW(recorder->vf, q->facet_count),
                         PIR_ROW(recorder->change, facets_of(recorder)), PIR_ROW(recorder->unforeseen, p->edge_count),
                         PIR_ROW(recorder->noted, facets_of(recorder) / 64 + 1),
                         PIR_ROW(recorder->doubtful, p->edge_count / 64 + 1)}};
}

static pir_layout layout_of_slots(pir_recorder *recorder) {
    return (pir_layout){{PIR_ROW(recorder->half, recorder->slot_room), PIR_ROW(recorder->edge, recorder->slot_room)}};
}

/* Room for all slots of the sum's crossings. */
static bool reserve_slots(pir_recorder *recorder) {
    uint32_t room = recorder->pairing->crossings.capacity;
    if (recorder->half && room <= recorder->slot_room)
        return true;
    pir_recorder grown = *recorder;
    grown.half = grown.edge = NULL;
    grown.slot_room = room;
    pir_layout fresh = layout_of_slots(&grown), old = layout_of_slots(recorder);
    if (!pir_layout_new(&recorder->allocator, &fresh)) {
        pir_layout_free(&recorder->allocator, &fresh);
        return false;
    }
    for (uint32_t i = 0; i < room; i++) {
        grown.half[i] = i < recorder->slot_room ? recorder->half[i] : 0;
        grown.edge[i] = i < recorder->slot_room ? recorder->edge[i] : PIR_NO_CROSSING;
    }
    pir_layout_free(&recorder->allocator, &old);
    *recorder = grown;
    return true;
}

bool pir_recorder_init(pir_recorder *recorder, const pir_sum *sum, const pir_allocator *allocator) {
    *recorder = (pir_recorder){.allocator = *allocator, .sum = sum, .pairing = pir_sum_pairing(sum)};
    const pir_polytope *p = recorder->pairing->p, *q = recorder->pairing->q;
    pir_layout layout = layout_of(recorder);
    return pir_sum_keep_journal(sum) == PIR_OK && pir_layout_new(allocator, &layout) &&
           pir_ring_ranks_init(&recorder->p, p, allocator) && pir_ring_ranks_init(&recorder->q, q, allocator) &&
           pir_crossing_set_init(&recorder->toggled, p->edge_count, allocator);
}

void pir_recorder_finish(pir_recorder *recorder) {
    if (!recorder->pairing)
        return;
    pir_layout layout = layout_of(recorder), slots = layout_of_slots(recorder);
    pir_layout_free(&recorder->allocator, &layout);
    pir_layout_free(&recorder->allocator, &slots);
    pir_ring_ranks_finish(&recorder->p, &recorder->allocator);
    pir_ring_ranks_finish(&recorder->q, &recorder->allocator);
    pir_crossing_set_finish(&recorder->toggled);
    *recorder = (pir_recorder){0};
}

/* --- what has changed --- */

/* Whether any of `count` numbers differs, at most BLOCK of them. A whole block takes a few operations on vectors. */
static bool differ(const uint32_t *a, const uint32_t *b, uint32_t count) {
    uint32_t different = 0;
    if (count == BLOCK)
        for (uint32_t i = 0; i < BLOCK; i++)
            different |= a[i] ^ b[i];
    else
        for (uint32_t i = 0; i < count; i++)
            different |= a[i] ^ b[i];
    return different != 0;
}

/* Lists facet f of an operand where it is in another cell than before. */
static void look_at_facet(pir_recorder *recorder, pir_operand operand, uint32_t f) {
    bool of_p = operand == PIR_OPERAND_P;
    uint32_t *held = of_p ? &recorder->fv[f] : &recorder->vf[f];
    uint32_t now = of_p ? recorder->pairing->fv[f] : recorder->pairing->vf[f];
    if (now == *held)
        return;
    uint32_t n = recorder->change_count[PIR_OPERAND_P] + recorder->change_count[PIR_OPERAND_Q];
    recorder->change[n] = (pir_cell_change){f, *held, now};
    recorder->change_count[operand]++;
    *held = now;
}

/* Looks at all facets of an operand. */
static void compare_facets(pir_recorder *recorder, pir_operand operand) {
    const bool of_p = operand == PIR_OPERAND_P;
    const uint32_t *now = of_p ? recorder->pairing->fv : recorder->pairing->vf,
                   *held = of_p ? recorder->fv : recorder->vf;
    const uint32_t facets = of_p ? recorder->pairing->p->facet_count : recorder->pairing->q->facet_count;
    for (uint32_t at = 0; at < facets; at += BLOCK) {
        uint32_t size = facets - at < BLOCK ? facets - at : BLOCK;
        if (!differ(now + at, held + at, size))
            continue;
        for (uint32_t f = at; f < at + size; f++)
            look_at_facet(recorder, operand, f);
    }
}

/* Looks at the facets that the journal names, each once and rising. */
static void look_at_noted_facets(pir_recorder *recorder) {
    const pir_journal *journal = pir_sum_journal(recorder->sum);
    const uint32_t facets = facets_of(recorder), facets_p = recorder->pairing->p->facet_count;
    for (uint64_t n = recorder->seen; n < journal->count; n++) {
        uint32_t number = journal->slot[n % PIR_JOURNAL_ROOM];
        if (number < facets)
            recorder->noted[number / 64] |= (uint64_t)1 << number % 64;
    }
    for (uint32_t w = 0; w <= facets / 64; w++) {
        for (uint64_t left = recorder->noted[w]; left; left &= left - 1) {
            uint32_t number = w * 64 + (uint32_t)__builtin_ctzll(left);
            bool of_p = number < facets_p;
            look_at_facet(recorder, of_p ? PIR_OPERAND_P : PIR_OPERAND_Q, of_p ? number : number - facets_p);
        }
        recorder->noted[w] = 0;
    }
}

/* Finds the edges of −P for which the reader may be wrong. */
static void find_doubtful(pir_recorder *recorder) {
    const pir_journal *journal = pir_sum_journal(recorder->sum);
    const pir_polytope *p = recorder->pairing->p, *q = recorder->pairing->q;
    // of two edges between the same vertices the reader takes the first
    const bool parallel = p->vertex_count == 2 || q->vertex_count == 2;
    const bool once = journal->steps - recorder->steps <= 1 && !parallel &&
                      journal->edge_count - recorder->edges_seen <= PIR_JOURNAL_ROOM;
    memset(recorder->doubtful, once ? 0 : 0xff, (p->edge_count / 64 + 1) * sizeof *recorder->doubtful);
    for (uint64_t n = recorder->edges_seen; once && n < journal->edge_count; n++) {
        uint32_t e = *pir_journal_edge_at(journal, n);
        recorder->doubtful[e / 64] |= (uint64_t)1 << e % 64;
    }
}

/* Toggles a crossing of an edge that is in doubt. */
static inline bool toggle(pir_recorder *recorder, uint32_t e, uint32_t g) {
    return !(recorder->doubtful[e / 64] >> e % 64 & 1) || pir_crossing_set_toggle(&recorder->toggled, e, g);
}

/* Toggles what stood in a slot before, and what stands there now. */
static bool toggle_slot(pir_recorder *recorder, uint32_t slot, uint32_t edge, uint32_t half) {
    const uint32_t *edge_of = recorder->pairing->q->edge, before = recorder->edge[slot];
    return (before == PIR_NO_CROSSING || toggle(recorder, before, edge_of[recorder->half[slot]])) &&
           (edge == PIR_NO_CROSSING || toggle(recorder, edge, edge_of[half]));
}

/* Compares a slot with what stood there, and toggles what has gone and what has come. */
static inline bool look_at_slot(pir_recorder *recorder, const pir_crossings *c, uint32_t slot) {
    const bool used = slot < c->used;
    const uint32_t edge = used ? c->edge[slot] : PIR_NO_CROSSING, half = used ? c->half[slot] : 0;
    if (edge == recorder->edge[slot] && half == recorder->half[slot])
        return true;
    // a free slot holds the halfedge of what stood there
    bool both_free = edge == PIR_NO_CROSSING && recorder->edge[slot] == PIR_NO_CROSSING;
    bool enough = both_free || toggle_slot(recorder, slot, edge, half);
    recorder->edge[slot] = edge;
    recorder->half[slot] = half;
    return enough;
}

/* Looks at all slots. Those that are used no more hold nothing of this pairing, whatever stands there. */
static bool compare_slots(pir_recorder *recorder) {
    const pir_crossings *c = &recorder->pairing->crossings;
    bool enough = true;
    for (uint32_t at = 0; enough && at < recorder->slots_seen; at += BLOCK) {
        uint32_t size = recorder->slots_seen - at < BLOCK ? recorder->slots_seen - at : BLOCK;
        if (at + size <= c->used && !differ(c->half + at, recorder->half + at, size) &&
            !differ(c->edge + at, recorder->edge + at, size))
            continue;
        for (uint32_t slot = at; enough && slot < at + size; slot++)
            enough = look_at_slot(recorder, c, slot);
    }
    return enough;
}

/* Looks at the slots that the journal names. */
static bool look_at_noted_slots(pir_recorder *recorder) {
    const pir_journal *journal = pir_sum_journal(recorder->sum);
    const pir_crossings *c = &recorder->pairing->crossings;
    const uint32_t facets = facets_of(recorder);
    bool enough = true;
    for (uint64_t n = recorder->seen; enough && n < journal->count; n++) {
        uint32_t number = journal->slot[n % PIR_JOURNAL_ROOM];
        enough = number < facets || look_at_slot(recorder, c, number - facets);
    }
    return enough;
}

/* --- writing --- */

/* A pen at the end of bytes that have room for so many more numbers; false when out of memory. */
static bool take_pen(const pir_recorder *recorder, pir_bytes *bytes, size_t numbers, pir_pen *ret_pen) {
    bool enough = pir_bytes_reserve(bytes, &recorder->allocator, numbers * PIR_NUMBER_BYTES + 1);
    *ret_pen = (pir_pen){enough ? bytes->data + bytes->used : NULL, false};
    return enough;
}

/* What has been written belongs to the bytes. */
static void lay_down(const pir_pen *pen, pir_bytes *bytes) {
    bytes->used = (size_t)(pen->at - bytes->data) + pen->odd;
}

/* The crossings of edge e of −P, from cell to cell. */
static void put_way(const pir_recorder *recorder, uint32_t e, pir_pen *pen) {
    const pir_pairing *pairing = recorder->pairing;
    const pir_polytope *q = pairing->q;
    const uint32_t *rank = recorder->q.rank, end = pairing->fv[pairing->p->arc_ends[e].to];
    // the two edges of a segment lead to the same vertex, and only the first of them is straight on
    const bool parallel = q->vertex_count == 2;
    for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at)) {
        uint32_t half = pir_crossing_half(pairing, at);
        bool straight = q->target[half] == end && (!parallel || rank[half] == 0);
        pir_pen_put(pen, straight ? 0 : 1 + rank[half]);
    }
}

/* Toggles the crossings that facet f of `of` passes with the edge `passed` of the other operand. */
static bool toggle_passed(pir_recorder *recorder, pir_operand operand, uint32_t f, uint32_t passed) {
    const bool of_p = operand == PIR_OPERAND_P;
    const pir_polytope *of = of_p ? recorder->pairing->p : recorder->pairing->q;
    bool enough = true;
    if (!of_p && !(recorder->doubtful[passed / 64] >> passed % 64 & 1))
        return true;
    for (uint32_t i = of->loop_start[f]; i < of->loop_start[f + 1]; i++) {
        uint32_t own = of->across[i].edge;
        enough &= toggle(recorder, of_p ? own : passed, of_p ? passed : own);
    }
    return enough;
}

/* The facets of an operand that are in other cells. */
static bool write_cells(pir_recorder *recorder, pir_operand operand, pir_pen *pen) {
    const bool of_p = operand == PIR_OPERAND_P;
    const pir_cell_change *change = recorder->change + (of_p ? 0 : recorder->change_count[0]);
    const pir_ring_ranks *other = of_p ? &recorder->q : &recorder->p;
    uint32_t last = 0, count = recorder->change_count[operand];
    pir_pen_put(pen, count);
    for (const pir_cell_change *end = change + count; change < end; change++) {
        pir_pen_put(pen, change->facet - last);
        last = change->facet;
        uint32_t passed = pir_half_between(other, change->before, change->now);
        if (passed == PIR_NO_HALF) {
            pir_pen_put(pen, 0);
            pir_pen_put(pen, change->now);
            continue;
        }
        pir_pen_put(pen, 1 + other->rank[passed]);
        if (!toggle_passed(recorder, operand, change->facet, other->of->edge[passed]))
            return false;
    }
    return true;
}

static bool write_changes(pir_recorder *recorder, pir_bytes *bytes) {
    const pir_pairing *pairing = recorder->pairing;
    const size_t changes = (size_t)recorder->change_count[0] + recorder->change_count[1];
    pir_pen pen;
    if (!take_pen(recorder, bytes, 4 + 3 * changes + pairing->p->edge_count + pairing->crossings.count, &pen))
        return false;
    pir_pen_put(&pen, PIR_RECORD_CHANGES);
    if (!write_cells(recorder, PIR_OPERAND_P, &pen) || !write_cells(recorder, PIR_OPERAND_Q, &pen))
        return false;
    uint32_t last = 0, count = pir_crossing_set_take(&recorder->toggled, recorder->unforeseen);
    pir_pen_put(&pen, count);
    for (uint32_t i = 0; i < count; i++) {
        pir_pen_put(&pen, recorder->unforeseen[i] - last);
        last = recorder->unforeseen[i];
        put_way(recorder, last, &pen);
    }
    lay_down(&pen, bytes);
    return true;
}

/* The cells of all facets of an operand, each as seen from that of its guide. */
static void put_cells(const pir_recorder *recorder, pir_operand operand, pir_pen *pen) {
    const bool of_p = operand == PIR_OPERAND_P;
    const uint32_t *cell = of_p ? recorder->pairing->fv : recorder->pairing->vf;
    const pir_ring_ranks *own = of_p ? &recorder->p : &recorder->q, *other = of_p ? &recorder->q : &recorder->p;
    for (uint32_t f = 0; f < own->of->facet_count; f++) {
        uint32_t half, guide = own->guide[f];
        if (guide == PIR_NO_GUIDE) {
            pir_pen_put(pen, cell[f]);
        } else if (cell[f] == cell[guide]) {
            pir_pen_put(pen, 0);
        } else if ((half = pir_half_between(other, cell[guide], cell[f])) != PIR_NO_HALF) {
            pir_pen_put(pen, 1 + other->rank[half]);
        } else {
            pir_pen_put(pen, 1 + pir_ring_size(other, cell[guide]));
            pir_pen_put(pen, cell[f]);
        }
    }
}

static bool write_whole(pir_recorder *recorder, pir_bytes *bytes) {
    const pir_pairing *pairing = recorder->pairing;
    pir_pen pen;
    if (!take_pen(recorder, bytes, 1 + (size_t)2 * facets_of(recorder) + pairing->crossings.count, &pen))
        return false;
    pir_pen_put(&pen, PIR_RECORD_WHOLE);
    put_cells(recorder, PIR_OPERAND_P, &pen);
    put_cells(recorder, PIR_OPERAND_Q, &pen);
    for (uint32_t e = 0; e < pairing->p->edge_count; e++)
        put_way(recorder, e, &pen);
    lay_down(&pen, bytes);
    return true;
}

/* Takes what stands in the slots for that of the slice before. */
static void hold_slots(pir_recorder *recorder) {
    const pir_crossings *c = &recorder->pairing->crossings;
    memcpy(recorder->half, c->half, c->used * sizeof *c->half);
    memcpy(recorder->edge, c->edge, c->used * sizeof *c->edge);
    for (uint32_t slot = c->used; slot < recorder->slots_seen; slot++)
        recorder->edge[slot] = PIR_NO_CROSSING;
}

bool pir_recorder_write(pir_recorder *recorder, bool key, pir_bytes *bytes) {
    if (!reserve_slots(recorder))
        return false;
    // slots that are used no more were seen before, and are looked at too
    uint32_t used = recorder->pairing->crossings.used;
    recorder->slots_seen = used > recorder->slots_seen ? used : recorder->slots_seen;
    // the journal is the shorter way, where it reaches back
    const uint64_t noted = pir_sum_journal(recorder->sum)->count;
    const bool few = noted - recorder->seen <= PIR_JOURNAL_ROOM;
    recorder->change_count[PIR_OPERAND_P] = recorder->change_count[PIR_OPERAND_Q] = 0;
    if (few) {
        look_at_noted_facets(recorder);
    } else {
        compare_facets(recorder, PIR_OPERAND_P);
        compare_facets(recorder, PIR_OPERAND_Q);
    }
    uint64_t changed = (uint64_t)recorder->change_count[0] + recorder->change_count[1];
    bool enough;
    if (key || FEW_OF * changed > facets_of(recorder)) {
        hold_slots(recorder);
        enough = write_whole(recorder, bytes);
    } else {
        find_doubtful(recorder);
        enough = (few ? look_at_noted_slots(recorder) : compare_slots(recorder)) && write_changes(recorder, bytes);
    }
    recorder->seen = noted;
    recorder->edges_seen = pir_sum_journal(recorder->sum)->edge_count;
    recorder->steps = pir_sum_journal(recorder->sum)->steps;
    return enough;
}

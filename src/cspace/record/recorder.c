/* SPDX-License-Identifier: MIT */
/*
 * Records of a sum. docs/slices.md says what they are; here is how they are made.
 *
 * The reader lets the crossings follow the facets that go to neighbouring cells (held_crossings.h). What it gets so is
 * mostly right. The edges of −P for which it is not are written as ways from cell to cell. Where the sum has gone
 * through one update, it has done what the reader will do, but for the edges that its journal names: only these are
 * looked at.
 */
#include "cspace/record/recorder.h"

#include "base/layout.h"

#include <string.h>

/* Of so many facets that change more than one, the record is whole. */
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
                         PIR_ROW(recorder->doubtful, p->edge_count / 64 + 1)}};
}

bool pir_recorder_init(pir_recorder *recorder, const pir_sum *sum, const pir_allocator *allocator) {
    *recorder = (pir_recorder){.allocator = *allocator, .sum = sum, .pairing = pir_sum_pairing(sum)};
    const pir_pairing *pairing = recorder->pairing;
    pir_layout layout = layout_of(recorder);
    return pir_sum_keep_journal(sum) == PIR_OK && pir_layout_new(allocator, &layout) &&
           pir_ring_ranks_init(&recorder->p, pairing->p, allocator) &&
           pir_ring_ranks_init(&recorder->q, pairing->q, allocator) &&
           pir_held_crossings_init(&recorder->held, pairing, allocator);
}

void pir_recorder_finish(pir_recorder *recorder) {
    if (!recorder->pairing)
        return;
    pir_layout layout = layout_of(recorder);
    pir_layout_free(&recorder->allocator, &layout);
    pir_ring_ranks_finish(&recorder->p, &recorder->allocator);
    pir_ring_ranks_finish(&recorder->q, &recorder->allocator);
    pir_held_crossings_finish(&recorder->held);
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

/* Lists the facets of an operand that are in other cells than before, and holds the cells of now. */
static void list_changes(pir_recorder *recorder, pir_operand operand) {
    const bool of_p = operand == PIR_OPERAND_P;
    const uint32_t *now = of_p ? recorder->pairing->fv : recorder->pairing->vf;
    uint32_t *held = of_p ? recorder->fv : recorder->vf;
    const uint32_t facets = of_p ? recorder->pairing->p->facet_count : recorder->pairing->q->facet_count;
    pir_cell_change *change = recorder->change + (of_p ? 0 : recorder->change_count[PIR_OPERAND_P]);
    uint32_t count = 0;
    for (uint32_t at = 0; at < facets; at += BLOCK) {
        uint32_t size = facets - at < BLOCK ? facets - at : BLOCK;
        if (!differ(now + at, held + at, size))
            continue;
        // which of them differ is not foreseen: all are written, and those kept that do
        for (uint32_t f = at; f < at + size; f++) {
            const uint32_t before = held[f], after = now[f];
            change[count] = (pir_cell_change){f, before, after};
            count += before != after;
            held[f] = after;
        }
    }
    recorder->change_count[operand] = count;
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
    // no edge has the numbers behind the last one
    recorder->doubtful[p->edge_count / 64] &= ((uint64_t)1 << p->edge_count % 64) - 1;
    for (uint64_t n = recorder->edges_seen; once && n < journal->edge_count; n++) {
        uint32_t e = *pir_journal_edge_at(journal, n);
        recorder->doubtful[e / 64] |= (uint64_t)1 << e % 64;
    }
}

static inline bool is_doubtful(const pir_recorder *recorder, uint32_t e) {
    return recorder->doubtful[e / 64] >> e % 64 & 1;
}

/* Lists the edges of −P for which the reader is wrong, rising; returns their number. */
static uint32_t list_unforeseen(pir_recorder *recorder) {
    uint32_t count = 0;
    for (uint32_t w = 0; w <= recorder->pairing->p->edge_count / 64; w++)
        for (uint64_t left = recorder->doubtful[w]; left; left &= left - 1) {
            uint32_t e = w * 64 + (uint32_t)__builtin_ctzll(left);
            recorder->unforeseen[count] = e;
            count += !pir_is_foreseen(&recorder->held, e);
        }
    return count;
}

/* --- writing --- */

/* A pen at the end of bytes that have room for so many more numbers; false when out of memory. */
static bool take_pen(const pir_recorder *recorder, pir_bytes *bytes, size_t numbers, pir_pen *ret_pen) {
    bool enough = pir_bytes_reserve(bytes, &recorder->allocator, numbers * PIR_NUMBER_BYTES + PIR_PEN_SLACK);
    *ret_pen = (pir_pen){enough ? bytes->data + bytes->used : NULL, 0, 0};
    return enough;
}

/* Ends the bytes where the pen stands. */
static void lay_down(const pir_pen *pen, pir_bytes *bytes) {
    bytes->used = (size_t)(pir_pen_end(pen) - bytes->data);
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

/* Facet f of `of` passes the edge `passed` of the other operand, and so does each edge of it. */
static void pass_edge(pir_recorder *recorder, pir_operand operand, uint32_t f, uint32_t passed) {
    const bool of_p = operand == PIR_OPERAND_P;
    const pir_polytope *of = of_p ? recorder->pairing->p : recorder->pairing->q;
    if (!of_p && !is_doubtful(recorder, passed))
        return;
    for (uint32_t i = of->loop_start[f]; i < of->loop_start[f + 1]; i++) {
        uint32_t own = of->across[i].edge;
        if (!of_p)
            pir_held_crossings_pass(&recorder->held, passed, own);
        else if (is_doubtful(recorder, own))
            pir_held_crossings_pass(&recorder->held, own, passed);
    }
}

/* The facets of an operand that are in other cells. */
static void write_cells(pir_recorder *recorder, pir_operand operand, pir_pen *pen) {
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
        pass_edge(recorder, operand, change->facet, other->of->edge[passed]);
    }
}

static bool write_changes(pir_recorder *recorder, pir_bytes *bytes) {
    const pir_pairing *pairing = recorder->pairing;
    const size_t changes = (size_t)recorder->change_count[0] + recorder->change_count[1];
    pir_pen pen;
    if (!take_pen(recorder, bytes, 4 + 3 * changes + pairing->p->edge_count + pairing->crossings.count, &pen))
        return false;
    pir_pen_put(&pen, PIR_RECORD_CHANGES);
    write_cells(recorder, PIR_OPERAND_P, &pen);
    write_cells(recorder, PIR_OPERAND_Q, &pen);
    uint32_t last = 0, count = list_unforeseen(recorder);
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

bool pir_recorder_write(pir_recorder *recorder, bool key, pir_bytes *bytes) {
    if (!pir_held_crossings_reserve(&recorder->held))
        return false;
    list_changes(recorder, PIR_OPERAND_P);
    list_changes(recorder, PIR_OPERAND_Q);
    const uint64_t changed = (uint64_t)recorder->change_count[PIR_OPERAND_P] + recorder->change_count[PIR_OPERAND_Q];
    bool enough;
    if (key || FEW_OF * changed > facets_of(recorder)) {
        enough = write_whole(recorder, bytes);
    } else {
        find_doubtful(recorder);
        enough = write_changes(recorder, bytes);
    }
    pir_held_crossings_take(&recorder->held);
    recorder->edges_seen = pir_sum_journal(recorder->sum)->edge_count;
    recorder->steps = pir_sum_journal(recorder->sum)->steps;
    return enough;
}

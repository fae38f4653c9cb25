/* SPDX-License-Identifier: MIT */
/*
 * Records of a sum. docs/slices.md says what they are; here is how they are made.
 *
 * What the record must say of crossings is a set: those of before and those of now, each toggled. The reader toggles
 * those that facets pass as they go to neighbouring cells. Toggled here as well, they leave what is still to say. With
 * small steps that is next to nothing: it is what facets passed that took the other way round a corner of a cell.
 */
#include "cspace/record/recorder.h"

#include "base/layout.h"
#include "cspace/record/neighbours.h"

#include <string.h>

/* In place of a crossing: the slot was free. */
#define NO_KEY UINT64_MAX

/* Of so many facets that change more than one, the record is whole: that takes less time, and little more room. */
#define FEW_OF 4

static uint32_t facets_of(const pir_recorder *recorder) {
    return recorder->pairing->p->facet_count + recorder->pairing->q->facet_count;
}

/* Words of bits for all facets; the bits of slots begin with the next word. */
static size_t facet_words(const pir_recorder *recorder) {
    return (size_t)facets_of(recorder) / 64 + 1;
}

/* --- memory --- */

static pir_layout layout_of(pir_recorder *recorder) {
    return (pir_layout){{PIR_ROW(recorder->fv, recorder->pairing->p->facet_count),
                         PIR_ROW(recorder->vf, recorder->pairing->q->facet_count),
                         PIR_ROW(recorder->change, facets_of(recorder))}};
}

static pir_layout layout_of_slots(pir_recorder *recorder) {
    return (pir_layout){{PIR_ROW(recorder->slot, recorder->slot_room),
                         PIR_ROW(recorder->dirty, facet_words(recorder) + recorder->slot_room / 64 + 1)}};
}

/* Room for all slots of the sum's crossings. */
static bool reserve_slots(pir_recorder *recorder) {
    uint32_t room = recorder->pairing->crossings.capacity;
    if (recorder->slot && room <= recorder->slot_room)
        return true;
    pir_recorder grown = *recorder;
    grown.slot = NULL;
    grown.dirty = NULL;
    grown.slot_room = room;
    pir_layout fresh = layout_of_slots(&grown), old = layout_of_slots(recorder);
    if (!pir_layout_new(&recorder->allocator, &fresh)) {
        pir_layout_free(&recorder->allocator, &fresh);
        return false;
    }
    for (uint32_t i = 0; i < room; i++)
        grown.slot[i] = i < recorder->slot_room ? recorder->slot[i] : NO_KEY;
    pir_layout_free(&recorder->allocator, &old);
    *recorder = grown;
    return true;
}

bool pir_recorder_init(pir_recorder *recorder, const pir_sum *sum, const pir_allocator *allocator) {
    *recorder = (pir_recorder){.allocator = *allocator, .sum = sum, .pairing = pir_sum_pairing(sum)};
    pir_crossing_set_init(&recorder->toggled, allocator);
    pir_layout layout = layout_of(recorder);
    return pir_sum_keep_journal(sum) == PIR_OK && pir_layout_new(allocator, &layout);
}

void pir_recorder_finish(pir_recorder *recorder) {
    if (!recorder->pairing)
        return;
    pir_layout layout = layout_of(recorder), slots = layout_of_slots(recorder);
    pir_layout_free(&recorder->allocator, &layout);
    pir_layout_free(&recorder->allocator, &slots);
    pir_crossing_set_finish(&recorder->toggled);
    *recorder = (pir_recorder){0};
}

/* --- what has changed --- */

static pir_crossing_key key_in(const pir_recorder *recorder, uint32_t slot) {
    const pir_crossings *c = &recorder->pairing->crossings;
    if (slot >= c->used || c->edge[slot] == PIR_NO_CROSSING)
        return NO_KEY;
    return pir_crossing_key_of(c->edge[slot], recorder->pairing->q->edge[c->half[slot]]);
}

/* Compares a facet with the slice before; `operand` is whose it is. */
static void look_at_facet(pir_recorder *recorder, pir_operand operand, uint32_t f) {
    bool of_p = operand == PIR_OPERAND_P;
    uint32_t *held = of_p ? &recorder->fv[f] : &recorder->vf[f];
    uint32_t now = of_p ? recorder->pairing->fv[f] : recorder->pairing->vf[f];
    if (now == *held)
        return;
    uint32_t n = recorder->change_count[0] + recorder->change_count[1];
    recorder->change[n] = (pir_cell_change){f, *held, now};
    recorder->change_count[operand]++;
    *held = now;
}

/* Compares a slot with the slice before, and toggles what has gone and what has come. */
static bool look_at_slot(pir_recorder *recorder, uint32_t slot) {
    pir_crossing_key now = key_in(recorder, slot), before = recorder->slot[slot];
    if (now == before)
        return true;
    recorder->slot[slot] = now;
    return (before == NO_KEY || pir_crossing_set_toggle(&recorder->toggled, before)) &&
           (now == NO_KEY || pir_crossing_set_toggle(&recorder->toggled, now));
}

/* A facet of −P or of Q, as the journal numbers them. */
static void look_at_facet_number(pir_recorder *recorder, uint32_t number) {
    uint32_t facets_p = recorder->pairing->p->facet_count;
    if (number < facets_p)
        look_at_facet(recorder, PIR_OPERAND_P, number);
    else
        look_at_facet(recorder, PIR_OPERAND_Q, number - facets_p);
}

/* Marks what the journal names; false where it does not reach back. */
static bool mark_noted(pir_recorder *recorder) {
    const pir_journal *journal = pir_sum_journal(recorder->sum);
    if (journal->count - recorder->seen > PIR_JOURNAL_ROOM)
        return false;
    uint32_t facets = facets_of(recorder);
    size_t shift = 64 * facet_words(recorder) - facets;
    for (uint64_t n = recorder->seen; n < journal->count; n++) {
        uint32_t number = journal->slot[n % PIR_JOURNAL_ROOM];
        size_t bit = number < facets ? number : number + shift;
        recorder->dirty[bit / 64] |= (uint64_t)1 << bit % 64;
    }
    return true;
}

/* Looks at all facets, or at those that are marked, each once and rising. */
static void look_at_facets(pir_recorder *recorder, bool all) {
    for (uint32_t i = 0; all && i < facets_of(recorder); i++)
        look_at_facet_number(recorder, i);
    for (size_t w = 0; !all && w < facet_words(recorder); w++)
        for (uint64_t left = recorder->dirty[w]; left; left &= left - 1)
            look_at_facet_number(recorder, (uint32_t)w * 64 + (uint32_t)__builtin_ctzll(left));
}

/* The same of slots. */
static bool look_at_slots(pir_recorder *recorder, bool all) {
    for (uint32_t i = 0; all && i < recorder->slots_seen; i++)
        if (!look_at_slot(recorder, i))
            return false;
    const uint64_t *dirty = recorder->dirty + facet_words(recorder);
    for (size_t w = 0; !all && w <= recorder->slots_seen / 64; w++)
        for (uint64_t left = dirty[w]; left; left &= left - 1)
            if (!look_at_slot(recorder, (uint32_t)w * 64 + (uint32_t)__builtin_ctzll(left)))
                return false;
    return true;
}

/* Unmarks everything. */
static void unmark(pir_recorder *recorder) {
    size_t words = facet_words(recorder) + recorder->slots_seen / 64 + 1;
    memset(recorder->dirty, 0, words * sizeof *recorder->dirty);
}

/* --- writing --- */

/* Toggles the crossings that facet f of `of` passes with the edge `passed` of the other operand. */
static bool toggle_passed(pir_recorder *recorder, pir_operand operand, uint32_t f, uint32_t passed) {
    const pir_polytope *of = operand == PIR_OPERAND_P ? recorder->pairing->p : recorder->pairing->q;
    for (uint32_t i = of->loop_start[f]; i < of->loop_start[f + 1]; i++) {
        uint32_t own = of->edge[of->loop[i]];
        pir_crossing_key key =
            operand == PIR_OPERAND_P ? pir_crossing_key_of(own, passed) : pir_crossing_key_of(passed, own);
        if (!pir_crossing_set_toggle(&recorder->toggled, key))
            return false;
    }
    return true;
}

/* The facets of an operand that are in other cells. */
static bool write_cells(pir_recorder *recorder, pir_operand operand, pir_bytes *bytes) {
    uint32_t first = operand == PIR_OPERAND_P ? 0 : recorder->change_count[0], last = 0;
    uint32_t count = recorder->change_count[operand];
    const pir_polytope *other = operand == PIR_OPERAND_P ? recorder->pairing->q : recorder->pairing->p;
    if (!pir_bytes_reserve(bytes, &recorder->allocator, ((size_t)3 * count + 1) * PIR_NUMBER_BYTES))
        return false;
    pir_bytes_put(bytes, count);
    for (uint32_t i = 0; i < count; i++) {
        const pir_cell_change *change = &recorder->change[first + i];
        pir_bytes_put(bytes, change->facet - last);
        last = change->facet;
        uint32_t passed = pir_edge_between(other, change->before, change->now);
        if (passed == PIR_NO_EDGE) {
            pir_bytes_put(bytes, 0);
            pir_bytes_put(bytes, change->now);
            continue;
        }
        pir_bytes_put(bytes, 1 + (uint64_t)pir_neighbour_rank(other, change->before, change->now));
        if (!toggle_passed(recorder, operand, change->facet, passed))
            return false;
    }
    return true;
}

static bool write_changes(pir_recorder *recorder, pir_bytes *bytes) {
    if (!pir_bytes_reserve(bytes, &recorder->allocator, PIR_NUMBER_BYTES))
        return false;
    pir_bytes_put(bytes, PIR_RECORD_CHANGES);
    if (!write_cells(recorder, PIR_OPERAND_P, bytes) || !write_cells(recorder, PIR_OPERAND_Q, bytes))
        return false;
    uint32_t count, last = 0;
    const pir_crossing_key *key = pir_crossing_set_remains(&recorder->toggled, &count);
    if (!pir_bytes_reserve(bytes, &recorder->allocator, ((size_t)2 * count + 1) * PIR_NUMBER_BYTES))
        return false;
    pir_bytes_put(bytes, count);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t e = (uint32_t)(key[i] >> 32);
        pir_bytes_put(bytes, e - last);
        pir_bytes_put(bytes, (uint32_t)key[i]);
        last = e;
    }
    return true;
}

static bool write_whole(pir_recorder *recorder, pir_bytes *bytes) {
    const pir_pairing *pairing = recorder->pairing;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    size_t numbers = 1 + (size_t)facets_of(recorder) + p->edge_count + pairing->crossings.count;
    if (!pir_bytes_reserve(bytes, &recorder->allocator, numbers * PIR_NUMBER_BYTES))
        return false;
    pir_bytes_put(bytes, PIR_RECORD_WHOLE);
    for (uint32_t f = 0; f < p->facet_count; f++)
        pir_bytes_put(bytes, pairing->fv[f]);
    for (uint32_t g = 0; g < q->facet_count; g++)
        pir_bytes_put(bytes, pairing->vf[g]);
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t count = 0;
        for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at))
            count++;
        pir_bytes_put(bytes, count);
        for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at))
            pir_bytes_put(bytes, q->edge[pir_crossing_half(pairing, at)]);
    }
    return true;
}

/* Takes what stands in the slots for that of the slice before. */
static void hold_slots(pir_recorder *recorder) {
    for (uint32_t slot = 0; slot < recorder->slots_seen; slot++)
        recorder->slot[slot] = key_in(recorder, slot);
}

static void hold_cells(pir_recorder *recorder) {
    const pir_pairing *pairing = recorder->pairing;
    memcpy(recorder->fv, pairing->fv, pairing->p->facet_count * sizeof *recorder->fv);
    memcpy(recorder->vf, pairing->vf, pairing->q->facet_count * sizeof *recorder->vf);
}

/* The record of what has changed, where that is little, else a whole one. */
static bool write_difference(pir_recorder *recorder, pir_bytes *bytes) {
    bool all = !mark_noted(recorder);
    recorder->change_count[0] = recorder->change_count[1] = 0;
    look_at_facets(recorder, all);
    uint64_t changed = (uint64_t)recorder->change_count[0] + recorder->change_count[1];
    bool enough;
    if (FEW_OF * changed > facets_of(recorder)) {
        hold_slots(recorder);
        enough = write_whole(recorder, bytes);
    } else {
        pir_crossing_set_clear(&recorder->toggled);
        enough = look_at_slots(recorder, all) && write_changes(recorder, bytes);
    }
    unmark(recorder);
    return enough;
}

bool pir_recorder_write(pir_recorder *recorder, bool key, pir_bytes *bytes) {
    if (!reserve_slots(recorder))
        return false;
    // slots that are used no more were seen before, and are looked at too
    uint32_t used = recorder->pairing->crossings.used;
    recorder->slots_seen = used > recorder->slots_seen ? used : recorder->slots_seen;
    bool enough;
    if (key) {
        hold_cells(recorder);
        hold_slots(recorder);
        enough = write_whole(recorder, bytes);
    } else {
        enough = write_difference(recorder, bytes);
    }
    recorder->seen = pir_sum_journal(recorder->sum)->count;
    return enough;
}

/* SPDX-License-Identifier: MIT */
/* See opening_cells.h. */
#include "plan/opening/opening_cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEVELS PIR_OPENING_LEVELS
#define NONE   PIR_OPENING_NONE

void pir_opening_range_of(const pir_opening_cell *cell, pir_opening_range *ret_range) {
    ret_range->axis = cell->chart / 2;
    ret_range->sign = cell->chart % 2 ? -1 : 1;
    memcpy(ret_range->low, cell->low, sizeof cell->low);
    memcpy(ret_range->high, cell->high, sizeof cell->high);
}

static bool grow(pir_opening_cells *t, void **array, uint32_t *room, uint32_t need, size_t size) {
    if (need <= *room)
        return true;
    const uint32_t wanted = need < 32 ? 64 : need + need / 2;
    void *more = realloc(*array, wanted * size);
    if (!more) {
        t->status = PIR_ERR_MEMORY;
        return false;
    }
    *array = more;
    *room = wanted;
    return true;
}

/*
 * Whether a cell may meet the region of the start, or of the goal: no vertex is beyond all its planes. A height is a
 * sum of three products, of coordinates that are rounded, with u exact and at most 1: each product is within 3 units
 * of 2^-53 of its size, and both sums within one of theirs, so the whole is within 2^-50 of the sum of sizes of
 * coordinates, twice which is at most the reach. So 2^-48 of the reach is above the error.
 */
static bool may_meet(const pir_opening_body *body, const pir_opening_cell *cell, int side) {
    pir_opening_range range;
    pir_opening_range_of(cell, &range);
    for (uint32_t v = 0; v < body->vertices; v++) {
        bool is_beyond = true;
        for (int c = 0; c < 4 && is_beyond; c++) {
            double u[3];
            pir_opening_plane(&range, c & 1 ? cell->high[0] : cell->low[0], c & 2 ? cell->high[1] : cell->low[1], u);
            const double h = pir_opening_height(body, v, u), error = body->reach * 0x1p-48;
            is_beyond = side == 0 ? h - error > cell->high[2] : h + error < cell->low[2];
        }
        if (is_beyond)
            return false;
    }
    return true;
}

static void look_at(pir_opening_cells *t, pir_opening_cell *cell) {
    pir_opening_range range;
    double u[3];
    pir_opening_range_of(cell, &range);
    pir_opening_plane(&range, (cell->low[0] + cell->high[0]) / 2, (cell->low[1] + cell->high[1]) / 2, u);
    cell->square = pir_opening_body_cut(t->body, u, (cell->low[2] + cell->high[2]) / 2);
    double corner[4][3];
    for (int c = 0; c < 4; c++)
        pir_opening_plane(&range, c & 1 ? cell->high[0] : cell->low[0], c & 2 ? cell->high[1] : cell->low[1],
                          corner[c]);
    cell->most =
        pir_opening_body_most(t->body, u, (const double(*)[3])corner, (const double[2]){cell->low[2], cell->high[2]});
    cell->child = cell->block = NONE;
    cell->halved = cell->label = -1;
    cell->is_due = false;
    for (int side = 0; side < 2; side++)
        cell->meets[side] = cell->meets[side] && may_meet(t->body, cell, side);
}

static void halve(pir_opening_cells *t, uint32_t of, int axis) {
    if (!grow(t, (void **)&t->cell, &t->room, t->count + 2, sizeof *t->cell))
        return;
    const pir_opening_cell old = t->cell[of];
    const double middle = (old.low[axis] + old.high[axis]) / 2;
    t->cell[of].halved = (int8_t)axis;
    t->cell[of].child = t->count;
    for (int half = 0; half < 2; half++) {
        pir_opening_cell *cell = &t->cell[t->count++];
        *cell = old;
        cell->level[axis]++;
        *(half == 0 ? &cell->high[axis] : &cell->low[axis]) = middle;
        look_at(t, cell);
    }
}

/* --- which cells touch --- */

struct bounds {
    double low[4], high[4];
};

static void bounds_of(const pir_opening_cell *cell, struct bounds *b) {
    const int axis = cell->chart / 2;
    b->low[axis] = b->high[axis] = cell->chart % 2 ? -1 : 1;
    for (int k = 0; k < 2; k++) {
        b->low[(axis + 1 + k) % 3] = cell->low[k];
        b->high[(axis + 1 + k) % 3] = cell->high[k];
    }
    b->low[3] = cell->low[2];
    b->high[3] = cell->high[2];
}

static bool do_touch(const struct bounds *a, const pir_opening_cell *cell) {
    struct bounds b;
    bounds_of(cell, &b);
    for (int k = 0; k < 4; k++)
        if (a->low[k] > b.high[k] || b.low[k] > a->high[k])
            return false;
    return true;
}

/* --- labels --- */

static void queue_push(pir_opening_cells *t, uint32_t cell) {
    if (!grow(t, (void **)&t->queue, &t->queue_room, t->queued + 1, sizeof *t->queue))
        return;
    uint32_t i = t->queued++;
    for (; i > 0 && t->cell[t->queue[(i - 1) / 2]].most > t->cell[cell].most; i = (i - 1) / 2)
        t->queue[i] = t->queue[(i - 1) / 2];
    t->queue[i] = cell;
}

static uint32_t queue_pop(pir_opening_cells *t) {
    const uint32_t top = t->queue[0], last = t->queue[--t->queued];
    uint32_t i = 0;
    for (uint32_t next; (next = 2 * i + 1) < t->queued; i = next) {
        if (next + 1 < t->queued && t->cell[t->queue[next + 1]].most < t->cell[t->queue[next]].most)
            next++;
        if (t->cell[t->queue[next]].most >= t->cell[last].most)
            break;
        t->queue[i] = t->queue[next];
    }
    t->queue[i] = last;
    return top;
}

static void mark_due(pir_opening_cells *t, uint32_t cell, uint32_t rival) {
    if (t->cell[cell].is_due || !grow(t, (void **)&t->due, &t->due_room, t->dues + 1, sizeof *t->due))
        return;
    t->cell[cell].is_due = true;
    t->cell[cell].rival = rival;
    t->due[t->dues++] = cell;
}

/* Gives a cell's label to those that it touches, and lists where another label is met. */
static void spread(pir_opening_cells *t, uint32_t from) {
    uint32_t todo[PIR_OPENING_CHARTS + 3 * LEVELS + 2], count = 0;
    struct bounds bounds;
    const int8_t label = t->cell[from].label;
    bounds_of(&t->cell[from], &bounds);
    t->level = fmax(t->level, t->cell[from].most);
    for (uint32_t i = 0; i < PIR_OPENING_CHARTS; i++)
        todo[count++] = i;
    while (count > 0) {
        const uint32_t i = todo[--count];
        pir_opening_cell *cell = &t->cell[i];
        if (!do_touch(&bounds, cell))
            continue;
        if (cell->child != NONE) {
            todo[count++] = cell->child;
            todo[count++] = cell->child + 1;
        } else if (cell->block != NONE || i == from) {
            continue;
        } else if (cell->label == -1) {
            cell->label = label;
            queue_push(t, i);
        } else if (cell->label != label) {
            const bool is_own = t->cell[from].most >= cell->most;
            mark_due(t, is_own ? from : i, is_own ? i : from);
            t->is_passable = t->is_passable || fmax(t->level, cell->most) <= t->square;
        }
    }
}

static void label_all(pir_opening_cells *t) {
    t->queued = t->dues = 0;
    t->level = 0;
    for (uint32_t i = 0; i < t->count && t->status == PIR_OK; i++) {
        pir_opening_cell *cell = &t->cell[i];
        cell->label = -1;
        cell->is_due = false;
        if (cell->child != NONE || cell->block != NONE || !(cell->meets[0] || cell->meets[1]))
            continue;
        cell->label = cell->meets[0] ? 0 : 1;
        queue_push(t, i);
        if (cell->meets[0] && cell->meets[1])
            mark_due(t, i, i);
    }
    while (t->queued > 0 && t->status == PIR_OK)
        spread(t, queue_pop(t));
}

/* Blocks a cell, which is a leaf without a block; where it cannot be, gives the axis that it is to be halved along. */
static bool block(pir_opening_cells *t, uint32_t of, int *ret_axis) {
    pir_opening_range range;
    pir_opening_block block;
    pir_opening_range_of(&t->cell[of], &range);
    const double more = pir_opening_block_seek(t->body, &range, t->square, &block, ret_axis);
    if (!(t->cell[of].square > t->square && more > 0) ||
        !pir_opening_block_holds(t->body, &range, t->exact_square, &block) ||
        !grow(t, (void **)&t->block, &t->block_room, t->blocks + 1, sizeof *t->block))
        return false;
    t->cell[of].block = t->blocks;
    t->block[t->blocks++] = block;
    return true;
}

/* Blocks a cell that is due, or its rival, or halves it; false where it cannot be halved. */
static bool settle(pir_opening_cells *t, uint32_t of) {
    const uint32_t rival = t->cell[of].rival;
    int axis, other;
    if (t->cell[of].block != NONE || t->cell[of].child != NONE || t->cell[rival].block != NONE || block(t, of, &axis) ||
        (t->cell[rival].child == NONE && t->cell[rival].square > t->square && block(t, rival, &other)))
        return t->status == PIR_OK;
    if (t->cell[of].level[axis] >= LEVELS)
        return false;
    halve(t, of, axis);
    return t->status == PIR_OK;
}

static bool make_roots(pir_opening_cells *t) {
    if (!grow(t, (void **)&t->cell, &t->room, PIR_OPENING_CHARTS, sizeof *t->cell))
        return false;
    for (int8_t chart = 0; chart < PIR_OPENING_CHARTS; chart++) {
        t->cell[t->count] = (pir_opening_cell){
            .chart = chart, .meets = {true, true}, .low = {-1, -1, -t->body->reach}, .high = {1, 1, t->body->reach}};
        look_at(t, &t->cell[t->count++]);
    }
    return true;
}

pir_status pir_opening_cells_decide(const pir_opening_body *body, mpq_srcptr square, const pir_opening_budget *how,
                                    pir_opening_cells *ret_cells, pir_opening_verdict *ret_verdict) {
    pir_opening_cells *t = ret_cells;
    *t = (pir_opening_cells){.body = body, .square = mpq_get_d(square), .exact_square = square};
    *ret_verdict = PIR_OPENING_UNKNOWN;
    if (!make_roots(t))
        return t->status;
    for (bool goes_on = true; goes_on && t->status == PIR_OK && t->count < how->cells;) {
        if (how->goes_on && !how->goes_on(how->context)) {
            t->status = PIR_ERR_LIMIT;
            break;
        }
        label_all(t);
        if (t->is_passable) {
            *ret_verdict = PIR_OPENING_PASSABLE;
            break;
        }
        if (t->dues == 0 && t->status == PIR_OK) {
            *ret_verdict = PIR_OPENING_CLOSED;
            break;
        }
        for (uint32_t i = 0; i < t->dues && goes_on; i++)
            goes_on = settle(t, t->due[i]);
    }
    return t->status;
}

void pir_opening_cells_finish(pir_opening_cells *cells) {
    free(cells->cell);
    free(cells->block);
    free(cells->queue);
    free(cells->due);
    *cells = (pir_opening_cells){0};
}

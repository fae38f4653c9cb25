/* SPDX-License-Identifier: MIT */
/* See plan_cell.h. */
#include "plan/plan_cell.h"

#include <string.h>

#include "base/vec.h"

#define WORD_BITS 64

/* How much a box is wider than the doubles of its points, relatively: they are within 2^-50. */
#define WIDER 0x1p-48

void pir_plan_cutter_finish(pir_plan_cutter *cutter) {
    pir_plan_space *space = cutter->space;
    pir_plan_free(space, cutter->side, cutter->side_room, sizeof *cutter->side);
    pir_plan_free(space, cutter->from, cutter->from_room, sizeof *cutter->from);
    pir_plan_free(space, cutter->kept, cutter->kept_room, sizeof *cutter->kept);
    pir_plan_free(space, cutter->row, cutter->row_room, sizeof *cutter->row);
    pir_plan_free(space, cutter->fresh, cutter->fresh_room, sizeof *cutter->fresh);
}

void pir_plan_cell_free(pir_plan_space *space, pir_plan_cell *cell) {
    pir_plan_free(space, cell->point, cell->points, sizeof *cell->point);
    pir_plan_free(space, cell->half, cell->halves, sizeof *cell->half);
    pir_plan_free(space, cell->tight, (size_t)cell->points * cell->words, sizeof *cell->tight);
    *cell = (pir_plan_cell){.dimension = -1};
}

void pir_plan_box_add(const pir_plan_space *space, uint32_t point, double low[3], double high[3]) {
    const double *x = space->point[point].at;
    for (int k = 0; k < 3; k++) {
        const double room = fabs(x[k]) * WIDER + PIR_PLAN_TINY + space->point[point].room;
        low[k] = pir_lesser(low[k], x[k] - room);
        high[k] = pir_greater(high[k], x[k] + room);
    }
}

/* Arrays of a cell of so many points and half-spaces. */
static bool open_cell(pir_plan_space *space, uint32_t points, uint32_t halves, int dimension, pir_plan_cell *cell) {
    const uint32_t words = (halves + WORD_BITS - 1) / WORD_BITS;
    *cell = (pir_plan_cell){.points = points, .halves = halves, .words = words, .dimension = dimension};
    for (int k = 0; k < 3; k++) {
        cell->low[k] = INFINITY;
        cell->high[k] = -INFINITY;
    }
    cell->point = pir_plan_new(space, points, sizeof *cell->point);
    cell->half = pir_plan_new(space, halves, sizeof *cell->half);
    cell->tight = pir_plan_new(space, (size_t)points * words, sizeof *cell->tight);
    if (space->status == PIR_OK)
        return true;
    pir_plan_cell_free(space, cell);
    return false;
}

static bool bit_of(const uint64_t *row, uint32_t i) {
    return row[i / WORD_BITS] >> i % WORD_BITS & 1;
}

static void set_bit(uint64_t *row, uint32_t i) {
    row[i / WORD_BITS] |= (uint64_t)1 << i % WORD_BITS;
}

void pir_plan_cell_box(pir_plan_cutter *cutter, const double low[3], const double high[3], pir_plan_cell *ret_cell) {
    pir_plan_space *space = cutter->space;
    if (!open_cell(space, 8, 6, 3, ret_cell))
        return;
    for (uint32_t i = 0; i < 6; i++) {
        mpq_t d;
        mpq_init(d);
        mpq_set_d(d, i & 1 ? high[i / 2] : low[i / 2]);
        for (uint32_t k = 0; k < 3; k++)
            mpz_set_ui(space->t[k], 0);
        mpz_set(space->t[i / 2], mpq_denref(d));
        mpz_set(space->t[3], mpq_numref(d));
        if (!(i & 1)) {
            mpz_neg(space->t[i / 2], space->t[i / 2]);
            mpz_neg(space->t[3], space->t[3]);
        }
        ret_cell->half[i] = pir_plan_half(space, space->t, space->t[3]);
        mpq_clear(d);
    }
    for (uint32_t v = 0; v < 8; v++) {
        double x[3];
        for (uint32_t k = 0; k < 3; k++) {
            x[k] = v >> k & 1 ? high[k] : low[k];
            set_bit(&ret_cell->tight[v * ret_cell->words], 2 * k + (v >> k & 1));
        }
        ret_cell->point[v] = pir_plan_point_at(space, x);
        if (space->status == PIR_OK)
            pir_plan_box_add(space, ret_cell->point[v], ret_cell->low, ret_cell->high);
    }
}

bool pir_plan_cell_has(pir_plan_space *space, const pir_plan_cell *cell, uint32_t point) {
    for (uint32_t h = 0; h < cell->halves; h++)
        if (pir_plan_side(space, cell->half[h], point) > 0)
            return false;
    return cell->points > 0;
}

void pir_plan_cell_sides(pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t half, int *ret_least,
                         int *ret_most) {
    *ret_least = 1;
    *ret_most = -1;
    if (!pir_plan_grow(cutter->space, (void **)&cutter->side, &cutter->side_room, cell->points, sizeof(int8_t)))
        return;
    uint32_t own = cell->halves;
    for (uint32_t h = 0; h < cell->halves && own == cell->halves; h++)
        if (cell->half[h] >> 1 == half >> 1)
            own = h;
    for (uint32_t i = 0; i < cell->points; i++) {
        const bool on = own < cell->halves && bit_of(&cell->tight[i * cell->words], own);
        const int side = on ? 0 : pir_plan_side(cutter->space, half, cell->point[i]);
        cutter->side[i] = (int8_t)side;
        *ret_least = side < *ret_least ? side : *ret_least;
        *ret_most = side > *ret_most ? side : *ret_most;
    }
}

/* --- splits --- */

/* Whether two points are the ends of an edge. */
static bool is_edge(const pir_plan_cell *cell, uint32_t a, uint32_t b) {
    const uint64_t *of_a = &cell->tight[a * cell->words], *of_b = &cell->tight[b * cell->words];
    int shared = 0;
    for (uint32_t w = 0; w < cell->words; w++)
        shared += __builtin_popcountll(of_a[w] & of_b[w]);
    if (shared < cell->dimension - 1)
        return false;
    for (uint32_t c = 0; c < cell->points; c++) {
        if (c == a || c == b)
            continue;
        const uint64_t *of_c = &cell->tight[c * cell->words];
        bool has_all = true;
        for (uint32_t w = 0; w < cell->words && has_all; w++)
            has_all = !(of_a[w] & of_b[w] & ~of_c[w]);
        if (has_all)
            return false;
    }
    return true;
}

/* Makes the points where edges of the cell meet the plane; cutter->side is set. */
static void make_fresh(pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t half) {
    pir_plan_space *space = cutter->space;
    cutter->fresh_count = 0;
    for (uint32_t a = 0; a < cell->points; a++)
        for (uint32_t b = 0; b < cell->points && cutter->side[a] < 0; b++) {
            if (cutter->side[b] <= 0 || !is_edge(cell, a, b))
                continue;
            const uint32_t below = half & 1 ? b : a, above = half & 1 ? a : b;
            if (!pir_plan_grow(space, (void **)&cutter->fresh, &cutter->fresh_room, 3 * cutter->fresh_count + 3,
                               sizeof *cutter->fresh))
                return;
            uint32_t *fresh = &cutter->fresh[3 * cutter->fresh_count++];
            fresh[0] = pir_plan_point_between(space, half >> 1, cell->point[below], cell->point[above]);
            fresh[1] = a;
            fresh[2] = b;
            if (space->status != PIR_OK)
                return;
        }
}

/* How many points, those of `from` and fresh ones, are on the plane of the cell's half-space h. */
static uint32_t count_tight(const pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t kept, uint32_t h) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < kept; i++)
        count += bit_of(&cell->tight[cutter->from[i] * cell->words], h);
    for (uint32_t i = 0; i < cutter->fresh_count; i++)
        count += bit_of(&cell->tight[cutter->fresh[3 * i + 1] * cell->words], h) &&
                 bit_of(&cell->tight[cutter->fresh[3 * i + 2] * cell->words], h);
    return count;
}

/*
 * The child of the points listed in `from`, `kept` of them, and the fresh ones, of a dimension, with one more
 * half-space unless that is none. Of the others those stay that can have a facet: as many points as the dimension.
 */
static void make_child(pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t kept, uint32_t half, int dimension,
                       pir_plan_cell *child) {
    pir_plan_space *space = cutter->space;
    const uint32_t points = kept + cutter->fresh_count;
    const uint32_t least = dimension > 0 ? (uint32_t)dimension : 1;
    uint32_t halves = 0;
    *child = (pir_plan_cell){.dimension = -1};
    if (!pir_plan_grow(space, (void **)&cutter->kept, &cutter->kept_room, cell->halves + 1, sizeof *cutter->kept))
        return;
    for (uint32_t h = 0; h < cell->halves; h++)
        if (count_tight(cutter, cell, kept, h) >= least)
            cutter->kept[halves++] = h;
    const bool more = half != PIR_PLAN_NONE;
    if (!open_cell(space, points, halves + more, dimension, child))
        return;
    for (uint32_t i = 0; i < halves; i++)
        child->half[i] = cell->half[cutter->kept[i]];
    if (more)
        child->half[halves] = half;
    for (uint32_t i = 0; i < points; i++) {
        const uint32_t *fresh = i < kept ? NULL : &cutter->fresh[3 * (i - kept)];
        const uint64_t *a = &cell->tight[(fresh ? fresh[1] : cutter->from[i]) * cell->words];
        const uint64_t *b = fresh ? &cell->tight[fresh[2] * cell->words] : a;
        uint64_t *row = &child->tight[i * child->words];
        child->point[i] = fresh ? fresh[0] : cell->point[cutter->from[i]];
        for (uint32_t h = 0; h < halves; h++)
            if (bit_of(a, cutter->kept[h]) && bit_of(b, cutter->kept[h]))
                set_bit(row, h);
        if (more && (fresh || cutter->side[cutter->from[i]] == 0))
            set_bit(row, halves);
        pir_plan_box_add(space, child->point[i], child->low, child->high);
    }
}

/* Lists the points on a side of the plane, and on it. */
static uint32_t list_side(pir_plan_cutter *cutter, const pir_plan_cell *cell, int side) {
    uint32_t kept = 0;
    if (!pir_plan_grow(cutter->space, (void **)&cutter->from, &cutter->from_room, cell->points, sizeof *cutter->from))
        return 0;
    for (uint32_t i = 0; i < cell->points; i++)
        if (cutter->side[i] * side >= 0)
            cutter->from[kept++] = i;
    return kept;
}

void pir_plan_cell_split(pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t half, pir_plan_cell *ret_within,
                         pir_plan_cell *ret_beyond) {
    int least, most;
    *ret_within = *ret_beyond = (pir_plan_cell){.dimension = -1};
    pir_plan_cell_sides(cutter, cell, half, &least, &most);
    make_fresh(cutter, cell, half);
    if (cutter->space->status == PIR_OK)
        make_child(cutter, cell, list_side(cutter, cell, -1), half, cell->dimension, ret_within);
    if (cutter->space->status == PIR_OK)
        make_child(cutter, cell, list_side(cutter, cell, 1), half ^ 1, cell->dimension, ret_beyond);
}

/* The dimension of a face of a cell: of these points, which are its vertices. */
static int face_dimension(uint32_t points) {
    return points < 3 ? (int)points - 1 : 2;
}

void pir_plan_cell_clip(pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t half, pir_plan_cell *ret_cell) {
    int least, most;
    *ret_cell = (pir_plan_cell){.dimension = -1};
    if (cell->points == 0)
        return;
    pir_plan_cell_sides(cutter, cell, half, &least, &most);
    if (cutter->space->status != PIR_OK)
        return;
    cutter->fresh_count = 0;
    if (least < 0 && most > 0)
        make_fresh(cutter, cell, half);
    const uint32_t kept = list_side(cutter, cell, -1);
    if (cutter->space->status != PIR_OK || kept + cutter->fresh_count == 0)
        return;
    make_child(cutter, cell, kept, half, least < 0 ? cell->dimension : face_dimension(kept), ret_cell);
}

void pir_plan_cell_face(pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t half, pir_plan_cell *ret_face) {
    int least, most;
    *ret_face = (pir_plan_cell){.dimension = -1};
    pir_plan_cell_sides(cutter, cell, half, &least, &most);
    if (cutter->space->status != PIR_OK || most < 0)
        return;
    cutter->fresh_count = 0;
    const uint32_t kept = list_side(cutter, cell, 1);
    pir_plan_cell on, face;
    make_child(cutter, cell, kept, half, face_dimension(kept), &on);
    // the plane bounds it from both sides
    pir_plan_cell_clip(cutter, &on, half ^ 1, &face);
    pir_plan_cell_free(cutter->space, &on);
    *ret_face = face;
}

void pir_plan_cell_common(pir_plan_cutter *cutter, const pir_plan_cell *a, const pir_plan_cell *b,
                          pir_plan_cell *ret_cell) {
    pir_plan_space *space = cutter->space;
    pir_plan_cell now = {.dimension = -1};
    const pir_plan_cell *from = a;
    for (uint32_t h = 0; h < b->halves && space->status == PIR_OK && from->points > 0; h++) {
        int least, most;
        pir_plan_cell_sides(cutter, from, b->half[h], &least, &most);
        if (most <= 0 && from != a)
            continue;
        pir_plan_cell next;
        pir_plan_cell_clip(cutter, from, b->half[h], &next);
        if (from == &now)
            pir_plan_cell_free(space, &now);
        now = next;
        from = &now;
    }
    *ret_cell = now;
}

/* SPDX-License-Identifier: MIT */
/*
 * Two pieces A and B with a face in one plane, on opposite sides of it: their union is convex exactly when that face is
 * the same polygon for both, and A is below all other planes of B, and B below all others of A. For then the set U
 * below all those other planes is A on one side of the shared plane and B on the other. The larger the shared face, the
 * earlier a pair is tried.
 */
#include "solid/pieces/join_pieces.h"

#include <math.h>

#include "base/sort.h"
#include "solid/space/intern.h"

struct shared {
    uint32_t piece[2], face[2];
    double area;
};

struct piece_merge {
    pir_space *space;
    pir_cells *cells;
    pir_piece_list *pieces;
    uint32_t *into; /* per piece: what it was joined into, or itself */
    uint32_t into_room;
    struct slot {
        uint32_t half, piece, face;
    } * slot; /* every face of every piece */
    uint32_t *order, *work;
    uint32_t slot_count, slot_room, order_room, work_room;
    uint32_t *loop; /* scratch: corners round a face of a union */
    uint32_t loop_count, loop_room;
    struct shared *shared;
    uint32_t shared_count, shared_room;
};

static void intern_numbers(pir_cells *cells, const pir_piece_list *pieces) {
    pir_intern points, planes;
    pir_intern_init(&points, cells->space, 4);
    pir_intern_init(&planes, cells->space, 4);
    for (uint32_t i = 0; i < pieces->count; i++) {
        const pir_cell cell = cells->cell[pieces->cell[i]];
        for (uint32_t f = cell.first; f < cell.first + cell.count && cells->space->status == PIR_OK; f++) {
            pir_face *face = &cells->face[f];
            face->half = pir_intern_half(&planes, face->half);
            for (uint32_t k = face->first; k < face->first + face->count; k++)
                cells->corner[k] = pir_intern_point(&points, cells->corner[k]);
        }
    }
    pir_intern_finish(&points);
    pir_intern_finish(&planes);
}

/* Whether two faces in one plane, which face each other, are the same polygon. */
static bool same_polygon(const pir_cells *cells, const pir_face *a, const pir_face *b) {
    if (a->count != b->count)
        return false;
    uint32_t at = 0;
    while (at < b->count && cells->corner[b->first + at] != cells->corner[a->first])
        at++;
    for (uint32_t i = 0; i < a->count && at < b->count; i++)
        if (cells->corner[a->first + i] != cells->corner[b->first + (at + b->count - i) % b->count])
            return false;
    return at < b->count;
}

static double area_of(const pir_cells *cells, const pir_face *face) {
    double sum[3] = {0};
    for (uint32_t i = 0; i < face->count; i++) {
        const double *p = cells->space->point[cells->corner[face->first + i]].x;
        const double *q = cells->space->point[cells->corner[face->first + (i + 1) % face->count]].x;
        for (int k = 0; k < 3; k++)
            sum[k] += p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3];
    }
    return sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}

/* Whether all of piece `a` is on or below the planes of `b` but that of the shared face. */
static bool is_below(struct piece_merge *m, uint32_t a, uint32_t b, uint32_t shared) {
    const pir_cell from = m->cells->cell[a], to = m->cells->cell[b];
    for (uint32_t g = to.first; g < to.first + to.count; g++) {
        const uint32_t half = m->cells->face[g].half;
        for (uint32_t f = from.first; f < from.first + from.count && half >> 1 != shared; f++)
            for (uint32_t i = 0; i < m->cells->face[f].count; i++)
                if (pir_space_side(m->space, half, m->cells->corner[m->cells->face[f].first + i]) > 0)
                    return false;
    }
    return true;
}

/* --- the union --- */

/* The corner after `corner` in a face, or none. */
static uint32_t corner_after(const pir_cells *cells, const pir_face *face, uint32_t corner) {
    for (uint32_t i = 0; i < face->count; i++)
        if (cells->corner[face->first + i] == corner)
            return cells->corner[face->first + (i + 1 < face->count ? i + 1 : 0)];
    return PIR_SPACE_NONE;
}

/* The face of a cell in the plane of `half`, on its side, or NULL. */
static const pir_face *face_in(const pir_cells *cells, pir_cell cell, uint32_t half) {
    for (uint32_t f = cell.first; f < cell.first + cell.count; f++)
        if (cells->face[f].half == half)
            return &cells->face[f];
    return NULL;
}

/* Adds a face with the corners of the loop that are not straight. */
static void add_loop(struct piece_merge *m, uint32_t half) {
    const uint32_t *loop = m->loop, count = m->loop_count;
    pir_cells_begin_face(m->cells, half);
    for (uint32_t i = 0; i < count; i++)
        if (pir_space_turn(m->space, half, loop[i > 0 ? i - 1 : count - 1], loop[i], loop[i + 1 < count ? i + 1 : 0]) !=
            0)
            pir_cells_add_corner(m->cells, loop[i]);
}

static void push_loop(struct piece_merge *m, uint32_t point) {
    if (pir_space_grow(m->space, (void **)&m->loop, &m->loop_room, m->loop_count, sizeof *m->loop))
        m->loop[m->loop_count++] = point;
}

/* The loop round two faces of one plane that have a side in common, or just the first. */
static void add_union(struct piece_merge *m, pir_face a, const pir_face *other) {
    const pir_cells *cells = m->cells;
    const pir_face b = other ? *other : (pir_face){0};
    m->loop_count = 0;
    for (uint32_t i = 0; i < a.count; i++) {
        const uint32_t p = cells->corner[a.first + i], q = cells->corner[a.first + (i + 1 < a.count ? i + 1 : 0)];
        push_loop(m, p);
        if (!other || corner_after(cells, &b, q) != p)
            continue;
        // the side from p to q is shared: go round b from p to q instead
        uint32_t at = corner_after(cells, &b, p);
        for (uint32_t n = 0; n < b.count && at != q && at != PIR_SPACE_NONE; n++, at = corner_after(cells, &b, at))
            push_loop(m, at);
        if (at != q)
            pir_space_fault(m->space);
    }
    add_loop(m, a.half);
}

static uint32_t join(struct piece_merge *m, uint32_t a, uint32_t b, uint32_t shared) {
    pir_cells *cells = m->cells;
    const pir_cell from[2] = {cells->cell[a], cells->cell[b]};
    const uint32_t made = pir_cells_begin(cells);
    for (int k = 0; k < 2; k++)
        for (uint32_t f = from[k].first; f < from[k].first + from[k].count && m->space->status == PIR_OK; f++) {
            const pir_face face = cells->face[f];
            const pir_face *other = face_in(cells, from[1 - k], face.half);
            if (face.half >> 1 != shared && !(k == 1 && other))
                add_union(m, face, other);
        }
    return made;
}

/* --- the pairs --- */

static bool slot_before(void *context, uint32_t a, uint32_t b) {
    const struct piece_merge *m = context;
    return m->slot[a].half >> 1 < m->slot[b].half >> 1;
}

static bool shared_before(void *context, uint32_t a, uint32_t b) {
    const struct piece_merge *m = context;
    return m->shared[a].area > m->shared[b].area;
}

static void list_slots(struct piece_merge *m) {
    const pir_cells *cells = m->cells;
    m->slot_count = 0;
    for (uint32_t i = 0; i < m->pieces->count; i++) {
        const pir_cell cell = cells->cell[m->pieces->cell[i]];
        for (uint32_t f = cell.first; f < cell.first + cell.count; f++) {
            if (!pir_space_grow(m->space, (void **)&m->slot, &m->slot_room, m->slot_count, sizeof *m->slot))
                return;
            m->slot[m->slot_count++] = (struct slot){cells->face[f].half, i, f};
        }
    }
}

static bool sort(struct piece_merge *m, uint32_t count, bool (*before)(void *, uint32_t, uint32_t)) {
    if (!pir_space_grow(m->space, (void **)&m->order, &m->order_room, count, sizeof *m->order) ||
        !pir_space_grow(m->space, (void **)&m->work, &m->work_room, count, sizeof *m->work))
        return false;
    for (uint32_t i = 0; i < count; i++)
        m->order[i] = i;
    pir_sort(m->order, count, m->work, before, m);
    return true;
}

static void note_shared(struct piece_merge *m, const struct slot *a, const struct slot *b) {
    const pir_cells *cells = m->cells;
    if ((a->half ^ b->half) != 1 || !same_polygon(cells, &cells->face[a->face], &cells->face[b->face]))
        return;
    if (pir_space_grow(m->space, (void **)&m->shared, &m->shared_room, m->shared_count, sizeof *m->shared))
        m->shared[m->shared_count++] =
            (struct shared){{a->piece, b->piece}, {a->face, b->face}, area_of(cells, &cells->face[a->face])};
}

/* Finds the pairs of pieces with the same polygon for a face, by planes. */
static void list_shared(struct piece_merge *m) {
    m->shared_count = 0;
    list_slots(m);
    if (!sort(m, m->slot_count, slot_before))
        return;
    for (uint32_t i = 0, end; i < m->slot_count; i = end) {
        for (end = i + 1; end < m->slot_count && !slot_before(m, m->order[i], m->order[end]); end++)
            ;
        for (uint32_t k = i; k < end; k++)
            for (uint32_t l = k + 1; l < end; l++)
                note_shared(m, &m->slot[m->order[k]], &m->slot[m->order[l]]);
    }
}

/* Joins pairs that no earlier join of this round has changed; whether it joined any. */
static bool join_round(struct piece_merge *m) {
    bool joined = false;
    list_shared(m);
    if (!sort(m, m->shared_count, shared_before) ||
        !pir_space_grow(m->space, (void **)&m->into, &m->into_room, m->pieces->count, sizeof *m->into))
        return false;
    for (uint32_t i = 0; i < m->pieces->count; i++)
        m->into[i] = m->pieces->cell[i];
    for (uint32_t n = 0; n < m->shared_count && m->space->status == PIR_OK; n++) {
        const struct shared *shared = &m->shared[m->order[n]];
        const uint32_t a = shared->piece[0], b = shared->piece[1], plane = m->cells->face[shared->face[0]].half >> 1;
        if (m->into[a] != m->pieces->cell[a] || m->into[b] != m->pieces->cell[b] ||
            !is_below(m, m->into[a], m->into[b], plane) || !is_below(m, m->into[b], m->into[a], plane))
            continue;
        m->into[a] = join(m, m->into[a], m->into[b], plane);
        m->into[b] = PIR_SPACE_NONE;
        joined = true;
    }
    uint32_t count = 0;
    for (uint32_t i = 0; i < m->pieces->count; i++)
        if (m->into[i] != PIR_SPACE_NONE)
            m->pieces->cell[count++] = m->into[i];
    m->pieces->count = count;
    return joined;
}

void pir_merge_pieces(pir_cells *cells, pir_piece_list *pieces) {
    struct piece_merge m = {.space = cells->space, .cells = cells, .pieces = pieces};
    intern_numbers(cells, pieces);
    while (m.space->status == PIR_OK && join_round(&m))
        ;
    pir_space_shrink(m.space, m.into, m.into_room, sizeof *m.into);
    pir_space_shrink(m.space, m.slot, m.slot_room, sizeof *m.slot);
    pir_space_shrink(m.space, m.order, m.order_room, sizeof *m.order);
    pir_space_shrink(m.space, m.work, m.work_room, sizeof *m.work);
    pir_space_shrink(m.space, m.loop, m.loop_room, sizeof *m.loop);
    pir_space_shrink(m.space, m.shared, m.shared_room, sizeof *m.shared);
}

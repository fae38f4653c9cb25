/* SPDX-License-Identifier: MIT */
/*
 * See meeting.h. What two convex cells have in common is the hull of its extreme points: corners of one within the
 * other, and points where an edge of one passes through the plane of a face of the other within it.
 */
#include "solid/clash/meeting.h"

#include "solid/space/exact.h"
#include "solid/space/polygons.h"

/* --- polytopes --- */

static void init_three(mpq_t x[3]) {
    for (int k = 0; k < 3; k++)
        mpq_init(x[k]);
}

static void clear_three(mpq_t x[3]) {
    for (int k = 0; k < 3; k++)
        mpq_clear(x[k]);
}

void pir_meeting_scale(const pir_polytope *polytope, mpz_t scale) {
    mpq_t x[3];
    init_three(x);
    for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope); v++) {
        pir_polytope_vertex_exact(polytope, v, x);
        for (int k = 0; k < 3; k++)
            if (!mpz_divisible_p(scale, mpq_denref(x[k])))
                mpz_lcm(scale, scale, mpq_denref(x[k]));
    }
    clear_three(x);
}

/* A coordinate times the scale, which its denominator divides. */
static void scale_up(const mpq_t x, const mpz_t scale, mpz_t ret) {
    mpz_divexact(ret, scale, mpq_denref(x));
    mpz_mul(ret, ret, mpq_numref(x));
}

size_t pir_meeting_bits(const pir_polytope *polytope, const mpz_t scale) {
    mpq_t x[3];
    mpz_t number;
    size_t bits = 1;
    init_three(x);
    mpz_init(number);
    for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope); v++) {
        pir_polytope_vertex_exact(polytope, v, x);
        for (int k = 0; k < 3; k++) {
            scale_up(x[k], scale, number);
            const size_t own = mpz_sizeinbase(number, 2);
            bits = own > bits ? own : bits;
        }
    }
    mpz_clear(number);
    clear_three(x);
    return bits;
}

void pir_meeting_init(pir_cell_meeting *meeting, const pir_allocator *allocator, size_t limit, const mpz_t scale,
                      size_t bits) {
    *meeting = (pir_cell_meeting){0};
    pir_space_init(&meeting->space, allocator, limit, bits + 1);
    pir_cells_init(&meeting->cells, &meeting->space);
    mpz_init_set(meeting->scale, scale);
}

void pir_meeting_finish(pir_cell_meeting *meeting) {
    mpz_clear(meeting->scale);
    pir_space_shrink(&meeting->space, meeting->corner, meeting->corner_room, sizeof *meeting->corner);
    pir_cells_finish(&meeting->cells);
    pir_space_finish(&meeting->space);
}

/* Adds the vertices as points, one after the other; the first. */
static uint32_t add_points(pir_cell_meeting *m, const pir_polytope *polytope) {
    const uint32_t first = m->space.point_count;
    mpq_t x[3];
    mpz_t at[3], one;
    init_three(x);
    mpz_init_set_ui(one, 1);
    for (int k = 0; k < 3; k++)
        mpz_init(at[k]);
    for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope) && m->space.status == PIR_OK; v++) {
        pir_polytope_vertex_exact(polytope, v, x);
        for (int k = 0; k < 3; k++)
            scale_up(x[k], m->scale, at[k]);
        pir_space_add_point(&m->space, at[0], at[1], at[2], one);
    }
    for (int k = 0; k < 3; k++)
        mpz_clear(at[k]);
    mpz_clear(one);
    clear_three(x);
    return first;
}

uint32_t pir_meeting_add(pir_cell_meeting *m, const pir_polytope *polytope) {
    pir_space *space = &m->space;
    const uint32_t first = add_points(m, polytope), cell = pir_cells_begin(&m->cells);
    for (uint32_t f = 0; f < pir_polytope_facet_count(polytope) && space->status == PIR_OK; f++) {
        const uint32_t size = pir_polytope_facet_size(polytope, f);
        if (!pir_space_grow(space, (void **)&m->corner, &m->corner_room, size, sizeof *m->corner))
            return cell;
        pir_polytope_facet(polytope, f, m->corner);
        const uint32_t a = first + m->corner[0], b = first + m->corner[1], c = first + m->corner[2];
        const uint32_t sides[2] = {pir_polygons_direction(space, a, b), pir_polygons_direction(space, b, c)};
        const uint32_t plane = pir_space_add_plane(space, sides, false, (const uint32_t[]){a, PIR_SPACE_NONE});
        pir_cells_begin_face(&m->cells, pir_half(plane, false));
        for (uint32_t i = 0; i < size; i++)
            pir_cells_add_corner(&m->cells, first + m->corner[i]);
    }
    return cell;
}

/* --- two cells --- */

/* The corners of a cell stand in a row. */
static void corners_of(const pir_cells *cells, uint32_t cell, uint32_t *ret_first, uint32_t *ret_end) {
    const pir_cell own = cells->cell[cell];
    const pir_face *last = &cells->face[own.first + own.count - 1];
    *ret_first = cells->face[own.first].first;
    *ret_end = last->first + last->count;
}

/* Whether a face of one cell has all of the other above it, or `or_on` on it. */
static bool is_parted(pir_cell_meeting *m, uint32_t cell, uint32_t other, bool or_on) {
    const pir_cell own = m->cells.cell[cell];
    uint32_t first, end;
    corners_of(&m->cells, other, &first, &end);
    for (uint32_t f = own.first; f < own.first + own.count; f++) {
        bool above = true;
        for (uint32_t c = first; c < end && above; c++) {
            const int side = pir_space_side(&m->space, m->cells.face[f].half, m->cells.corner[c]);
            above = side > 0 || (or_on && side == 0);
        }
        if (above)
            return true;
    }
    return false;
}

static bool holds(pir_cell_meeting *m, uint32_t cell, uint32_t point) {
    const pir_cell own = m->cells.cell[cell];
    for (uint32_t f = own.first; f < own.first + own.count; f++)
        if (pir_space_side(&m->space, m->cells.face[f].half, point) > 0)
            return false;
    return true;
}

/* Whether two points are at one place: their numbers are in lowest terms. */
static bool is_same(pir_cell_meeting *m, uint32_t a, uint32_t b) {
    const uint32_t p = pir_space_exact_point(&m->space, a), q = pir_space_exact_point(&m->space, b);
    for (uint32_t k = 0; k < 4; k++)
        if (mpz_cmp(m->space.number[p + k], m->space.number[q + k]) != 0)
            return false;
    return true;
}

/* Notes a point that both cells have, once. */
static void note_common(pir_cell_meeting *m, uint32_t point) {
    for (uint32_t i = 0; i < m->common_count; i++)
        if (is_same(m, m->corner[i], point))
            return;
    if (pir_space_grow(&m->space, (void **)&m->corner, &m->corner_room, m->common_count, sizeof *m->corner))
        m->corner[m->common_count++] = point;
}

/* The face of a cell on the other side of the edge that leads from b to a in it. */
static uint32_t face_beside(const pir_cells *cells, pir_cell cell, uint32_t a, uint32_t b) {
    for (uint32_t f = cell.first; f < cell.first + cell.count; f++) {
        const pir_face face = cells->face[f];
        for (uint32_t i = 0; i < face.count; i++)
            if (cells->corner[face.first + i] == b && cells->corner[face.first + (i + 1) % face.count] == a)
                return f;
    }
    return cell.first;
}

/* Notes where the edge from a to b of a face of one cell passes through faces of the other. */
static void note_passes(pir_cell_meeting *m, uint32_t cell, uint32_t face, const uint32_t ends[2], uint32_t other) {
    const pir_cells *cells = &m->cells;
    const pir_cell to = cells->cell[other];
    for (uint32_t g = to.first; g < to.first + to.count && m->space.status == PIR_OK; g++) {
        const uint32_t half = cells->face[g].half;
        if (pir_space_side(&m->space, half, ends[0]) * pir_space_side(&m->space, half, ends[1]) >= 0)
            continue;
        const uint32_t beside = face_beside(cells, cells->cell[cell], ends[0], ends[1]);
        const uint32_t point =
            pir_space_add_meet(&m->space, cells->face[face].half >> 1, cells->face[beside].half >> 1, half >> 1);
        if (holds(m, other, point))
            note_common(m, point);
    }
}

/* Notes the extreme points that are on edges of one cell. */
static void note_edges(pir_cell_meeting *m, uint32_t cell, uint32_t other) {
    const pir_cell own = m->cells.cell[cell];
    for (uint32_t f = own.first; f < own.first + own.count; f++) {
        const pir_face face = m->cells.face[f];
        for (uint32_t i = 0; i < face.count && m->space.status == PIR_OK; i++) {
            const uint32_t a = m->cells.corner[face.first + i];
            const uint32_t b = m->cells.corner[face.first + (i + 1) % face.count];
            if (holds(m, other, a))
                note_common(m, a);
            if (a < b)
                note_passes(m, cell, f, (const uint32_t[]){a, b}, other);
        }
    }
}

/* Whether three points are on one line. */
static bool is_line(pir_cell_meeting *m, uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t ways[2] = {pir_polygons_direction(&m->space, a, b), pir_polygons_direction(&m->space, a, c)};
    const uint32_t first = m->space.direction[ways[0]].exact, second = m->space.direction[ways[1]].exact;
    mpz_t *n = m->space.number, *cross = m->space.t;
    if (m->space.status != PIR_OK)
        return true;
    pir_numbers_cross(cross, n + first, n + second);
    return mpz_sgn(cross[0]) == 0 && mpz_sgn(cross[1]) == 0 && mpz_sgn(cross[2]) == 0;
}

int pir_meeting_common(pir_cell_meeting *m, uint32_t a, uint32_t b) {
    m->common_count = 0;
    if (is_parted(m, a, b, false) || is_parted(m, b, a, false))
        return -1;
    note_edges(m, a, b);
    note_edges(m, b, a);
    const uint32_t *x = m->corner, count = m->common_count;
    if (count < 2)
        return (int)count - 1;
    uint32_t third = 2, fourth = 3;
    while (third < count && is_line(m, x[0], x[1], x[third]))
        third++;
    if (third == count)
        return 1;
    for (fourth = third + 1; fourth < count; fourth++)
        if (pir_space_orient(&m->space, x[0], x[1], x[third], x[fourth]) != 0)
            return 3;
    return 2;
}

/* --- taking away --- */

uint32_t pir_meeting_take(pir_cell_meeting *m, uint32_t cell, uint32_t by, pir_piece_list *left) {
    const uint32_t kept = left->count, whole = cell;
    if (is_parted(m, by, cell, true) || is_parted(m, cell, by, true)) {
        pir_piece_list_add(left, &m->space, cell);
        return PIR_SPACE_NONE;
    }
    const pir_cell planes = m->cells.cell[by];
    for (uint32_t f = planes.first; f < planes.first + planes.count && cell != PIR_SPACE_NONE; f++) {
        uint32_t parts[2] = {PIR_SPACE_NONE, PIR_SPACE_NONE};
        pir_cells_cut(&m->cells, cell, m->cells.face[f].half, parts);
        if (parts[1] != PIR_SPACE_NONE)
            pir_piece_list_add(left, &m->space, parts[1]);
        cell = m->space.status == PIR_OK ? parts[0] : PIR_SPACE_NONE;
    }
    if (cell == PIR_SPACE_NONE) {
        // nothing is taken: the cell stays whole
        left->count = kept;
        pir_piece_list_add(left, &m->space, whole);
    }
    return cell;
}

void pir_meeting_take_all(pir_cell_meeting *m, pir_piece_list *list, pir_piece_list *other, uint32_t by,
                          mpq_ptr taken) {
    other->count = 0;
    for (uint32_t i = 0; i < list->count && m->space.status == PIR_OK; i++) {
        const uint32_t common = pir_meeting_take(m, list->cell[i], by, other);
        if (common != PIR_SPACE_NONE && taken)
            pir_meeting_add_volume(m, common, taken);
    }
    const pir_piece_list swap = *list;
    *list = *other;
    *other = swap;
}

/* --- volumes --- */

/* A point's coordinates in the space. */
static void rational_of(pir_cell_meeting *m, uint32_t point, mpq_t x[3]) {
    const uint32_t exact = pir_space_exact_point(&m->space, point);
    for (uint32_t k = 0; k < 3; k++) {
        mpz_set(mpq_numref(x[k]), m->space.number[exact + k]);
        mpz_set(mpq_denref(x[k]), m->space.number[exact + 3]);
        mpq_canonicalize(x[k]);
    }
}

/* Adds a · (b × c). */
static void add_product(mpq_t x[3][3], mpq_t sum) {
    mpq_t term, other;
    mpq_inits(term, other, NULL);
    for (int k = 0; k < 3; k++) {
        mpq_mul(term, x[1][(k + 1) % 3], x[2][(k + 2) % 3]);
        mpq_mul(other, x[1][(k + 2) % 3], x[2][(k + 1) % 3]);
        mpq_sub(term, term, other);
        mpq_mul(term, term, x[0][k]);
        mpq_add(sum, sum, term);
    }
    mpq_clears(term, other, NULL);
}

void pir_meeting_add_volume(pir_cell_meeting *m, uint32_t cell, mpq_t volume) {
    const pir_cell own = m->cells.cell[cell];
    mpq_t x[3][3], sum, unit;
    mpq_inits(sum, unit, NULL);
    for (int k = 0; k < 3; k++)
        init_three(x[k]);
    for (uint32_t f = own.first; f < own.first + own.count; f++) {
        const pir_face face = m->cells.face[f];
        rational_of(m, m->cells.corner[face.first], x[0]);
        for (uint32_t i = 1; i + 1 < face.count && m->space.status == PIR_OK; i++) {
            rational_of(m, m->cells.corner[face.first + i], x[1]);
            rational_of(m, m->cells.corner[face.first + i + 1], x[2]);
            add_product(x, sum);
        }
    }
    // six volumes, times the cube of the scale
    mpz_pow_ui(mpq_denref(unit), m->scale, 3);
    mpz_mul_ui(mpq_denref(unit), mpq_denref(unit), 6);
    mpz_set_ui(mpq_numref(unit), 1);
    mpq_mul(sum, sum, unit);
    mpq_add(volume, volume, sum);
    for (int k = 0; k < 3; k++)
        clear_three(x[k]);
    mpq_clears(sum, unit, NULL);
}

/* SPDX-License-Identifier: MIT */
/*
 * See cells.h. A plane that passes through the inside of a cell leaves of each face the corners on one side and in the
 * plane, and the points where its edges pass through. The sides that the faces then have in the plane, reversed, are
 * those of the new face.
 */
#include "solid/pieces/cells.h"

void pir_cells_init(pir_cells *cells, pir_space *space) {
    *cells = (pir_cells){.space = space};
}

void pir_cells_finish(pir_cells *cells) {
    if (!cells->space)
        return;
    pir_space_shrink(cells->space, cells->cell, cells->cell_room, sizeof *cells->cell);
    pir_space_shrink(cells->space, cells->face, cells->face_room, sizeof *cells->face);
    pir_space_shrink(cells->space, cells->corner, cells->corner_room, sizeof *cells->corner);
    pir_space_shrink(cells->space, cells->cut, cells->cut_room, sizeof *cells->cut);
    pir_space_shrink(cells->space, cells->side, cells->side_room, sizeof *cells->side);
    *cells = (pir_cells){0};
}

uint32_t pir_cells_begin(pir_cells *cells) {
    if (!pir_space_grow(cells->space, (void **)&cells->cell, &cells->cell_room, cells->count, sizeof *cells->cell))
        return 0;
    cells->cell[cells->count] = (pir_cell){cells->face_count, 0};
    return cells->count++;
}

void pir_cells_begin_face(pir_cells *cells, uint32_t half) {
    if (!pir_space_grow(cells->space, (void **)&cells->face, &cells->face_room, cells->face_count, sizeof *cells->face))
        return;
    cells->face[cells->face_count++] = (pir_face){half, cells->corner_count, 0};
    cells->cell[cells->count - 1].count++;
}

void pir_cells_add_corner(pir_cells *cells, uint32_t point) {
    if (!pir_space_grow(cells->space, (void **)&cells->corner, &cells->corner_room, cells->corner_count,
                        sizeof *cells->corner))
        return;
    cells->corner[cells->corner_count++] = point;
    cells->face[cells->face_count - 1].count++;
}

/* The corners of the box are at ±2^(shift − 1) and a little more, so that they are beyond all points. */
uint32_t pir_cells_add_box(pir_cells *cells) {
    static const uint8_t loop[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    pir_space *space = cells->space;
    mpz_t far[2], one, zero;
    mpz_init_set_ui(one, 1);
    mpz_init(zero);
    for (int k = 0; k < 2; k++) {
        mpz_init_set_ui(far[k], 3);
        mpz_mul_2exp(far[k], far[k], (mp_bitcnt_t)(space->shift > 2 ? space->shift - 2 : 0));
    }
    mpz_neg(far[0], far[0]);
    uint32_t corner[8], plane[6];
    for (int i = 0; i < 8; i++)
        corner[i] = pir_space_add_point(space, far[i & 1], far[i >> 1 & 1], far[i >> 2], one);
    for (int f = 0; f < 6; f++) {
        const uint32_t axis =
            pir_space_add_direction(space, f / 2 == 0 ? one : zero, f / 2 == 1 ? one : zero, f / 2 == 2 ? one : zero);
        plane[f] = pir_space_add_plane(space, (const uint32_t[]){axis, PIR_SPACE_NONE}, f % 2 == 0,
                                       (const uint32_t[]){corner[loop[f][0]], PIR_SPACE_NONE});
    }
    const uint32_t box = pir_cells_begin(cells);
    for (int f = 0; f < 6; f++) {
        pir_cells_begin_face(cells, pir_half(plane[f], false));
        for (int i = 0; i < 4; i++)
            pir_cells_add_corner(cells, corner[loop[f][i]]);
    }
    mpz_clears(far[0], far[1], one, zero, NULL);
    return box;
}

/* Where the edge from a to b of faces f and g meets the plane of `half`: one point for both its faces. */
static uint32_t cut_edge(pir_cells *cells, const uint32_t ends[2], const uint32_t planes[3]) {
    const uint32_t a = ends[0] < ends[1] ? ends[0] : ends[1], b = ends[0] < ends[1] ? ends[1] : ends[0];
    for (uint32_t i = 0; i < cells->cut_count; i++)
        if (cells->cut[i].a == a && cells->cut[i].b == b)
            return cells->cut[i].point;
    if (!pir_space_grow(cells->space, (void **)&cells->cut, &cells->cut_room, cells->cut_count, sizeof *cells->cut))
        return 0;
    const uint32_t point = pir_space_add_meet(cells->space, planes[0], planes[1], planes[2]);
    cells->cut[cells->cut_count++] = (struct pir_cell_cut){a, b, point};
    return point;
}

/* The plane of the cell's other face at the edge from a to b of face `own`. */
static uint32_t plane_beside(pir_cells *cells, pir_cell cell, uint32_t own, uint32_t a, uint32_t b) {
    for (uint32_t f = cell.first; f < cell.first + cell.count; f++) {
        const pir_face *face = &cells->face[f];
        if (f == own)
            continue;
        for (uint32_t i = 0; i < face->count; i++)
            if (cells->corner[face->first + i] == b &&
                cells->corner[face->first + (i + 1 < face->count ? i + 1 : 0)] == a)
                return face->half >> 1;
    }
    pir_space_fault(cells->space);
    return 0;
}

/* Adds what is left of a face on the side where `keep` times the sign of its corners is not above 0. */
static void cut_face(pir_cells *cells, pir_cell cell, uint32_t f, uint32_t half, int keep) {
    pir_space *space = cells->space;
    const pir_face face = cells->face[f];
    bool has_inner = false;
    for (uint32_t i = 0; i < face.count; i++)
        has_inner = has_inner || keep * pir_space_side(space, half, cells->corner[face.first + i]) < 0;
    if (!has_inner)
        return;
    pir_cells_begin_face(cells, face.half);
    uint32_t on[2] = {PIR_SPACE_NONE, PIR_SPACE_NONE}; // where the loop leaves the side, where it comes back
    for (uint32_t i = 0; i < face.count && space->status == PIR_OK; i++) {
        const uint32_t a = cells->corner[face.first + i];
        const uint32_t b = cells->corner[face.first + (i + 1 < face.count ? i + 1 : 0)];
        const int at = keep * pir_space_side(space, half, a), to = keep * pir_space_side(space, half, b);
        if (at <= 0)
            pir_cells_add_corner(cells, a);
        if (at == 0 && to >= 0)
            on[0] = a;
        if (to == 0 && at >= 0)
            on[1] = b;
        if (at * to >= 0)
            continue;
        const uint32_t beside = plane_beside(cells, cell, f, a, b);
        const uint32_t point =
            cut_edge(cells, (const uint32_t[]){a, b}, (const uint32_t[]){face.half >> 1, beside, half >> 1});
        pir_cells_add_corner(cells, point);
        on[at > 0] = point;
    }
    if (on[0] == PIR_SPACE_NONE || on[1] == PIR_SPACE_NONE || on[0] == on[1])
        return;
    if (pir_space_grow(space, (void **)&cells->side, &cells->side_room, cells->side_count, sizeof *cells->side))
        cells->side[cells->side_count++] = (struct pir_cell_side){on[1], on[0]};
}

/* The part of a cell on one side of a plane through its inside. */
static uint32_t cut_side(pir_cells *cells, uint32_t cell, uint32_t half, int keep) {
    const pir_cell from = cells->cell[cell];
    const uint32_t made = pir_cells_begin(cells);
    cells->side_count = 0;
    for (uint32_t f = from.first; f < from.first + from.count && cells->space->status == PIR_OK; f++)
        cut_face(cells, from, f, half, keep);
    pir_cells_begin_face(cells, keep > 0 ? half : half ^ 1);
    const uint32_t start = cells->side_count ? cells->side[0].from : 0;
    uint32_t at = start;
    for (uint32_t n = 0; n < cells->side_count && cells->space->status == PIR_OK; n++) {
        uint32_t i = 0;
        pir_cells_add_corner(cells, at);
        while (i < cells->side_count && cells->side[i].from != at)
            i++;
        if (i == cells->side_count || (n > 0 && at == start))
            pir_space_fault(cells->space);
        else
            at = cells->side[i].to;
    }
    if (cells->side_count < 3 || at != start)
        pir_space_fault(cells->space);
    return made;
}

void pir_cells_cut(pir_cells *cells, uint32_t cell, uint32_t half, uint32_t ret_parts[2]) {
    const pir_cell from = cells->cell[cell];
    bool below = false, above = false;
    for (uint32_t f = from.first; f < from.first + from.count && !(below && above); f++)
        for (uint32_t i = 0; i < cells->face[f].count; i++) {
            const int side = pir_space_side(cells->space, half, cells->corner[cells->face[f].first + i]);
            below = below || side < 0;
            above = above || side > 0;
        }
    ret_parts[0] = below ? cell : PIR_SPACE_NONE;
    ret_parts[1] = above ? cell : PIR_SPACE_NONE;
    if (!below || !above || cells->space->status != PIR_OK)
        return;
    cells->cut_count = 0;
    ret_parts[0] = cut_side(cells, cell, half, 1);
    ret_parts[1] = cut_side(cells, cell, half, -1);
}

/* SPDX-License-Identifier: MIT */
/* See wide_pieces.h. */
#include "plan/rigid/wide_pieces.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "plan/plan_cell.h"

#define SHRUNK      0x1p-40 /* how far corners are moved to the middle, of the way */
#define SAME        1e-9    /* of the size: how far a piece may be beyond another that stands for it */
#define MOST_SPLITS 2000    /* of one proof */
#define EVEN        1e-13   /* of the size: how far corners may be from what is even */
#define MOST_EVEN   4096    /* corners of pieces that are made even */

struct widener {
    pir_plan_space space;
    pir_plan_cutter cutter;
    pir_plan_sums sums; /* the pieces, then hulls of bodies */
    uint32_t pieces, splits;
};

/* Whether pieces from one on have all of a cell, which is freed. */
static bool is_covered(struct widener *w, pir_plan_cell *cell, uint32_t from) {
    bool covered = false, is_open = cell->dimension == 3;
    for (uint32_t i = from; i < w->pieces && is_open && w->space.status == PIR_OK; i++) {
        const pir_plan_sum *own = &w->sums.sum[i];
        if (!pir_plan_boxes_meet(cell->low, cell->high, own->low, own->high))
            continue;
        bool is_apart = false;
        covered = true;
        for (uint32_t h = 0; h < own->halves && covered && !is_apart && w->space.status == PIR_OK; h++) {
            int least, most;
            const uint32_t half = w->sums.half[own->half + h];
            pir_plan_cell_sides(&w->cutter, cell, half, &least, &most);
            is_apart = least >= 0;
            if (is_apart || most <= 0)
                continue;
            pir_plan_cell part[2];
            covered = ++w->splits <= MOST_SPLITS;
            pir_plan_cell_split(&w->cutter, cell, half, &part[0], &part[1]);
            pir_plan_cell_free(&w->space, cell);
            *cell = part[0];
            if (covered && w->space.status == PIR_OK)
                covered = is_covered(w, &part[1], i + 1);
            else
                pir_plan_cell_free(&w->space, &part[1]);
        }
        is_open = is_apart && covered;
        covered = covered && !is_apart;
    }
    covered = covered || cell->dimension < 3;
    pir_plan_cell_free(&w->space, cell);
    return covered && w->space.status == PIR_OK;
}

/* Takes from a cell what is beyond half-spaces of a sum, but for those that are left out. */
static void clip(struct widener *w, const pir_plan_sum *by, const bool *left_out, pir_plan_cell *cell) {
    for (uint32_t h = 0; h < by->halves && w->space.status == PIR_OK; h++) {
        if (left_out && left_out[h])
            continue;
        pir_plan_cell next;
        pir_plan_cell_clip(&w->cutter, cell, w->sums.half[by->half + h], &next);
        pir_plan_cell_free(&w->space, cell);
        *cell = next;
    }
}

/* The part of a hull within the half-spaces of a piece, but for those that are left out. */
static pir_plan_cell cell_of(struct widener *w, const pir_plan_sum *hull, const pir_plan_sum *piece,
                             const bool *left_out) {
    pir_plan_cell cell;
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = hull->low[k] - 1;
        high[k] = hull->high[k] + 1;
    }
    pir_plan_cell_box(&w->cutter, low, high, &cell);
    clip(w, hull, NULL, &cell);
    if (piece)
        clip(w, piece, left_out, &cell);
    return cell;
}

/* Whether the pieces have a polytope, which is proven. */
static pir_status prove_covered(struct widener *w, const pir_polytope *made, bool *ret_covered) {
    const uint32_t number = w->sums.count;
    const pir_status status = pir_plan_sums_add(&w->space, made, 0, 0, &w->sums);
    *ret_covered = false;
    if (status != PIR_OK)
        return status;
    pir_plan_cell own = cell_of(w, &w->sums.sum[number], NULL, NULL);
    w->splits = 0;
    *ret_covered = is_covered(w, &own, 0);
    return w->space.status;
}

/* A polytope within a cell, proven to be in the pieces; NULL where it is not. */
static pir_status round_cell(struct widener *w, const pir_plan_cell *cell, pir_polytope **ret_made) {
    pir_vec3 *x = pir_plan_new(&w->space, cell->points, sizeof *x), middle = {0, 0, 0};
    pir_polytope *made = NULL;
    *ret_made = NULL;
    if (!x)
        return w->space.status;
    for (uint32_t v = 0; v < cell->points; v++) {
        const double *at = pir_plan_point_exact(&w->space, cell->point[v])->at;
        x[v] = (pir_vec3){at[0], at[1], at[2]};
        middle.x += at[0] / cell->points;
        middle.y += at[1] / cell->points;
        middle.z += at[2] / cell->points;
    }
    for (uint32_t v = 0; v < cell->points; v++)
        x[v] = (pir_vec3){x[v].x + SHRUNK * (middle.x - x[v].x), x[v].y + SHRUNK * (middle.y - x[v].y),
                          x[v].z + SHRUNK * (middle.z - x[v].z)};
    pir_status status = pir_polytope_create(x, cell->points, NULL, &made);
    pir_plan_free(&w->space, x, cell->points, sizeof *x);
    if (status == PIR_OK && pir_polytope_dimension(made) == 3) {
        bool covered;
        status = prove_covered(w, made, &covered);
        if (covered) {
            *ret_made = made;
            made = NULL;
        }
    }
    pir_polytope_release(made);
    return status;
}

/* The widest piece that a piece of a body with a hull makes, or the piece. */
static pir_status widen(struct widener *w, uint32_t piece, uint32_t hull, pir_polytope *own, pir_polytope **ret_wide) {
    const uint32_t halves = w->sums.sum[piece].halves;
    bool *left_out = pir_plan_new(&w->space, halves, sizeof *left_out), any = false;
    pir_status status = w->space.status;
    for (uint32_t h = 0; h < halves && status == PIR_OK; h++) {
        left_out[h] = true;
        pir_plan_cell cell = cell_of(w, &w->sums.sum[hull], &w->sums.sum[piece], left_out);
        w->splits = 0;
        left_out[h] = is_covered(w, &cell, 0);
        any = any || left_out[h];
        status = w->space.status;
    }
    *ret_wide = NULL;
    if (status == PIR_OK && any) {
        pir_plan_cell cell = cell_of(w, &w->sums.sum[hull], &w->sums.sum[piece], left_out);
        status = w->space.status == PIR_OK ? round_cell(w, &cell, ret_wide) : w->space.status;
        pir_plan_cell_free(&w->space, &cell);
    }
    if (status == PIR_OK && !*ret_wide)
        *ret_wide = pir_polytope_retain(own);
    pir_plan_free(&w->space, left_out, halves, sizeof *left_out);
    return status;
}

/* Whether a polytope is in another, nearly. */
static bool is_in(struct widener *w, const pir_polytope *a, const pir_polytope *b) {
    double size = 0;
    const uint32_t corners = pir_polytope_vertex_count(b);
    uint32_t *corner = pir_plan_new(&w->space, corners, sizeof *corner);
    bool has = corner != NULL;
    for (uint32_t v = 0; v < corners; v++) {
        const pir_vec3 x = pir_polytope_vertex(b, v);
        size = fmax(size, fabs(x.x) + fabs(x.y) + fabs(x.z));
    }
    for (uint32_t f = 0; f < pir_polytope_facet_count(b) && has; f++) {
        const pir_vec3 n = pir_polytope_normal(b, f);
        pir_polytope_facet(b, f, corner);
        const pir_vec3 on = pir_polytope_vertex(b, corner[0]);
        for (uint32_t v = 0; v < pir_polytope_vertex_count(a) && has; v++) {
            const pir_vec3 x = pir_polytope_vertex(a, v);
            has = n.x * (x.x - on.x) + n.y * (x.y - on.y) + n.z * (x.z - on.z) <= SAME * size;
        }
    }
    pir_plan_free(&w->space, corner, corners, sizeof *corner);
    return has;
}

/* The hull of all pieces of a body. */
static pir_status add_hull(struct widener *w, const pir_plan_pieces *pieces, uint32_t body) {
    size_t room = 0, count = 0;
    for (uint32_t i = 0; i < pieces->count; i++)
        room += pir_polytope_vertex_count(pieces->at[i]);
    pir_vec3 *x = pir_plan_new(&w->space, room, sizeof *x);
    pir_polytope *hull = NULL;
    for (uint32_t i = 0; i < pieces->count && x; i++)
        for (uint32_t v = 0; v < pir_polytope_vertex_count(pieces->at[i]) && pieces->body[i] == body; v++)
            x[count++] = pir_polytope_vertex(pieces->at[i], v);
    pir_status status = x ? pir_polytope_create(x, count, NULL, &hull) : w->space.status;
    if (status == PIR_OK)
        status = pir_plan_sums_add(&w->space, hull, 0, 0, &w->sums);
    pir_polytope_release(hull);
    pir_plan_free(&w->space, x, room, sizeof *x);
    return status;
}

static pir_status make_all(struct widener *w, const pir_plan_pieces *pieces, pir_plan_pieces *wide) {
    pir_status status = w->space.status;
    for (uint32_t i = 0; i < pieces->count && status == PIR_OK; i++)
        status = pir_plan_sums_add(&w->space, pieces->at[i], 0, 0, &w->sums);
    for (uint32_t i = 0, hull = 0; i < pieces->count && status == PIR_OK; i++) {
        pir_polytope *made;
        if (i == 0 || pieces->body[i] != pieces->body[i - 1]) {
            hull = w->sums.count;
            status = add_hull(w, pieces, pieces->body[i]);
        }
        if (status == PIR_OK)
            status = widen(w, i, hull, pieces->at[i], &made);
        if (status != PIR_OK)
            return status;
        bool is_told = false;
        for (uint32_t k = 0; k < wide->count && !is_told; k++)
            is_told = is_in(w, made, wide->at[k]);
        if (is_told) {
            pir_polytope_release(made);
        } else {
            wide->body[wide->count] = pieces->body[i];
            wide->at[wide->count++] = made;
        }
    }
    return status == PIR_OK ? w->space.status : status;
}

/* --- even pieces --- */

static bool are_near(pir_vec3 a, pir_vec3 b, double room) {
    return fabs(a.x - b.x) <= room && fabs(a.y - b.y) <= room && fabs(a.z - b.z) <= room;
}

static pir_vec3 with_signs(pir_vec3 a, uint32_t signs) {
    return (pir_vec3){signs & 1 ? -a.x : a.x, signs & 2 ? -a.y : a.y, signs & 4 ? -a.z : a.z};
}

static double without_noise(double x, double room) {
    return fabs(x) <= room ? 0 : x;
}

/* Whether signs map each corner nearly to one. */
static bool maps_corners(const pir_vec3 *x, uint32_t count, uint32_t signs, double room) {
    bool all = true;
    for (uint32_t i = 0; i < count && all; i++) {
        all = false;
        for (uint32_t k = 0; k < count && !all; k++)
            all = are_near(x[k], with_signs(x[i], signs), room);
    }
    return all;
}

/* Moves corners, so that what signs nearly map to each other they do map; false where no signs do. */
static bool make_even(pir_vec3 *x, uint32_t count, bool *is_done) {
    double size = 0;
    bool maps[8] = {true}, any = false;
    for (uint32_t i = 0; i < count; i++)
        size = fmax(size, fmax(fabs(x[i].x), fmax(fabs(x[i].y), fabs(x[i].z))));
    const double room = size * EVEN;
    for (uint32_t signs = 1; signs < 8; signs++) {
        maps[signs] = maps_corners(x, count, signs, room);
        any = any || maps[signs];
    }
    for (uint32_t i = 0; i < count && any; i++) {
        const pir_vec3 from = x[i],
                       to = {without_noise(from.x, room), without_noise(from.y, room), without_noise(from.z, room)};
        for (uint32_t signs = 0; signs < 8 && !is_done[i]; signs++)
            for (uint32_t k = i; k < count && maps[signs]; k++)
                if (k != i && !is_done[k] && are_near(x[k], with_signs(from, signs), room)) {
                    x[k] = with_signs(to, signs);
                    is_done[k] = true;
                }
        if (!is_done[i])
            x[i] = to;
        is_done[i] = true;
    }
    return any;
}

/* Has pieces that signs nearly map to each other be images, where that keeps them in the union. */
static pir_status even_out(struct widener *w, pir_plan_pieces *wide) {
    uint32_t corners = 0;
    for (uint32_t i = 0; i < wide->count; i++)
        corners += pir_polytope_vertex_count(wide->at[i]);
    if (corners > MOST_EVEN)
        return PIR_OK;
    pir_vec3 *x = pir_plan_new(&w->space, corners, sizeof *x);
    bool *is_done = pir_plan_new(&w->space, corners, sizeof *is_done);
    pir_polytope **made = pir_plan_new(&w->space, wide->count, sizeof *made);
    pir_status status = w->space.status;
    for (uint32_t i = 0, c = 0; i < wide->count && status == PIR_OK; i++)
        for (uint32_t v = 0; v < pir_polytope_vertex_count(wide->at[i]); v++)
            x[c++] = pir_polytope_vertex(wide->at[i], v);
    bool good = status == PIR_OK && make_even(x, corners, is_done);
    for (uint32_t i = 0, c = 0; i < wide->count && good; i++) {
        const uint32_t count = pir_polytope_vertex_count(wide->at[i]);
        status = pir_polytope_create(x + c, count, NULL, &made[i]);
        good = status == PIR_OK && pir_polytope_dimension(made[i]) == 3;
        if (good)
            status = prove_covered(w, made[i], &good);
        c += count;
    }
    for (uint32_t i = 0; i < wide->count && made; i++) {
        pir_polytope *old = good ? wide->at[i] : made[i];
        wide->at[i] = good ? made[i] : wide->at[i];
        pir_polytope_release(old);
    }
    pir_plan_free(&w->space, x, corners, sizeof *x);
    pir_plan_free(&w->space, is_done, corners, sizeof *is_done);
    pir_plan_free(&w->space, made, wide->count, sizeof *made);
    return status;
}

pir_status pir_wide_pieces_make(const pir_plan_pieces *pieces, size_t memory, pir_plan_pieces *ret_wide) {
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    struct widener w = {.pieces = pieces->count};
    *ret_wide = (pir_plan_pieces){.at = calloc(pieces->count, sizeof *ret_wide->at),
                                  .body = calloc(pieces->count, sizeof *ret_wide->body)};
    pir_plan_space_init(&w.space, &allocator, memory);
    w.cutter.space = &w.space;
    pir_status status = ret_wide->at && ret_wide->body ? make_all(&w, pieces, ret_wide) : PIR_ERR_MEMORY;
    if (status == PIR_OK)
        status = even_out(&w, ret_wide);
    pir_plan_sums_finish(&w.space, &w.sums);
    pir_plan_cutter_finish(&w.cutter);
    pir_plan_space_finish(&w.space);
    return status;
}

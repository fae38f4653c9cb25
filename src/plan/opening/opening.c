/* SPDX-License-Identifier: MIT */
/* See opening.h. */
#include "plan/opening/opening.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plan/opening/opening_write.h"

/* How many directions, heights along one of them, and pieces that have to pass a wall, are tried. */
#define MOST_WAYS    32
#define MOST_HEIGHTS 8
#define MOST_PASSING 4
/* Cells for a first trial, by which walls that let a piece through are mostly known. */
#define FIRST (1u << 15)

/* A wall and a piece that has to pass it, of which a first trial said nothing. */
struct wall_doubt {
    double n[3], d;
    uint32_t piece;
};

struct opening_search {
    const pir_plan_asked *question;
    const pir_opening_budget *how;
    pir_opening_parts parts;
    double way[MOST_WAYS][3];
    uint32_t ways;
    struct wall_doubt doubt[MOST_WAYS * MOST_HEIGHTS * MOST_PASSING];
    uint32_t doubts, left; /* cells that may be made yet */
    FILE *proof;
    pir_opening_result *result;
};

/* --- which planes are tried --- */

static void add_way(struct opening_search *t, pir_vec3 normal) {
    const double n[3] = {normal.x, normal.y, normal.z};
    for (uint32_t i = 0; i < t->ways; i++) {
        const double *w = t->way[i];
        if (fabs(fabs(n[0] * w[0] + n[1] * w[1] + n[2] * w[2]) - 1) < 0x1p-40)
            return;
    }
    if (t->ways < MOST_WAYS)
        memcpy(t->way[t->ways++], n, sizeof n);
}

static void list_ways(struct opening_search *t) {
    const pir_plan_pieces *obstacles = t->question->obstacles;
    for (uint32_t i = 0; i < obstacles->count; i++)
        for (uint32_t f = 0; f < pir_polytope_facet_count(obstacles->at[i]); f++)
            add_way(t, pir_polytope_normal(obstacles->at[i], f));
}

/* The range of heights of a body. */
static void heights_of(const pir_opening_body *body, const double n[3], double ret[2]) {
    ret[0] = INFINITY;
    ret[1] = -INFINITY;
    for (uint32_t v = 0; v < body->vertices; v++) {
        const double h = pir_opening_height(body, v, n);
        ret[0] = fmin(ret[0], h);
        ret[1] = fmax(ret[1], h);
    }
}

/* Where the heights of a piece begin, or end; how many are more, or fewer, above. */
struct height_end {
    double at;
    int step;
};

static int by_height(const void *a, const void *b) {
    const double x = ((const struct height_end *)a)->at, y = ((const struct height_end *)b)->at;
    return x < y ? -1 : x > y;
}

/* Heights between two ends of some piece's: where planes cut the same pieces. */
struct height_gap {
    double low, high;
    int pieces;
};

static bool is_better(const struct height_gap *a, const struct height_gap *b) {
    return a->pieces != b->pieces ? a->pieces > b->pieces : a->high - a->low > b->high - b->low;
}

/* Middles of gaps: of those where planes cut most pieces, the widest. */
static pir_status list_heights(const struct opening_search *t, const double n[3], double *ret_height,
                               uint32_t *ret_count) {
    const uint32_t count = t->question->obstacles->count;
    struct height_end *end = calloc(2 * (size_t)count + 1, sizeof *end);
    struct height_gap best[MOST_HEIGHTS + 1], gap = {.pieces = 0};
    if (!end)
        return PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        double h[2];
        heights_of(&t->parts.obstacle[i], n, h);
        end[2 * i] = (struct height_end){h[0], 1};
        end[2 * i + 1] = (struct height_end){h[1], -1};
    }
    qsort(end, 2 * (size_t)count, sizeof *end, by_height);
    *ret_count = 0;
    for (uint32_t i = 0; i + 1 < 2 * count; i++) {
        gap = (struct height_gap){end[i].at, end[i + 1].at, gap.pieces + end[i].step};
        if (gap.pieces <= 0 || gap.low == gap.high)
            continue;
        uint32_t at = *ret_count;
        for (; at > 0 && is_better(&gap, &best[at - 1]); at--)
            best[at] = best[at - 1];
        best[at] = gap;
        *ret_count = *ret_count < MOST_HEIGHTS ? *ret_count + 1 : MOST_HEIGHTS;
    }
    for (uint32_t i = 0; i < *ret_count; i++)
        ret_height[i] = best[i].low + (best[i].high - best[i].low) / 2;
    free(end);
    return PIR_OK;
}

/* --- one wall --- */

/* Tries whether a piece can pass a wall; what is not decided is noted, if it is to be. */
static pir_status try_piece(struct opening_search *t, const pir_opening_wall *wall, uint32_t piece, double d,
                            bool is_first) {
    const pir_opening_body *body = &t->parts.robot[piece];
    pir_opening_budget how = *t->how;
    how.cells = is_first && t->left > FIRST ? FIRST : t->left;
    pir_opening_cells cells = {0};
    pir_opening_verdict verdict = PIR_OPENING_CLOSED;
    pir_status status = PIR_OK;
    if (wall->holes > 0)
        status = pir_opening_cells_decide(body, wall->square, &how, &cells, &verdict);
    t->result->cells += cells.count;
    t->left -= cells.count < t->left ? cells.count : t->left;
    if (status == PIR_OK && verdict == PIR_OPENING_CLOSED) {
        t->result->is_closed = true;
        t->result->cells = cells.count;
        if (t->proof)
            status = pir_opening_write(&t->parts, wall, piece, &cells, t->proof);
    } else if (status == PIR_OK && verdict == PIR_OPENING_UNKNOWN && is_first && t->left > 0) {
        const double n[3] = {mpq_get_d(wall->plane[0]), mpq_get_d(wall->plane[1]), mpq_get_d(wall->plane[2])};
        t->doubt[t->doubts++] = (struct wall_doubt){{n[0], n[1], n[2]}, d, piece};
    }
    pir_opening_cells_finish(&cells);
    return status;
}

static bool goes_on(const struct opening_search *t) {
    return !t->how->goes_on || t->how->goes_on(t->how->context);
}

static pir_status try_plane(struct opening_search *t, const double n[3], double d) {
    pir_opening_wall wall;
    if (!goes_on(t))
        return PIR_ERR_LIMIT;
    pir_status status = pir_opening_wall_make(&t->parts, n, d, &wall);
    for (uint32_t i = 0; i < wall.pieces && i < MOST_PASSING && status == PIR_OK && !t->result->is_closed; i++)
        status = try_piece(t, &wall, wall.piece[i], d, true);
    pir_opening_wall_finish(&wall);
    return status;
}

/* Tries a wall again, of which a first trial left it open whether a piece can pass it. */
static pir_status try_again(struct opening_search *t, const struct wall_doubt *doubt) {
    pir_opening_wall wall;
    pir_status status = pir_opening_wall_make(&t->parts, doubt->n, doubt->d, &wall);
    if (status == PIR_OK)
        status = try_piece(t, &wall, doubt->piece, doubt->d, false);
    pir_opening_wall_finish(&wall);
    return status;
}

/* Tries all planes along a direction, which is turned such that the start is below. */
static pir_status try_way(struct opening_search *t, const double way[3]) {
    const double *from = t->question->at[0], *to = t->question->at[1];
    double n[3], height[MOST_HEIGHTS], rise = 0;
    uint32_t count = 0;
    for (int k = 0; k < 3; k++)
        rise += way[k] * (to[k] - from[k]);
    for (int k = 0; k < 3; k++)
        n[k] = rise < 0 ? -way[k] : way[k];
    pir_status status = list_heights(t, n, height, &count);
    for (uint32_t i = 0; i < count && status == PIR_OK && !t->result->is_closed; i++)
        status = try_plane(t, n, height[i]);
    return status;
}

static pir_status try_all(struct opening_search *t) {
    pir_status status = PIR_OK;
    list_ways(t);
    for (uint32_t i = 0; i < t->ways && status == PIR_OK && !t->result->is_closed; i++)
        status = try_way(t, t->way[i]);
    for (uint32_t i = 0; i < t->doubts && status == PIR_OK && !t->result->is_closed; i++)
        status = try_again(t, &t->doubt[i]);
    return status;
}

pir_status pir_opening_decide(const pir_plan_asked *question, const pir_opening_budget *how, FILE *proof,
                              pir_opening_result *ret_result) {
    struct opening_search *t = calloc(1, sizeof *t);
    *ret_result = (pir_opening_result){0};
    if (!t)
        return PIR_ERR_MEMORY;
    t->question = question;
    t->how = how;
    t->left = how->cells;
    t->proof = proof;
    t->result = ret_result;
    pir_status status = pir_opening_parts_make(question, &t->parts);
    if (status == PIR_OK)
        status = try_all(t);
    else if (status == PIR_ERR_LIMIT)
        status = PIR_OK; // left to others
    pir_opening_parts_finish(&t->parts);
    free(t);
    return status;
}

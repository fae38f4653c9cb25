/* SPDX-License-Identifier: MIT */
/*
 * A path through rotations in two stages.
 *
 * Joining (the greedy edge heuristic of the travelling salesman: Bentley, Fast Algorithms for Geometric Traveling
 * Salesman Problems, ORSA J. Computing 4(4), 1992). Each rotation begins as a piece of its own. In a round the ends of
 * pieces name their nearest ends of other pieces; these edges, the shortest first, join pieces where both ends are
 * still ends of different pieces. Rounds go on until one piece is left. Then polish.h exchanges steps.
 *
 * Invariants: `next` of a rotation are its neighbours on its piece, NONE where there is none; an end has at most one.
 * `piece` is a forest whose roots name the pieces.
 */
#include "cspace/grid/chain.h"

#include "base/layout.h"
#include "base/sort.h"
#include "cspace/grid/angle.h"
#include "cspace/grid/polish.h"
#include "cspace/grid/quat_tree.h"

#define NONE UINT32_MAX

typedef struct joining {
    const pir_quat *unit;
    uint32_t count, pieces;
    uint32_t (*next)[2];
    uint32_t *piece, *group; /* group: the root of each, filled in for a round */
    uint32_t *item;          /* the ends, as a tree */
    uint32_t ends;
    uint32_t edges;
    uint32_t *from, *to;
    double *close;
    uint32_t *order, *work;
} joining;

static pir_layout layout_of(joining *j) {
    const size_t n = j->count, edges = (size_t)PIR_POLISH_NEIGHBOURS * j->count;
    return (pir_layout){{PIR_ROW(j->next, n), PIR_ROW(j->piece, n), PIR_ROW(j->group, n), PIR_ROW(j->item, n),
                         PIR_ROW(j->from, edges), PIR_ROW(j->to, edges), PIR_ROW(j->close, edges),
                         PIR_ROW(j->order, edges), PIR_ROW(j->work, edges)}};
}

static uint32_t root_of(uint32_t *piece, uint32_t at) {
    while (piece[at] != at)
        at = piece[at] = piece[piece[at]];
    return at;
}

static bool is_end(const joining *j, uint32_t at) {
    return j->next[at][1] == NONE;
}

/* Whether edge a is joined before edge b. */
static bool edge_before(void *context, uint32_t a, uint32_t b) {
    const joining *j = context;
    if (j->close[a] != j->close[b])
        return j->close[a] > j->close[b];
    return j->from[a] != j->from[b] ? j->from[a] < j->from[b] : j->to[a] < j->to[b];
}

/* The edges of a round: each end with its nearest ends of other pieces. */
static void name_edges(joining *j) {
    j->ends = j->edges = 0;
    for (uint32_t i = 0; i < j->count; i++) {
        j->group[i] = root_of(j->piece, i);
        if (is_end(j, i))
            j->item[j->ends++] = i;
    }
    pir_quat_tree tree = {j->unit, j->item, j->ends};
    pir_quat_tree_build(&tree);
    for (uint32_t e = 0; e < j->ends; e++) {
        uint32_t end = j->item[e];
        pir_tree_filter filter = {j->group, j->group[end]};
        pir_near near = {.capacity = PIR_POLISH_NEIGHBOURS};
        pir_quat_tree_nearest(&tree, j->unit[end], &filter, &near);
        for (size_t k = 0; k < near.count; k++) {
            j->from[j->edges] = end;
            j->to[j->edges] = (uint32_t)near.number[k];
            j->close[j->edges] = near.close[k];
            j->order[j->edges] = j->edges;
            j->edges++;
        }
    }
    pir_sort(j->order, j->edges, j->work, edge_before, j);
}

static void put_next(joining *j, uint32_t at, uint32_t next) {
    j->next[at][j->next[at][0] == NONE ? 0 : 1] = next;
}

static void join(joining *j) {
    for (uint32_t k = 0; k < j->edges; k++) {
        uint32_t a = j->from[j->order[k]], b = j->to[j->order[k]];
        uint32_t of_a = root_of(j->piece, a), of_b = root_of(j->piece, b);
        if (of_a == of_b || !is_end(j, a) || !is_end(j, b))
            continue;
        j->piece[of_a < of_b ? of_b : of_a] = of_a < of_b ? of_a : of_b;
        put_next(j, a, b);
        put_next(j, b, a);
        j->pieces--;
    }
}

/* Follows the one piece from its end of lower number. */
static void follow(const joining *j, uint32_t *ret_order) {
    uint32_t at = 0, before = NONE;
    while (!is_end(j, at))
        at++;
    for (uint32_t k = 0; k < j->count; k++) {
        ret_order[k] = at;
        uint32_t next = j->next[at][0] != before ? j->next[at][0] : j->next[at][1];
        before = at;
        at = next;
    }
}

bool pir_chain_make(const pir_quat *unit, uint32_t count, const pir_allocator *allocator, uint32_t *ret_order) {
    joining j = {.unit = unit, .count = count, .pieces = count};
    pir_layout layout = layout_of(&j);
    bool made = pir_layout_new(allocator, &layout);
    if (made) {
        for (uint32_t i = 0; i < count; i++) {
            j.next[i][0] = j.next[i][1] = NONE;
            j.piece[i] = i;
        }
        while (j.pieces > 1) {
            name_edges(&j);
            join(&j);
        }
        follow(&j, ret_order);
    }
    pir_layout_free(allocator, &layout);
    return made && pir_polish(unit, count, allocator, ret_order);
}

/* SPDX-License-Identifier: MIT */
/*
 * Which pair sums have which facets, and which candidates there are, rests on signs alone: those of the edges of one
 * body's features with the normals of the other's. The table has them all, by lines: parallel edges share a row,
 * parallel normals a column.
 *
 * Invariants once made:
 * - No sign is 0: a rotation at which one is 0, or at which doubles do not tell, is degenerate, and the table refuses
 *   it.
 * - A row is right while the body has turned by no more than `until`: as P turns by an angle, the product of a unit
 *   vector of P and one of Q changes by no more than that angle.
 */
#ifndef PIR_SOLID_KEPT_SIGN_TABLE_H
#define PIR_SOLID_KEPT_SIGN_TABLE_H

#include "solid/body/solid_body.h"
#include "solid/sum/convex.h"

/* How far P has turned is a sum over its steps, in radians, of which each is told as so much more than it is: so the
 * sum is a bound up to PIR_TURN_MOST, where doubles round by half of this. */
#define PIR_TURN_SLACK 0x1p-46
#define PIR_TURN_MOST  64.

/* A place in lists of lists: entry[start[i]] up to entry[start[i + 1]]. */
typedef struct pir_list_of_lists {
    uint32_t *start, *entry, count, entry_count;
} pir_list_of_lists;

/* The edges of one body with the normals of the other. */
typedef struct pir_sign_half {
    uint32_t rows, columns;
    uint32_t *row_item, *column_item; /* directions of the space: the first along each line */
    uint32_t *row_of, *column_of; /* per direction of the space: twice its row or column, odd where it is reversed */
    double *column;               /* x of all columns, y of all, z of all; at the rotation at hand */
    int8_t *sign;                 /* row by row */
    double *until;                /* per row: the turn up to which it is right */
    bool *row_is_outer, *column_is_outer;        /* whether edges or facets of the body are along it, not walls alone */
    pir_list_of_lists row_pieces, column_pieces; /* pieces with an edge, with a face, along it */
} pir_sign_half;

/* An edge in the table: its row, the columns of the facets on its left and right, each twice, odd where reversed. */
typedef struct pir_table_edge {
    uint32_t row, left, right;
} pir_table_edge;

typedef struct pir_sign_change {
    uint32_t half, row, column;
} pir_sign_change;

typedef struct pir_sign_table {
    pir_space *space;
    const pir_shell_body *body;              /* both */
    const pir_convexes *convexes;            /* likewise */
    pir_sign_half half[2];                   /* [k]: edges of body k, normals of the other */
    pir_table_edge *edge[2], *piece_edge[2]; /* of the bodies, and of their pieces */
    pir_sign_change *change;                 /* of the last update */
    uint32_t change_count, change_room;
    uint64_t looked; /* products of the last update */
} pir_sign_table;

/* Lists the lines of two bodies and their pieces. The status is the space's. */
void pir_sign_table_init(pir_sign_table *table, const pir_shell_body body[2], const pir_convexes convexes[2]);
void pir_sign_table_finish(pir_sign_table *table);

/* Makes all signs, P having turned by `turn`. False when the rotation is degenerate. */
bool pir_sign_table_make(pir_sign_table *table, double turn);

/* Makes the rows that may be wrong, and lists what changes; likewise. */
bool pir_sign_table_update(pir_sign_table *table, double turn);

/* The sign of a row with a column, each twice, odd where reversed. */
static inline int pir_sign_at(const pir_sign_half *half, uint32_t row, uint32_t column) {
    const int sign = half->sign[(size_t)(row >> 1) * half->columns + (column >> 1)];
    return (row ^ column) & 1 ? -sign : sign;
}

/* Whether the arcs of an edge of P and one of Q cross, and which way: the sign of Q's right normal · P's edge. */
static inline int pir_arcs_cross(const pir_sign_half half[2], const pir_table_edge *e, const pir_table_edge *g) {
    const int right = pir_sign_at(&half[0], e->row, g->right);
    if (pir_sign_at(&half[0], e->row, g->left) == right || pir_sign_at(&half[1], g->row, e->right) != -right ||
        pir_sign_at(&half[1], g->row, e->left) != right)
        return 0;
    return right;
}

#endif

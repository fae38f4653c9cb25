/* SPDX-License-Identifier: MIT */
/*
 * Convex outlines in a plane, counter-clockwise: hulls of points, and the overlap of two outlines. The caller owns
 * every buffer.
 */
#ifndef PIR_QUERY_CONTACT_OUTLINE_H
#define PIR_QUERY_CONTACT_OUTLINE_H

#include <stdbool.h>
#include <stdint.h>

/* The kind of a corner of an overlap. Side i of an outline leads from corner i to the next. */
typedef enum pir_corner_kind {
    PIR_CORNER_P = 0,    /* corner p of the outline of P */
    PIR_CORNER_Q,        /* corner q of the outline of Q */
    PIR_CORNER_CROSSING, /* side p of P's outline crosses side q of Q's */
} pir_corner_kind;

/*
 * A point of the plane and what it stands for. In an outline, p is the vertex of the body and the other members are
 * not used.
 */
typedef struct pir_corner {
    double u, v;
    pir_corner_kind kind;
    uint32_t p, q;
} pir_corner;

typedef struct pir_outline {
    const pir_corner *at;
    uint32_t count; /* 1: a point, 2: a segment */
} pir_outline;

/* The order in which hulls take points: that of u, then of v. A hull's first corner is the first of all. */
static inline bool pir_corner_before(const pir_corner *a, const pir_corner *b) {
    return a->u != b->u ? a->u < b->u : a->v < b->v;
}

/* The distance of two points. */
double pir_outline_distance(const pir_corner *a, const pir_corner *b);

/*
 * Replaces points by the corners of their hull, counter-clockwise, and returns their count. Corners that stand out by
 * at most `snap` are left out; at least one stays. `room` holds count + 1 points. O(n log n).
 */
uint32_t pir_outline_hull(pir_corner *points, uint32_t count, double snap, pir_corner *room);

/*
 * Replaces a hull that is at most `part` as wide as it is long by the segment between its farthest corners. Returns
 * the count.
 */
uint32_t pir_outline_slim(pir_corner *hull, uint32_t count, double part);

/*
 * Finds the corners of what two outlines share, in no order, and returns their count. There are at most twice as many
 * as P has, and as many again as Q has. Corners and sides closer than `snap` count as touching. Two segments share a
 * segment where the sine of their angle is at most `part`, otherwise nothing. O(p · q).
 */
uint32_t pir_outline_overlap(pir_outline p, pir_outline q, double snap, double part, pir_corner *ret_corners);

#endif

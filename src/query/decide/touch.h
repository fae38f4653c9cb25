/* SPDX-License-Identifier: MIT */
/*
 * The pair of points that attains an answer: one of P's exposed face and one of Q's, whose sum is a given point y of
 * the face of D.
 *
 * y is the foot of x on that face, or x moved along a direction. Where the faces are parallel there are many such
 * pairs; they form a convex polygon or a segment. One corner of it is chosen: the vertex of Q of lowest number that
 * lies on P's face, else the vertex of P of lowest number that lies on Q's face, else the crossing of the first edges
 * in order. So it depends on the two bodies and the pose alone.
 *
 * Exact signs of m·(y − corner) decide which points lie on a face, for the normals m of its sides. These are across
 * the face's normal, so the exact foot need not be known.
 */
#ifndef PIR_QUERY_DECIDE_TOUCH_H
#define PIR_QUERY_DECIDE_TOUCH_H

#include "query/decide/facet.h"

/*
 * The error of m·(y − corner) for a unit m = n × e or m = e is less than twice that of a slack. n is off by
 * 64u·err, e by 47u, their product rounds by 4u: together below PIR_SLACK_BOUND·err, u = 2^-53. What m is multiplied
 * with is off by less than PIR_SLACK_BOUND·reach.
 */
#define PIR_SIDE_ERRORS 2

/*
 * A way from x. In doubles it ends at y = x + at·u. Exactly, the translation moves along `direction` to the plane
 * with the given normal through corner (a, b) of D.
 */
typedef struct pir_way {
    pir_vec3 u;
    double at, error; /* `error` bounds the error of `at` */
    pir_vec3 direction;
    const pir_normal *normal;
    uint32_t a, b;
} pir_way;

/* Where an answer is attained. */
typedef struct pir_touch {
    pir_witness witness; /* the least faces that hold the two points */
    pir_vec3 point_q;    /* relative to Q's middle, in the frame */
} pir_touch;

/*
 * The faces that a direction exposes, and where y lies: at the end of `way`, or, without one, at the foot of x,
 * `slack` along the normal from x.
 */
typedef struct pir_meeting {
    const pir_normal *normal;
    pir_witness faces;
    bool flat; /* their sum has an area; otherwise it is an edge or a vertex of D */
    double slack;
    const pir_way *way; /* or NULL */
} pir_meeting;

/* Finds where the faces meet. False where y is not on their sum. */
bool pir_touch_find(pir_exact *exact, const pir_placement *placement, const pir_meeting *meeting, pir_touch *ret_touch);

/* Receives the corners of a meeting, one call each. */
typedef struct pir_touch_visitor {
    void (*visit)(void *context, const pir_touch *corner);
    void *context;
} pir_touch_visitor;

/*
 * Visits every corner of the polygon, segment or point of pairs of points whose sum is y, each once: those at vertices
 * of Q by number, then those at other vertices of P by number, then crossings of edges in order. The first is that of
 * pir_touch_find. None where y is not on the sum of the faces.
 */
void pir_touch_each(pir_exact *exact, const pir_placement *placement, const pir_meeting *meeting,
                    const pir_touch_visitor *visitor);

/*
 * Where the edges of P and Q cross whose sum holds y: the part of Q's edge d at which that is. `from` leads to y from
 * the corner of D where both edges begin, and `across` is across P's edge and the normal.
 */
static inline double pir_touch_part(pir_vec3 from, pir_vec3 d, pir_vec3 across) {
    return pir_vec_dot(from, across) / pir_vec_dot(d, across);
}

/* The point at such a part of the edge d that begins at `from`. */
static inline pir_vec3 pir_touch_along(pir_vec3 from, pir_vec3 d, double part) {
    double least = part > 0 ? part : 0;
    return pir_vec_add(from, pir_vec_scale(d, least < 1 ? least : 1));
}

/* The touch at the foot of x on a facet of D. */
bool pir_touch_facet(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack,
                     const pir_way *way, pir_touch *ret_touch);

/* --- witness.c --- */

/* The least face of `polytope` that holds the given vertices, or the first vertex where no face holds all of them. */
pir_feature pir_feature_of(const pir_polytope *polytope, const uint32_t *vertices, uint32_t count);

/*
 * A point of Q, relative to Q's middle, for the foot of x on a facet's plane, which is `slack` along the normal from
 * x. The foot may lie beside the facet. Where it lies on the facet and the faces are not parallel, this is the point
 * that touches.
 */
pir_vec3 pir_facet_point(const pir_frame *frame, const pir_placement *placement, const pir_facet *facet, double slack);

/*
 * The piece that two features make, with its normal on the side of n, and a vertex of P and of Q at it. False where
 * they are not a facet and a vertex, nor two edges.
 */
bool pir_piece_of(const pir_frame *frame, pir_witness faces, uint32_t a, uint32_t b, pir_vec3 n, pir_piece *ret_piece);

#endif

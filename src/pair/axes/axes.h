/* SPDX-License-Identifier: MIT */
/*
 * Every facet of D has the normal of a facet of P, that of a facet of Q, or one across an edge of each. Bodies such as
 * boxes have few of these: two boxes have 6, 6 and, their edges having three directions each, 18. So the slack along
 * each of them is computed, of which the least is D's, however P stood before.
 */
#ifndef PIR_PAIR_AXES_AXES_H
#define PIR_PAIR_AXES_AXES_H

#include "polytope/attachment.h"
#include "query/decide/piece_plane.h"

/* Bodies of more are not looked at. Lists are padded to whole lanes of four. */
#define PIR_AXES_VERTICES 8
#define PIR_AXES_FACETS   8
#define PIR_AXES_ALONG    6
#define PIR_AXES_PADDED   8

/* Halves of edges of a parallelepiped, padded. */
#define PIR_AXES_HALVES 4

/* By Euler's formula. */
#define PIR_AXES_EDGES (PIR_AXES_VERTICES + PIR_AXES_FACETS - 2)

/* Slacks of two bodies: along the lines of both, and along each two directions of edges, either way. */
#define PIR_AXES_SLACKS (4 * PIR_AXES_PADDED + 2 * PIR_AXES_ALONG * PIR_AXES_PADDED)

/*
 * The loops' view of a body: vectors in parallel arrays. Two facets with opposite normals are on one line, and of
 * two opposite vertices one is enough where all have one, as boxes do: so there is half as much to compute.
 */
typedef struct pir_axes_lanes {
    uint32_t vertices, lines, along;
    bool is_central;                   /* all vertices come in opposite pairs: then one of each is listed */
    double vertex[3][PIR_AXES_PADDED]; /* padded by the first */
    double normal[3][PIR_AXES_PADDED]; /* of the first facet on each line */
    double offset[2][PIR_AXES_PADDED]; /* of that and of the one against it; infinite where there is none */
    double edge[3][PIR_AXES_PADDED], far[PIR_AXES_PADDED]; /* unit vectors along edges; 0, infinite where padded */

    /* of a parallelepiped, whose vertices are sums of half an edge each way: else none of these is set */
    bool has_halves;
    double half[3][PIR_AXES_HALVES];     /* half an edge along each direction; 0 where padded */
    double other[2][3][PIR_AXES_HALVES]; /* for each direction the halves along the two others */
} pir_axes_lanes;

/* A body with few facets and directions, in the frame of one exponent. Its polytope keeps it. */
typedef struct pir_axes {
    pir_attachment attachment;
    bool is_few; /* whether it is one: else nothing below is set */
    pir_axes_lanes lanes;
    uint32_t facet[2][PIR_AXES_PADDED];                        /* per line, either way */
    uint32_t first[PIR_AXES_ALONG + 1], edges[PIR_AXES_EDGES]; /* per direction, the edges along it */
} pir_axes;

/* The loops, in versions for processors. */
typedef struct pir_axes_loops {
    const char *name;
    /*
     * Sets what all slacks of x are not below, `error` being the placement's, in this order, each part padded to
     * whole lanes and one way, then the other: P's lines, Q's, and for each direction of P's edges those of Q's.
     * Returns their number.
     */
    uint32_t (*slacks)(const pir_axes_lanes *p, const pir_axes_lanes *q, const pir_mat3 *r, pir_vec3 x, double error,
                       double low[PIR_AXES_SLACKS]);
    /* How many slacks of two parallelepipeds are not certain to be above `most`, a number above 0. */
    uint32_t (*near)(const pir_axes_lanes *p, const pir_axes_lanes *q, const pir_mat3 *r, pir_vec3 x, double error,
                     double most);
    /* The least number, the first of its kind, and the least but for that one. `count` is of whole lanes. */
    uint32_t (*least)(const double *low, uint32_t count, double *ret_next);
} pir_axes_loops;

/* Whole lanes of four, whatever a processor takes at a time. */
static inline uint32_t pir_axes_padded(uint32_t count) {
    return (count + 3) & ~3u;
}

/* Finds the axes of a body in its frame, which belong to its polytope; NULL where they are many. PIR_ERR_MEMORY. */
pir_status pir_axes_find(pir_polytope *p, int exponent, const pir_body *body, const pir_axes **ret_axes);

/* The least slack, and its place in the order of the loops. */
typedef struct pir_axes_slack {
    uint32_t at;
    double low;  /* it is not below this */
    double next; /* those along all other axes are not below this */
} pir_axes_slack;

/* Finds it for the bodies of the frame, whose axes these are. */
void pir_axes_least(const pir_axes_loops *loops, const pir_axes *p, const pir_axes *q, const pir_frame *frame,
                    const pir_placement *placement, pir_axes_slack *ret_least);

/* The piece that has that slack if any has, and the unit normal there. */
pir_piece pir_axes_piece(const pir_axes *p, const pir_axes *q, const pir_frame *frame, uint32_t at,
                         pir_vec3 *ret_normal);

extern const pir_axes_loops pir_axes_plain, pir_axes_avx2;

#endif

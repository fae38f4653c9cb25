/* SPDX-License-Identifier: MIT */
/*
 * The obstacle of two bodies in pieces at one pose: the union of the sums S_kl = B_l ⊕ A'_k (piece_frame.h), given by
 * the planes of its facets, made when the sum is first looked at. P is free at x where x is inside of none of them.
 *
 * Doubles of planes and points have proven errors, in units of the frame:
 *
 *     |point.x − x| ≤ point.err in every coordinate taken together,
 *     |(plane.n·x − plane.d) − (n·x − d)| ≤ plane.err  for |n| = 1 and |x_k| ≤ 1.
 *
 * Exact numbers are made when a sign needs them, in lengths: a plane as (a, b, c, d), the points with a·x ≤ d being
 * below it, a point as (X, Y, Z, W), W > 0. Doubles never change once they are made, so that they do not depend on what
 * was asked before.
 *
 * The planes of a sum stand in a row, in the order of ties: of P's facets by index, of Q's, of edges, P's first. Every
 * one is that of a facet: edges count where their arcs cross strictly.
 *
 * Failures stay in `status`. Arrays are kept from pose to pose: after the first ones nothing is allocated but GMP's
 * memory, in which exact numbers are.
 */
#ifndef PIR_SOLID_DEPTH_OBSTACLE_H
#define PIR_SOLID_DEPTH_OBSTACLE_H

#include "solid/depth/piece_frame.h"

#define PIR_OBSTACLE_NONE UINT32_MAX

/* The most planes, points or parts that one question may make. */
#define PIR_OBSTACLE_MOST (1u << 22)

enum pir_obstacle_kind {
    PIR_OBSTACLE_P_FACET,
    PIR_OBSTACLE_Q_FACET,
    PIR_OBSTACLE_EDGES,
    PIR_OBSTACLE_BOX,
    PIR_OBSTACLE_WALL
};

typedef struct pir_obstacle_plane {
    double n[3], d, err;
    uint32_t pair;  /* k · (pieces of Q) + l; of the planes of the box which one: 2 · axis + side; of
                       walls the facet's plane */
    uint32_t p, q;  /* features of the pieces, by their numbers there: a support where the other's is a facet */
    uint32_t exact; /* where its numbers are, or none */
    enum pir_obstacle_kind kind;
    bool turned; /* of edges: the normal is the reverse of P's edge × Q's; of walls, of side × the facet's normal */
    bool tied;   /* of facets: another vertex may be as high, so that it may be more than a copy of the facet */
    uint32_t shared_p, shared_q; /* the plane, the vertex or the line, by their numbers in the bodies */
} pir_obstacle_plane;

/* A point: the sum of a vertex of A' and one of B, what P is moved by, the nearest point to that on a plane or on the
 * line where two meet, where three planes meet, or where a way from it meets a plane. */
enum pir_obstacle_point_kind {
    PIR_OBSTACLE_VERTICES,
    PIR_OBSTACLE_PLACE,
    PIR_OBSTACLE_ON_PLANE,
    PIR_OBSTACLE_ON_LINE,
    PIR_OBSTACLE_MEET,
    PIR_OBSTACLE_ON_WAY
};

typedef struct pir_obstacle_point {
    double x[3], err;
    uint32_t of[3]; /* planes; vertices of A' and B by their numbers in the bodies */
    uint32_t exact;
    enum pir_obstacle_point_kind kind;
} pir_obstacle_point;

/* The sum of one pair of pieces. */
typedef struct pir_obstacle_sum {
    uint32_t first, count; /* planes; count 0 where they are not made */
    uint32_t outer;        /* one of them, that a place was beyond of late */
} pir_obstacle_sum;

typedef struct pir_obstacle {
    pir_allocator allocator;
    pir_piece_frame frame;
    pir_status status;
    pir_obstacle_sum *sum; /* per pair */
    uint32_t pairs, opened;
    uint32_t *open;            /* the pairs whose planes are made */
    double (*beyond)[3];       /* per pair: the normal of a plane that a point was beyond of late, or 0 */
    pir_obstacle_plane *plane; /* those of the box first */
    pir_obstacle_point *point; /* the place of P first */
    mpz_t *number;
    uint32_t plane_count, plane_room, point_count, point_room, number_count, number_room, number_made;
    mpz_t t[24];      /* scratch of exact calls */
    int8_t *slope[2]; /* of the sum that is opened: P's faces along Q's edges, and the reverse; 2 where not known */
    uint32_t slope_room[2];
    bool has_way;
    double way[3], way_err; /* unit, as Q sees it */
    pir_vec3 world_way;
    uint32_t exact_way;
} pir_obstacle;

/* False when out of memory; pir_obstacle_finish then frees what is there. */
bool pir_obstacle_init(pir_obstacle *obstacle, const pir_compound *p, const pir_compound *q,
                       const pir_allocator *allocator);
void pir_obstacle_finish(pir_obstacle *obstacle);

/* Takes the poses; planes and points of earlier ones are gone. `way` is NULL or a direction of the world. */
pir_status pir_obstacle_set(pir_obstacle *obstacle, const pir_pair_input *input, const pir_vec3 *way);

/* The planes of a pair's sum. */
pir_obstacle_sum *pir_obstacle_open(pir_obstacle *obstacle, uint32_t pair);

/* Notes that a point was beyond a plane of a sum: points are likely to be so at the next pose, and for those that are
 * the sum need not be opened. */
void pir_obstacle_note_beyond(pir_obstacle *obstacle, uint32_t plane);

/* Whether a place, within `err`, is certainly beyond all of a sum along the normal that was noted. */
bool pir_obstacle_is_beyond(const pir_obstacle *obstacle, uint32_t pair, const double x[3], double err);

/* The box that holds the sum of a pair. */
pir_space_box pir_obstacle_box(const pir_obstacle *obstacle, uint32_t pair);

/* A new point of a kind, of planes. */
uint32_t pir_obstacle_add(pir_obstacle *obstacle, enum pir_obstacle_point_kind kind, uint32_t f, uint32_t g,
                          uint32_t h);

/* The wall through a side of the facet of a plane, from one sum of two vertices to the next. It has the facet below
 * where that is on the left of the side as seen from above; `turned`, on the right. */
uint32_t pir_obstacle_add_wall(pir_obstacle *obstacle, uint32_t plane, uint32_t from, uint32_t to, bool turned);

/* Whether a point is on a plane at every pose, as far as shared features tell. */
bool pir_obstacle_is_always_on(const pir_obstacle *obstacle, uint32_t plane, uint32_t point);

/* Grows *array, of *room elements of a size, to hold one more than `count`. False once `status` is a failure. */
bool pir_obstacle_grow(pir_obstacle *obstacle, void **array, uint32_t *room, uint32_t count, size_t size);

/* --- obstacle_exact.c --- */

/* Where the exact numbers of a plane or a point are. */
uint32_t pir_obstacle_exact_plane(pir_obstacle *obstacle, uint32_t plane);
uint32_t pir_obstacle_exact_point(pir_obstacle *obstacle, uint32_t point);

/* Sets the doubles of a plane or a point from its exact numbers. */
void pir_obstacle_round_plane(pir_obstacle *obstacle, uint32_t plane);
void pir_obstacle_round_point(pir_obstacle *obstacle, uint32_t point);

/* The side of a plane on which a point is, by exact numbers: 1 above, −1 below, 0 on it. */
int pir_obstacle_exact_side(pir_obstacle *obstacle, uint32_t plane, uint32_t point);

/* The sign of a normal of one body along the edge of another: `side` is whose normal it is. */
int pir_obstacle_exact_slope(pir_obstacle *obstacle, int side, const uint32_t piece[2], uint32_t face, uint32_t edge);

/* Whether a way rises through a plane: the sign of its rate. */
int pir_obstacle_exact_rate(pir_obstacle *obstacle, uint32_t plane);

/* The sign of the distance of point a from the place of P less that of point b. */
int pir_obstacle_exact_nearer(pir_obstacle *obstacle, uint32_t a, uint32_t b);

/* The sign of the first coordinate in which two points differ. */
int pir_obstacle_exact_order(pir_obstacle *obstacle, uint32_t a, uint32_t b);

/* Whether the way from the place of P to a point is along the normals of planes: of one, or spanned by those of two. */
bool pir_obstacle_is_along(pir_obstacle *obstacle, uint32_t point, uint32_t f, uint32_t g);

/* Whether the normal of a plane is no combination of those of one or two others, which are so themselves. */
bool pir_obstacle_are_independent(pir_obstacle *obstacle, const uint32_t *plane, uint32_t count, uint32_t other);

/* The way from the place of P to a point, in units of the frame: nearest to the exact one in every coordinate, but for
 * an ulp, and its length. Depends on the point alone, however it was made. */
double pir_obstacle_exact_way(pir_obstacle *obstacle, uint32_t point, double ret_way[3]);

/* --- signs, by doubles where they tell --- */

static inline int pir_obstacle_side(pir_obstacle *obstacle, uint32_t plane, uint32_t point) {
    const pir_obstacle_plane *f = &obstacle->plane[plane];
    const pir_obstacle_point *p = &obstacle->point[point];
    const double s = f->n[0] * p->x[0] + f->n[1] * p->x[1] + f->n[2] * p->x[2] - f->d;
    const double bound = f->err + p->err + 0x1p-50;
    if (s > bound)
        return 1;
    if (s < -bound)
        return -1;
    return pir_obstacle_is_always_on(obstacle, plane, point) ? 0 : pir_obstacle_exact_side(obstacle, plane, point);
}

/* A half-space: a plane's number, twice, and whether it is turned. Its points have side ≤ 0. */
static inline uint32_t pir_obstacle_half(uint32_t plane, bool turned) {
    return plane << 1 | turned;
}

static inline int pir_obstacle_half_side(pir_obstacle *obstacle, uint32_t half, uint32_t point) {
    const int side = pir_obstacle_side(obstacle, half >> 1, point);
    return half & 1 ? -side : side;
}

#endif

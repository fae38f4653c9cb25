/* SPDX-License-Identifier: MIT */
/*
 * The oracle of placements: P, turned by a quaternion and moved by t, against Q, in exact arithmetic. The difference Q
 * ⊕ (−R·P) is made twice: as half-spaces, from the facets of both bodies and all pairs of their edges
 * (place_make.c), and as the hull of all differences of vertices (place_nearest.c). Nothing of the library is used but
 * vertices as doubles.
 *
 * Integers: a rotated body has coordinates in units of 2^unit / |q|². A pose has units smaller by a whole factor,
 * `grain`, to hold the doubles of its translation and direction too, or a rational point.
 */
#ifndef PIR_ORACLE_PLACE_H
#define PIR_ORACLE_PLACE_H

#include <pirouette/query.h>

#include "oracle/solid.h"

/* m·2^e. Relative error below 2^-50. */
typedef struct oracle_real {
    double m;
    long e;
} oracle_real;

double oracle_real_double(oracle_real x);

/* normal · x ≤ offset, in units of the difference. */
typedef struct oracle_plane {
    oracle_vec normal;
    mpz_t offset;
    oracle_set *p, *q; /* the vertices of each body that lie in it */
    double near[3];    /* unit */
    oracle_real length;
} oracle_plane;

typedef struct oracle_place {
    const oracle_solid *p, *q;
    oracle_quat quat;
    mpz_t square; /* |q|² */
    long unit;    /* of both bodies */
    oracle_vec *a,
        *b; /* vertices of P, rotated, and of Q, less the first; the difference: all b − a and first_q − first_p */
    oracle_vec first_p, first_q; /* the first vertices */
    oracle_set *only_p, *only_q; /* the sets of these alone */
    double (*near_a)[3], (*near_b)[3];
    long exponent; /* near = exact·2^-exponent */
    int dimension; /* of the difference */
    uint32_t plane_count, plane_room;
    oracle_plane *plane; /* its facets; of a flat difference two for each plane it lies in, and its sides */

    /* the pose */
    mpz_t grain;       /* one unit of the difference in units of the pose */
    oracle_vec t, d;   /* translation, less first_q − first_p, and direction */
    oracle_real scale; /* one unit of the pose as a length */
    mpz_t *slack;      /* offset − normal · t of each plane */
    mpz_t *rate;       /* normal · d */
} oracle_place;

/* The difference of two solids, which are borrowed, at a rotation. */
oracle_place *oracle_place_make(const oracle_solid *p, const oracle_solid *q, pir_quat rotation);
void oracle_place_free(oracle_place *place);

/* Vertex j of Q less vertex i of P, rotated: rounded. */
pir_vec3 oracle_place_vertex(const oracle_place *place, uint32_t i, uint32_t j);

/* --- at a translation, with a direction --- */

void oracle_place_set(oracle_place *place, pir_vec3 translation, pir_vec3 direction);

pir_state oracle_place_state(const oracle_place *place);

/* offset − normal · t over the normal's length, of plane i. */
double oracle_place_slack(const oracle_place *place, uint32_t i);

/* The plane of the least slack. Not for a flat difference. */
uint32_t oracle_place_deepest(const oracle_place *place);

/* Compares the slacks of two planes exactly, as strcmp does. Both slacks are ≥ 0. */
int oracle_place_compare(const oracle_place *place, uint32_t i, uint32_t j);

/* The nearest point of the difference, or of part of it. */
typedef struct oracle_nearest {
    int apart; /* the distance is not 0; it may be too small for a double */
    double distance;
    pir_vec3 normal;            /* from there to t, unit; 0 when not apart */
    uint32_t count, p[4], q[4]; /* pairs of vertices whose hull holds it, none to spare */
} oracle_nearest;

/* Of the hull of b − a for all a of `p` and b of `q`; NULL stands for all. Exact but for the last rounding. */
oracle_nearest oracle_place_nearest(oracle_place *place, const oracle_set *p, const oracle_set *q);

/* Whether it does not hold t, exactly. */
int oracle_place_is_apart(oracle_place *place, const oracle_set *p, const oracle_set *q);

/* The distance in doubles: at least the exact one, less 2^-48 of the size of things. For quick looks. */
double oracle_place_near(const oracle_place *place, const oracle_set *p, const oracle_set *q);

/* When the ray t + s·d is in the difference: s from `enter` to `leave`. */
typedef struct oracle_ray {
    int meets;            /* the line does, for some s ≥ 0 */
    int within;           /* it does for some s in [0, 1] */
    int inwards;          /* where t is on the boundary of a solid difference: d leads to its inside */
    double enter, leave;  /* 0 at least; HUGE_VAL without end */
    uint32_t first, last; /* planes that it enters and leaves through */
} oracle_ray;

oracle_ray oracle_place_ray(const oracle_place *place);

/* The greatest length of b − a − t. */
double oracle_place_farthest(oracle_place *place);

/* How far the difference reaches along a direction, less t; over the direction's length. */
double oracle_place_reach(oracle_place *place, pir_vec3 direction);

/* --- moving on from a pose that oracle_place_set set: only nearest points can be asked then --- */

/* To the nearest point of the difference; to the foot on a plane; along the direction to a plane. */
void oracle_place_to_nearest(oracle_place *place);
void oracle_place_to_plane(oracle_place *place, uint32_t i);
void oracle_place_along_to_plane(oracle_place *place, uint32_t i);

/* --- of one body --- */

/*
 * Sets the pose, of P at `translation`, to one whose distances from {−a} and from {b} are those of `point` from P and
 * from Q.
 */
void oracle_place_set_point(oracle_place *place, pir_operand operand, pir_vec3 point, pir_vec3 translation);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The points and directions of two bodies at rest, and what a rotation and two scales make of them in their space.
 *
 * A body is prepared once, at rest: its points, directions, planes and pieces are in a space. What of these is named
 * is kept then, its exact numbers apart from the space's. To turn is to give each kept point and direction its doubles
 * for the rotation, and to forget whatever else the space holds. Exact numbers follow when a sign asks for them.
 *
 * Invariants between a call that keeps and the space's end: points, directions and planes of the space below the marks
 * have the numbers that they had at rest; each one that was kept is turned; the planes there have directions, but
 * their doubles are those at rest, so that only their directions may be read.
 */
#ifndef PIR_SOLID_SPACE_REST_H
#define PIR_SOLID_SPACE_REST_H

#include "exact/rotation.h"
#include "solid/space/space.h"

/* A point or direction at rest, of P (0) or Q (1). */
typedef struct pir_rest_item {
    double x[3];
    uint32_t of;    /* its number in the space */
    uint32_t exact; /* the first of its numbers: X, Y, Z, W or x, y, z */
    uint32_t body;
    uint32_t same;   /* the first item of that body at its place, or along its line either way */
    uint32_t end[2]; /* of an edge's direction: points at its ends, as items; or none */
} pir_rest_item;

typedef struct pir_rest_list {
    pir_rest_item *item;
    uint32_t count, room;
} pir_rest_list;

/* How many answers are kept, a power of two. */
#define PIR_REST_KNOWN 8192u

struct pir_space_rest {
    pir_space *space;
    pir_rest_list points, directions;
    mpz_t *number;
    uint32_t number_count, number_room;
    uint32_t point_mark, direction_mark, plane_mark;
    pir_intern points_of[2], directions_of[2]; /* per body, until all is kept */
    int shift;                                 /* of the space at rest */
    double scale[2];                           /* of P and Q; finite, above 0 */
    pir_rotation *rotation;                    /* of P; borrowed */
    mpz_t matrix[2][9];                        /* scale · M, the rotation as integers, times a positive number */
    mpz_t weight[2];                           /* that number: a point is matrix · X over weight · W */
    mpz_t t[2];                                /* scratch */
    struct pir_rest_known {
        uint64_t key; /* 0: none */
        bool holds;
    } * known; /* answers about what is at rest (identity.c), each at its hash: the last one there */
};

void pir_rest_init(pir_space_rest *rest, pir_space *space);
void pir_rest_finish(pir_space_rest *rest);

/* Keeps a point or a direction of a body, once. The status is the space's. */
void pir_rest_keep_point(pir_space_rest *rest, uint32_t point, int body);
void pir_rest_keep_direction(pir_space_rest *rest, uint32_t direction, int body);

/* Keeps the direction of an edge, and its ends. */
void pir_rest_keep_edge(pir_space_rest *rest, uint32_t direction, uint32_t a, uint32_t b, int body);

/* Ends what is kept: the space holds what turns, and its marks are set. */
void pir_rest_settle(pir_space_rest *rest);

/* Turns P by a rotation, which is borrowed until the next call, and brings both bodies to their scales. All else in the
 * space above the marks is forgotten; with `keep`, directions alone, and points and planes there are to be renewed. */
void pir_rest_turn(pir_space_rest *rest, pir_rotation *rotation, const double scale[2], bool keep);

/* The exact numbers of a point, X, Y, Z, W > 0, and of a direction, as they are turned; not in lowest terms. */
void pir_rest_turn_point(const pir_space_rest *rest, uint32_t item, mpz_t *ret);
void pir_rest_turn_direction(const pir_space_rest *rest, uint32_t item, mpz_t *ret);

#endif

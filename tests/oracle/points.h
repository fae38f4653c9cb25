/* SPDX-License-Identifier: MIT */
/*
 * The oracle's arithmetic: points as GMP integers over one positive denominator, rotated exactly. Slow, short and
 * plain: nothing here knows how the library works, and nothing of the library is used but its public calls for exact
 * coordinates.
 */
#ifndef PIR_ORACLE_POINTS_H
#define PIR_ORACLE_POINTS_H

#include <gmp.h>

#include <pirouette/mesh.h>
#include <pirouette/polytope.h>

typedef mpz_t oracle_vec[3];

void oracle_vec_init(oracle_vec v);
void oracle_vec_clear(oracle_vec v);
void oracle_sub(oracle_vec r, oracle_vec a, oracle_vec b);
void oracle_cross(oracle_vec r, oracle_vec a, oracle_vec b); /* r is neither a nor b */
void oracle_dot(mpz_t r, oracle_vec a, oracle_vec b);
int oracle_is_zero(oracle_vec a);
int oracle_equal(oracle_vec a, oracle_vec b);

/* Point i is at[i] / den. */
typedef struct oracle_points {
    uint32_t count;
    oracle_vec *at;
    mpz_t den;
} oracle_points;

void oracle_points_from_doubles(oracle_points *points, const pir_vec3 *from, size_t count);
void oracle_points_from_polytope(oracle_points *points, const pir_polytope *polytope);
void oracle_points_from_mesh(oracle_points *points, const pir_mesh *mesh); /* one that holds exact coordinates */
void oracle_points_clear(oracle_points *points);

/* A quaternion as integers x, y, z, w on one scale. */
typedef mpz_t oracle_quat[4];
void oracle_quat_init(oracle_quat to, pir_quat q);
void oracle_quat_clear(oracle_quat q);

/* Turns every point by the exact rotation of q. */
void oracle_points_rotate(oracle_points *points, oracle_quat q);

/* r = |q|²·R·a; r is not a. */
void oracle_turn(oracle_vec r, oracle_quat q, oracle_vec a);

/* Brings `count` sets of points to one denominator. */
void oracle_points_common(oracle_points *const *sets, size_t count);

/* The greatest n·p of all points, over their denominator. */
void oracle_support(mpz_t r, const oracle_points *points, oracle_vec n);

#endif

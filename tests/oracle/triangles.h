/* SPDX-License-Identifier: MIT */
/*
 * Triangles in rationals, by plain means: the distance of two as the least over all pairs of subsets of their
 * corners of the distance of the spaces that these span, where the nearest points have no negative weight;
 * segments and boxes by linear equations and clipping. It shares no code with the library.
 */
#ifndef PIR_ORACLE_TRIANGLES_H
#define PIR_ORACLE_TRIANGLES_H

#include <stdbool.h>

#include <gmp.h>

#include <pirouette/pose.h>

typedef mpq_t oracle_corner[3];

typedef struct oracle_triangle {
    oracle_corner p[3];
} oracle_triangle;

void oracle_triangle_init(oracle_triangle *t);
void oracle_triangle_clear(oracle_triangle *t);

/* A triangle as it stands, and at an exact pose. */
void oracle_triangle_set(oracle_triangle *t, const pir_vec3 corner[3]);
void oracle_triangle_place(oracle_triangle *t, const pir_vec3 corner[3], pir_pose pose);

/* The squares of the least and the greatest distance. */
void oracle_triangles_least(mpq_t ret_square, oracle_triangle *a, oracle_triangle *b);
void oracle_triangles_most(mpq_t ret_square, oracle_triangle *a, oracle_triangle *b);

/* Whether a segment that is not in the triangle's plane meets it; when, and from which side: 1 front, −1 back. */
bool oracle_segment_meets(oracle_triangle *t, pir_vec3 origin, pir_vec3 way, mpq_t ret_time, int *ret_side);

/* Whether it shares a point with a box. */
bool oracle_box_meets(oracle_triangle *t, pir_vec3 low, pir_vec3 high);

#endif

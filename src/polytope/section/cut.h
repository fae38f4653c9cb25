/* SPDX-License-Identifier: MIT */
/* A plane that cuts a mesh, in integers: the side of a vertex, the point of an edge. */
#ifndef PIR_POLYTOPE_SECTION_CUT_H
#define PIR_POLYTOPE_SECTION_CUT_H

#include <gmp.h>

#include "polytope/mesh.h"

/*
 * The vertex that the mesh holds as integers V has the height normal·V − offset over the plane, times one positive
 * number that is the same for all vertices. The memory of the integers is GMP's.
 */
struct pir_cut {
    const pir_mesh *mesh; /* with exact coordinates */
    mpz_t normal[3], offset;
    mpz_t height[2], part, divisor; /* scratch */
};

/* The plane normal·x = offset; all numbers are finite, the normal is not zero. */
void pir_cut_init(struct pir_cut *cut, const pir_mesh *mesh, pir_vec3 normal, double offset);
void pir_cut_finish(struct pir_cut *cut);

/* 1 for a vertex on the side that the normal points to, −1 on the other, 0 on the plane. */
int pir_cut_side(struct pir_cut *cut, uint32_t vertex);

/* 1 when the vertices a, b, c, which are in the plane, are counter-clockwise seen from where the normal points to, −1
   when they are clockwise. */
int pir_cut_turn(struct pir_cut *cut, const uint32_t corners[3]);

/*
 * The point where the plane cuts the edge of two vertices on its two sides, or, when both are the same, that vertex:
 * numerators into three initialised integers, over the one positive denominator.
 */
void pir_cut_point(struct pir_cut *cut, const uint32_t edge[2], mpz_t ret_over[3], mpz_t ret_under);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * A placement in exact integers.
 *
 * Let P's vertices be integers times a/b and Q's integers times c/d, R = M/N, and t = T·2^−i with T integer. Then
 * the corner (p, q) of D minus t is, times N·b·d·2^i,
 *
 *     W(p, q) = a·d·2^i · M p  +  N·c·b·2^i · q  −  N·b·d · T,
 *
 * a vector of three integers. Where Q is posed in the world too, with R' = M'/N', t is M'ᵀT·2^−i / N' with T the
 * difference of the translations, and W is N' times as large. Every sign that a query asks for is the sign of a
 * polynomial in such vectors, in edge vectors and in normals. Nothing here allocates: `scratch` is a stack,
 * as large as the longest of these polynomials needs.
 */
#ifndef PIR_QUERY_DECIDE_PLACED_H
#define PIR_QUERY_DECIDE_PLACED_H

#include "query/decide/piece.h"

/* The factors of W for one rotation and translation. Their integers lie at the bottom of the scratch. */
typedef struct pir_exact {
    const pir_frame *frame;
    pir_rotation *rotation; /* the rotation of the frame; its integers are made on demand */
    const pir_world *world; /* where Q does not stand at the identity; else NULL, and the translation given is P's */
    pir_limbs scratch;

    bool made;
    pir_vec3 translation;
    pir_int p, q, k; /* a·d·2^i, N·c·b·2^i, N·b·d */
    uint32_t i;
    pir_int3 t;     /* T */
    pir_int norm_q; /* 1, or |q|² of Q's rotation */
    mp_limb_t one;
    uint32_t mark; /* where free scratch begins */
} pir_exact;

/* A number m·2^e, for quotients and roots of integers that may be beyond the range of doubles. */
typedef struct pir_real {
    double m;
    int e;
} pir_real;

pir_real pir_real_of(const pir_int *a);
pir_real pir_real_over(pir_real a, pir_real b);
pir_real pir_real_times(pir_real a, pir_real b);
/* The square root of a number that is not negative. */
pir_real pir_real_root(pir_real a);
double pir_real_double(pir_real a);

/* |v|² as an integer in scratch, and |v|. */
pir_int pir_exact_square(pir_exact *exact, const pir_int3 *v);
pir_real pir_exact_length(pir_exact *exact, const pir_int3 *v);

/* The limbs of scratch that two operands need at their scales. */
uint32_t pir_exact_limbs(const pir_polytope *p, const pir_polytope *q);

/*
 * Makes scratch of so many limbs. What was in it is lost. Begins with a struct of zeros. False when out of memory; then
 * all is as it was.
 */
void pir_exact_finish(pir_exact *exact, const pir_allocator *allocator);
bool pir_exact_reserve_limbs(pir_exact *exact, const pir_allocator *allocator, uint32_t limbs);

/* Whether they are reserved already. */
static inline bool pir_exact_has_limbs(const pir_exact *exact, uint32_t limbs) {
    return exact->scratch.base && limbs <= exact->scratch.capacity;
}

/* Forgets the integers of a placement, which belong to another rotation, other bodies or another place. */
static inline void pir_exact_forget(pir_exact *exact) {
    exact->made = false;
}

/* Makes the integers of a translation, unless they are there already. No scratch may be in use. */
void pir_exact_begin(pir_exact *exact, pir_vec3 translation);

/* One unit of W in lengths of the frame. */
pir_real pir_exact_unit(const pir_exact *exact);

/* The results of the following calls lie in the scratch. They need pir_exact_begin. */

/* W(a, b). */
pir_int3 pir_exact_corner(pir_exact *exact, uint32_t a, uint32_t b);

/* The vector of a halfedge of P, rotated, or of Q, times a positive number. */
pir_int3 pir_exact_half_p(pir_exact *exact, uint32_t half);
pir_int3 pir_exact_half_q(const pir_exact *exact, uint32_t half);

/* A piece's normal, of any length. It is zero for parallel edges. */
pir_int3 pir_exact_normal(pir_exact *exact, pir_piece piece);

pir_int3 pir_exact_cross(pir_exact *exact, const pir_int3 *a, const pir_int3 *b);
pir_int3 pir_exact_difference(pir_exact *exact, const pir_int3 *a, const pir_int3 *b);
pir_int pir_exact_dot(pir_exact *exact, const pir_int3 *a, const pir_int3 *b);
int pir_exact_dot_sign(pir_exact *exact, const pir_int3 *a, const pir_int3 *b);
/* The sign of a − b. */
int pir_exact_compare(pir_exact *exact, const pir_int *a, const pir_int *b);
/* a·b. */
pir_int pir_exact_product(pir_exact *exact, const pir_int *a, const pir_int *b);
/* v·s. */
pir_int3 pir_exact_scaled(pir_exact *exact, const pir_int3 *v, const pir_int *s);

/* A vector of doubles as integers on a scale of its own: v = result · 2^*ret_exponent. */
pir_int3 pir_exact_vector(pir_exact *exact, pir_vec3 v, int *ret_exponent);
/* A direction that is given where the translations are, in Q's frame: the same where Q is not turned, else N' times it.
   Needs pir_exact_begin. */
pir_int3 pir_exact_direction_by_q(pir_exact *exact, pir_vec3 v, int *ret_exponent);

/* --- the side of a piece's plane: the sign of n·W for a corner of the piece --- */

/* The exact sign of the slack of a piece at a translation. The piece's edges must not be parallel. */
int pir_side_exact(pir_exact *exact, pir_piece piece, pir_vec3 translation);

/* The unit normal of an edge pair from exact integers. False where the edges are parallel. */
bool pir_side_normal(pir_exact *exact, pir_piece piece, pir_vec3 *ret_normal);

#endif

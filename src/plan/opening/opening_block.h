/* SPDX-License-Identifier: MIT */
/*
 * Cells of planes, and what proves of one that at no plane of it the section of a body is in a disc of a given radius.
 *
 * Planes are u·y = s. A chart has one component of u, its axis, ±1; the next two are a and b in [−1, 1]. A cell is
 * a box of a, b and s, with multiples of powers of two as bounds, so doubles are exact.
 *
 * A *block* is two or three chords from x to y with weights. At all corners of the cell u·x < s < u·y, thus at all
 * its planes, since s − u·x is linear in (a, b, s) each. So each plane meets each chord, at x + λ(y − x). There
 * λ = g(x) / (g(x) − g(y)), with g = u·x − s, has its extremes at corners too: λ ≤ c is linear in (a, b, s).
 * Points p with weights w, together 1, that are in a disc of radius r have F = Σw|p|² − |Σwp|² ≤ r², the mean
 * of squares of distances from the disc's middle being at least that from their own. F is convex in the λ, so it is
 * at least its tangent at the middles of the λ's ranges. Where that exceeds r² in all of these, the cell is blocked:
 * no section is in such a disc.
 *
 * Ends of chords are vertices, or points near one: v + 2^-e (w − v).
 */
#ifndef PIR_PLAN_OPENING_OPENING_BLOCK_H
#define PIR_PLAN_OPENING_OPENING_BLOCK_H

#include "plan/opening/opening_body.h"

#define PIR_OPENING_MOST_HALVINGS 40
/* Weights are integers that are together this. */
#define PIR_OPENING_WEIGHTS (1u << 16)

typedef struct pir_opening_range {
    double low[3], high[3]; /* of a, b, s */
    int axis, sign;
} pir_opening_range;

typedef struct pir_opening_end {
    uint32_t vertex, to, halvings;
} pir_opening_end;

typedef struct pir_opening_block {
    uint32_t count, weight[3];
    pir_opening_end end[3][2]; /* below the planes, above */
} pir_opening_block;

static inline void pir_opening_plane(const pir_opening_range *range, double a, double b, double ret_u[3]) {
    ret_u[range->axis] = range->sign;
    ret_u[(range->axis + 1) % 3] = a;
    ret_u[(range->axis + 2) % 3] = b;
}

/*
 * Seeks a block of a cell. Gives by how much its tangent exceeds the square in doubles, −∞ where there are no
 * chords, and along which axis the cell is to be halved if that is not above 0.
 */
double pir_opening_block_seek(const pir_opening_body *body, const pir_opening_range *range, double square,
                              pir_opening_block *ret_block, int *ret_axis);

/* Whether a block is one, in rationals. */
bool pir_opening_block_holds(const pir_opening_body *body, const pir_opening_range *range, mpq_srcptr square,
                             const pir_opening_block *block);

#endif

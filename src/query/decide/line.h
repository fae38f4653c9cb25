/* SPDX-License-Identifier: MIT */
/*
 * A line x + λu against the facets of D (Cyrus and Beck, 1978): where it enters D and where it leaves.
 *
 * The line crosses a plane with slack s and rate r = n·u at λ = s/r: inwards where r < 0, outwards where r > 0. Where
 * r = 0 and s < 0 it misses D. It enters D at the last crossing inwards and leaves at the first crossing outwards.
 * Doubles bound s, r and their quotient. Integers decide what the bounds leave open: the sign of a rate, the order of
 * two crossings. So whether there is a hit is exact. The order of facets settles facets that are crossed at one
 * point.
 */
#ifndef PIR_QUERY_DECIDE_LINE_H
#define PIR_QUERY_DECIDE_LINE_H

#include "query/decide/touch.h"

typedef struct pir_line {
    const pir_placement *placement;
    pir_vec3 direction; /* as the caller gave it, where the translations are given */
    pir_vec3 u;         /* of unit length, in Q's frame */
    double part;        /* `direction` has the length part·2^exponent, which no double may hold */
    int exponent;
} pir_line;

/* Where a line crosses a facet, and what touches there. */
typedef struct pir_arrival {
    double at;   /* in the frame */
    bool within; /* whether that is within the length of its direction; exact */
    pir_vec3 normal;
    pir_touch touch;
} pir_arrival;

/* Bounds on a line's way through D so far. */
typedef struct pir_clip {
    double enter_low, leave_high; /* it enters no earlier than enter_low, and leaves no later than leave_high */
    bool misses;
    pir_least enter, leave;
} pir_clip;

#define PIR_CLIP_NONE ((pir_clip){.enter_low = -HUGE_VAL, .leave_high = HUGE_VAL})

/* A vector of any length as a unit vector and its length, part·2^exponent. False where it is zero. */
bool pir_unit_of(pir_vec3 v, pir_vec3 *ret_unit, double *ret_part, int *ret_exponent);

/* The line from a placement along a direction: PIR_ERR_NOT_FINITE, or PIR_ERR_ARGUMENT for a direction of length 0. */
static inline pir_status pir_line_make(const pir_placement *placement, pir_vec3 direction, pir_line *ret_line) {
    *ret_line = (pir_line){.placement = placement, .direction = direction};
    if (!pir_vec_is_finite(direction))
        return PIR_ERR_NOT_FINITE;
    bool is_direction = pir_unit_of(direction, &ret_line->u, &ret_line->part, &ret_line->exponent);
    return is_direction ? PIR_OK : PIR_ERR_ARGUMENT;
}

/*
 * Clips a line by the plane in a slot. The first pass over all planes bounds where it enters and leaves, the second
 * takes what the bounds leave open.
 */
void pir_clip_bound(const pir_planes *planes, const pir_line *line, pir_clip *clip, uint32_t slot);
void pir_clip_take(pir_exact *exact, const pir_planes *planes, const pir_line *line, pir_clip *clip, uint32_t slot);

/* The exact sign of n·u for a piece. */
int pir_line_rate(pir_exact *exact, const pir_line *line, pir_piece piece);

/* The exact sign of λ at the crossing of a minus λ at the crossing of b. Neither facet is parallel to the line. */
int pir_line_compare(pir_exact *exact, const pir_line *line, const pir_facet *a, const pir_facet *b);

/* The length along the line to a facet, in the frame, and a bound on its error. */
double pir_line_at(pir_exact *exact, const pir_line *line, const pir_facet *facet, double *ret_error);

/* The touch where the line crosses a facet. False where the crossing is not on the facet. */
bool pir_line_arrive(pir_exact *exact, const pir_line *line, const pir_facet *facet, pir_arrival *ret_arrival);

/*
 * S/D as a length along the line, where S is the dot product of a normal with a corner W, and D the one with the
 * direction's integers.
 */
double pir_line_length(pir_exact *exact, const pir_int3 *direction, const pir_int *s, const pir_int *d);

/* The sign of S/D − 1, where the direction's integers are on the scale 2^exponent. */
int pir_line_past_end(pir_exact *exact, const pir_int *s, const pir_int *d, int exponent);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * A line x + λu against the facets of D (Cyrus and Beck, 1978): where it enters and where it leaves.
 *
 * A plane with slack s and rate r = n·u is crossed at s/r: inwards where r < 0, outwards where r > 0; where r = 0 and s
 * < 0 the line misses D. It enters at the last crossing inwards and leaves at the first outwards. Doubles bound s, r
 * and their quotient; what the bounds leave open, the sign of a rate or the order of two crossings, is decided by
 * integers, so whether there is a hit is exact. Facets that are crossed at once are settled by the order of facets.
 */
#ifndef PIR_QUERY_DECIDE_LINE_H
#define PIR_QUERY_DECIDE_LINE_H

#include "query/decide/touch.h"

typedef struct pir_line {
    const pir_placement *placement;
    pir_vec3 direction; /* as it was given */
    pir_vec3 u;         /* of unit length */
    double length;      /* of `direction` */
} pir_line;

/* Where a line crosses a facet, and what touches there. */
typedef struct pir_arrival {
    double at;   /* in the frame */
    bool within; /* whether the line gets there within its direction's length; exact */
    pir_vec3 normal;
    pir_touch touch;
} pir_arrival;

/* What a line has met. */
typedef struct pir_clip {
    double enter_low, leave_high; /* it enters no earlier, and leaves no later */
    bool misses;
    pir_least enter, leave;
} pir_clip;

#define PIR_CLIP_NONE ((pir_clip){.enter_low = -HUGE_VAL, .leave_high = HUGE_VAL})

/* A vector of any length as a unit vector and its length; false when it is zero. */
bool pir_unit_of(pir_vec3 v, pir_vec3 *ret_unit, double *ret_length);

/* The line along a direction: PIR_ERR_NOT_FINITE, PIR_ERR_ARGUMENT for a direction of length 0. */
pir_status pir_line_make(const pir_placement *placement, pir_vec3 direction, pir_line *ret_line);

/* Clips by the plane in a slot: first all of them by bounds, then all again by what the bounds leave. */
void pir_clip_bound(const pir_planes *planes, const pir_line *line, pir_clip *clip, uint32_t slot);
void pir_clip_take(pir_exact *exact, const pir_planes *planes, const pir_line *line, pir_clip *clip, uint32_t slot);

/* The exact sign of n·u for a piece. */
int pir_line_rate(pir_exact *exact, const pir_line *line, pir_piece piece);

/* The exact sign of where a is crossed less where b is; neither is along the line. */
int pir_line_compare(pir_exact *exact, const pir_line *line, const pir_facet *a, const pir_facet *b);

/* How far along the line a facet is crossed, in the frame, and what that may be off by. */
double pir_line_at(pir_exact *exact, const pir_line *line, const pir_facet *facet, double *ret_error);

/* What touches where the line crosses a facet; false when the crossing is not on the facet. */
bool pir_line_arrive(pir_exact *exact, const pir_line *line, const pir_facet *facet, pir_arrival *ret_arrival);

/*
 * S/D as a length along the line, S the dot product of a normal with a corner W and D with the integers of the
 * direction.
 */
double pir_line_length(pir_exact *exact, const pir_int3 *direction, const pir_int *s, const pir_int *d);

/* The sign of S/D − 1 on that scale, `exponent` being the direction's. */
int pir_line_past_end(pir_exact *exact, const pir_int *s, const pir_int *d, int exponent);

#endif

/* SPDX-License-Identifier: MIT */
/* Overlaps of outlines in general position, of few corners each. */
#ifndef PIR_QUERY_CONTACT_CLIP_H
#define PIR_QUERY_CONTACT_CLIP_H

#include "query/contact/outline.h"

/* The most corners of an outline that pir_clip_place takes. */
#define PIR_CLIP_MOST 16

/* The answer where rounding might matter: see clip.c. */
#define PIR_CLIP_UNCLEAR UINT32_MAX

/* Corners are clear of a line at this many times `snap`. Corners that outline.c takes for one are at most 4 apart. */
#define PIR_CLIP_CLEAR 8

/* Where the corners of two outlines are, and which sides cross. */
typedef struct pir_clip_places {
    double inside[PIR_CLIP_MOST]
                 [PIR_CLIP_MOST];    /* [j][i]: corner i of P inside of line j of Q, times that side's length */
    uint32_t outside[PIR_CLIP_MOST]; /* per corner of P: the set of lines of Q that it is outside of */
    uint32_t crossed[PIR_CLIP_MOST]; /* per side of P: the set of sides of Q that it crosses */
    uint32_t entering, leaving;      /* the sets of sides of P that enter Q, and that leave it */
    uint32_t all_beyond;             /* the set of corners of Q that are outside of some line of P */
} pir_clip_places;

/*
 * Finds those. False where there are too many corners, where one is not clear of a line along a side of the other, or
 * where more sides cross than can: what is in `ret_places` then means nothing.
 */
bool pir_clip_place(pir_outline p, pir_outline q, double snap, pir_clip_places *ret_places);

/*
 * The corners that pir_outline_overlap and pir_outline_hull find, counter-clockwise, from any of them on. Both outlines
 * have three corners or more, each clear of the line through its neighbours. PIR_CLIP_UNCLEAR where a corner is not
 * clear of its neighbours; what is in `ret_corners` then means nothing. There is room for as many corners as both have.
 */
uint32_t pir_clip_corners(pir_outline p, pir_outline q, double snap, const pir_clip_places *places,
                          pir_corner *ret_corners);

#endif

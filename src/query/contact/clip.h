/* SPDX-License-Identifier: MIT */
/* Overlaps of outlines in general position, of few corners each. */
#ifndef PIR_QUERY_CONTACT_CLIP_H
#define PIR_QUERY_CONTACT_CLIP_H

#include "query/contact/outline.h"

/* The most corners of an outline that pir_outline_clip takes. */
#define PIR_CLIP_MOST 16

/* What it answers where rounding might matter: see clip.c. */
#define PIR_CLIP_UNCLEAR UINT32_MAX

/* Corners are clear of a line at this many times `snap`. Corners that outline.c takes for one are at most 4 apart. */
#define PIR_CLIP_CLEAR 8

/* Where the corners of two outlines are. */
typedef struct pir_clip_places {
    double inside[PIR_CLIP_MOST][PIR_CLIP_MOST]; /* corner i of P inside of line j of Q, times the side's length */
    uint32_t outside[PIR_CLIP_MOST];             /* per corner of P: the set of lines of Q that it is outside of */
    uint32_t beyond[PIR_CLIP_MOST];              /* per line of P: the set of corners of Q that are outside of it */
} pir_clip_places;

/* Finds those. False where one is not clear. In versions for processors, which give the same bits. */
typedef bool pir_clip_place(pir_outline p, pir_outline q, double snap, pir_clip_places *ret_places);

/* Version `index`, the plain one first; NULL past those that this machine can run. */
pir_clip_place *pir_clip_place_version(unsigned index);

/* The last of them. */
pir_clip_place *pir_clip_place_best(void);

/*
 * The corners that pir_outline_overlap and pir_outline_hull find, counter-clockwise, from any of them on. Both outlines
 * have three corners or more, each clear of the line through its neighbours. PIR_CLIP_UNCLEAR where there are too many,
 * or where a corner of one is not clear of a line along a side of the other; what is in `ret_corners` then means
 * nothing. There is room for as many corners as both have. O(p · q).
 */
uint32_t pir_outline_clip(pir_outline p, pir_outline q, double snap, pir_clip_place *place, pir_corner *ret_corners);

#endif

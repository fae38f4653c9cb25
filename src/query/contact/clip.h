/* SPDX-License-Identifier: MIT */
/* Overlaps of outlines in general position, of few corners each. */
#ifndef PIR_QUERY_CONTACT_CLIP_H
#define PIR_QUERY_CONTACT_CLIP_H

#include "query/contact/outline.h"

/* The most corners of an outline that pir_outline_clip takes. */
#define PIR_CLIP_MOST 16

/* What it answers where rounding might matter. */
#define PIR_CLIP_UNCLEAR UINT32_MAX

/*
 * Whether three corners or more, counter-clockwise, are certain to be their own hull, and no segment: as they would
 * come from pir_outline_hull and pir_outline_slim.
 */
bool pir_outline_is_clear(pir_outline outline, double snap, double part);

/*
 * The corners that pir_outline_overlap and pir_outline_hull find for two outlines that are clear, counter-clockwise,
 * from any of them on. PIR_CLIP_UNCLEAR where an outline has too many corners, or where a corner of one is so near a
 * line along a side of the other that rounding might matter; what is in `ret_corners` then means nothing. There is
 * room for as many corners as both have. O(p · q).
 */
uint32_t pir_outline_clip(pir_outline p, pir_outline q, double snap, pir_corner *ret_corners);

#endif

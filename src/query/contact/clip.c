/* SPDX-License-Identifier: MIT */
/*
 * Two outlines are in general position where every corner of each is clear of every line along a side of the other, by
 * more than any rounding and any merging of outline.c. It is then certain which corners are inside of which lines,
 * and these signs tell the rest:
 *
 *   - A corner is in the other outline where it is inside of all of its lines.
 *   - Two sides cross where the ends of each are on different sides of the other's line. A side crosses the rim of
 *     the other outline once where it enters, at a line that its start is outside of, and once where it leaves.
 *   - Between the side of Q by which P's rim leaves Q and the one by which it enters again, the corners of Q are in P.
 *
 * So walking once around P meets the corners of the overlap in order.
 */
#include "query/contact/clip.h"

#include <math.h>
#include <stddef.h>

struct clip {
    pir_outline p, q;
    const pir_clip_places *places;
    pir_corner *corners;
    uint32_t count;
};

/* --- where corners are --- */

/* A line along a side: how far a point is inside, times the side's length, is u · v' − v · u' − at. */
struct side_line {
    double u, v, at, clear;
};

static inline struct side_line line_along(pir_outline outline, uint32_t i, double snap) {
    const pir_corner *a = &outline.at[i], *b = &outline.at[i + 1 < outline.count ? i + 1 : 0];
    double u = b->u - a->u, v = b->v - a->v;
    return (struct side_line){u, v, u * a->v - v * a->u, PIR_CLIP_CLEAR * snap * (fabs(u) + fabs(v))};
}

static inline double inside_of(const struct side_line *line, const pir_corner *x) {
    return line->u * x->v - line->v * x->u - line->at;
}

static inline bool is_at_most_one(uint32_t set) {
    return (set & (set - 1)) == 0;
}

/* Sets which sides cross, from where the corners are. False where more do than can. */
static bool find_crossings(uint32_t p, uint32_t q, const uint32_t beyond[], pir_clip_places *places) {
    bool can = true;
    places->entering = places->leaving = 0;
    for (uint32_t i = 0; i < p; i++) {
        uint32_t start = places->outside[i], end = places->outside[i + 1 < p ? i + 1 : 0];
        uint32_t next = beyond[i] >> 1 | (beyond[i] & 1) << (q - 1), crossed = (beyond[i] ^ next) & (start ^ end);
        uint32_t enters = crossed & start, leaves = crossed & end;
        can &= is_at_most_one(enters) && is_at_most_one(leaves);
        places->crossed[i] = crossed;
        places->entering |= (uint32_t)(enters != 0) << i;
        places->leaving |= (uint32_t)(leaves != 0) << i;
    }
    return can;
}

bool pir_clip_place(pir_outline p, pir_outline q, double snap, pir_clip_places *places) {
    uint32_t beyond[PIR_CLIP_MOST];
    bool clear = true;
    if (p.count > PIR_CLIP_MOST || q.count > PIR_CLIP_MOST)
        return false;
    for (uint32_t i = 0; i < p.count; i++)
        places->outside[i] = 0;
    for (uint32_t j = 0; j < q.count; j++) {
        struct side_line line = line_along(q, j, snap);
        for (uint32_t i = 0; i < p.count; i++) {
            double inside = inside_of(&line, &p.at[i]);
            places->inside[j][i] = inside;
            clear &= fabs(inside) > line.clear;
            places->outside[i] |= (uint32_t)(inside < 0) << j;
        }
    }
    places->all_beyond = 0;
    for (uint32_t i = 0; i < p.count; i++) {
        struct side_line line = line_along(p, i, snap);
        beyond[i] = 0;
        for (uint32_t j = 0; j < q.count; j++) {
            double inside = inside_of(&line, &q.at[j]);
            clear &= fabs(inside) > line.clear;
            beyond[i] |= (uint32_t)(inside < 0) << j;
        }
        places->all_beyond |= beyond[i];
    }
    return find_crossings(p.count, q.count, beyond, places) && clear;
}

/* --- corners --- */

/* The side in a set of one. */
static inline uint32_t only(uint32_t set) {
    return (uint32_t)__builtin_ctz(set);
}

static inline void put_corner(struct clip *clip, pir_corner_kind kind, uint32_t i) {
    const pir_corner *at = kind == PIR_CORNER_P ? &clip->p.at[i] : &clip->q.at[i];
    clip->corners[clip->count++] = (pir_corner){at->u, at->v, kind, i, i};
}

static inline void put_crossing(struct clip *clip, uint32_t i, uint32_t j) {
    uint32_t end = i + 1 < clip->p.count ? i + 1 : 0;
    double from = clip->places->inside[j][i], part = from / (from - clip->places->inside[j][end]);
    const pir_corner *a = &clip->p.at[i], *b = &clip->p.at[end];
    clip->corners[clip->count++] =
        (pir_corner){a->u + part * (b->u - a->u), a->v + part * (b->v - a->v), PIR_CORNER_CROSSING, i, j};
}

/* The corners of the outline that lies in the other, where their rims do not cross. */
static void put_all(struct clip *clip) {
    bool of_p = clip->places->outside[0] == 0;
    uint32_t count = of_p ? clip->p.count : clip->places->all_beyond == 0 ? clip->q.count : 0;
    for (uint32_t i = 0; i < count; i++)
        put_corner(clip, of_p ? PIR_CORNER_P : PIR_CORNER_Q, i);
}

/* Walks around P, from the end of side `first`, by which P leaves Q. */
static void walk(struct clip *clip, uint32_t first) {
    uint32_t p = clip->p.count, q = clip->q.count,
             left = only(clip->places->crossed[first] & ~clip->places->outside[first]);
    put_crossing(clip, first, left);
    for (uint32_t k = 1, i = first; k <= p; k++) {
        i = i + 1 < p ? i + 1 : 0;
        uint32_t enters = clip->places->crossed[i] & clip->places->outside[i],
                 leaves = clip->places->crossed[i] & ~clip->places->outside[i];
        if (enters) {
            uint32_t entered = only(enters);
            while (left != entered) {
                left = left + 1 < q ? left + 1 : 0;
                put_corner(clip, PIR_CORNER_Q, left);
            }
            put_crossing(clip, i, entered);
        } else if (clip->places->outside[i] == 0) {
            put_corner(clip, PIR_CORNER_P, i);
        }
        if (leaves && k < p) {
            left = only(leaves);
            put_crossing(clip, i, left);
        }
    }
}

/* The walk where P enters Q once, so that all corners after that, up to where it leaves, are in Q. */
static void walk_once(struct clip *clip) {
    uint32_t p = clip->p.count, q = clip->q.count, first = only(clip->places->leaving),
             i = only(clip->places->entering);
    uint32_t left = only(clip->places->crossed[first] & ~clip->places->outside[first]);
    uint32_t entered = only(clip->places->crossed[i] & clip->places->outside[i]);
    put_crossing(clip, first, left);
    while (left != entered) {
        left = left + 1 < q ? left + 1 : 0;
        put_corner(clip, PIR_CORNER_Q, left);
    }
    put_crossing(clip, i, entered);
    while (i != first) {
        i = i + 1 < p ? i + 1 : 0;
        put_corner(clip, PIR_CORNER_P, i);
    }
}

/* Whether each corner turns left, and is clear of the line through its neighbours. */
static bool is_hull(const pir_corner *at, uint32_t count, double snap) {
    bool clear = count > 2;
    double u = at[0].u - at[count - 1].u, v = at[0].v - at[count - 1].v, size = fabs(u) + fabs(v);
    for (uint32_t i = 0; i < count; i++) {
        const pir_corner *a = &at[i], *b = &at[i + 1 < count ? i + 1 : 0];
        double s = b->u - a->u, t = b->v - a->v, next = fabs(s) + fabs(t);
        clear &= u * t - v * s > PIR_CLIP_CLEAR * snap * (size + next);
        u = s;
        v = t;
        size = next;
    }
    return clear;
}

uint32_t pir_clip_corners(pir_outline p, pir_outline q, double snap, const pir_clip_places *places,
                          pir_corner *ret_corners) {
    struct clip clip = {p, q, places, ret_corners, 0};
    if (places->leaving == 0)
        put_all(&clip);
    else if (places->entering != 0 && is_at_most_one(places->leaving) && is_at_most_one(places->entering))
        walk_once(&clip);
    else
        walk(&clip, (uint32_t)__builtin_ctz(places->leaving));
    return clip.count == 0 || is_hull(ret_corners, clip.count, snap) ? clip.count : PIR_CLIP_UNCLEAR;
}

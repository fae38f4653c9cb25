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
#include "query/contact/clip_versions.h"

#include <math.h>
#include <stddef.h>

struct clip {
    pir_outline p, q;
    pir_clip_places places;
    uint32_t crossed[PIR_CLIP_MOST]; /* per side of P: the set of sides of Q that it crosses */
    uint32_t entering, leaving;      /* the sets of sides of P that enter Q, and that leave it */
    pir_corner *corners;
    uint32_t count;
};

/* --- where corners are --- */

/* A line along a side: how far a point is inside, times the side's length, is u · v' − v · u' − at. */
struct line {
    double u, v, at, clear;
};

static inline struct line line_along(pir_outline outline, uint32_t i, double snap) {
    const pir_corner *a = &outline.at[i], *b = &outline.at[i + 1 < outline.count ? i + 1 : 0];
    double u = b->u - a->u, v = b->v - a->v;
    return (struct line){u, v, u * a->v - v * a->u, PIR_CLIP_CLEAR * snap * (fabs(u) + fabs(v))};
}

static inline double inside_of(const struct line *line, const pir_corner *x) {
    return line->u * x->v - line->v * x->u - line->at;
}

static bool place_plain(pir_outline p, pir_outline q, double snap, pir_clip_places *places) {
    bool clear = true;
    for (uint32_t i = 0; i < p.count; i++)
        places->outside[i] = 0;
    for (uint32_t j = 0; j < q.count; j++) {
        struct line line = line_along(q, j, snap);
        for (uint32_t i = 0; i < p.count; i++) {
            double inside = inside_of(&line, &p.at[i]);
            places->inside[i][j] = inside;
            clear &= fabs(inside) > line.clear;
            places->outside[i] |= (uint32_t)(inside < 0) << j;
        }
    }
    for (uint32_t i = 0; i < p.count; i++) {
        struct line line = line_along(p, i, snap);
        places->beyond[i] = 0;
        for (uint32_t j = 0; j < q.count; j++) {
            double inside = inside_of(&line, &q.at[j]);
            clear &= fabs(inside) > line.clear;
            places->beyond[i] |= (uint32_t)(inside < 0) << j;
        }
    }
    return clear;
}

pir_clip_place *pir_clip_place_version(unsigned index) {
    if (index == 0)
        return place_plain;
#if PIR_HAVE_X86_CLIP
    if (index == 1 && __builtin_cpu_supports("avx2"))
        return pir_clip_place_avx2;
#endif
    return NULL;
}

pir_clip_place *pir_clip_place_best(void) {
    unsigned index = 0;
    while (pir_clip_place_version(index + 1))
        index++;
    return pir_clip_place_version(index);
}

/* --- which sides cross --- */

static inline bool is_at_most_one(uint32_t set) {
    return (set & (set - 1)) == 0;
}

/* False where more sides cross than can. */
static bool find_crossings(struct clip *clip) {
    const pir_clip_places *places = &clip->places;
    uint32_t p = clip->p.count, q = clip->q.count;
    bool can = true;
    clip->entering = clip->leaving = 0;
    for (uint32_t i = 0; i < p; i++) {
        uint32_t beyond = places->beyond[i], start = places->outside[i], end = places->outside[i + 1 < p ? i + 1 : 0];
        uint32_t next = beyond >> 1 | (beyond & 1) << (q - 1), crossed = (beyond ^ next) & (start ^ end);
        uint32_t enters = crossed & start, leaves = crossed & end;
        can &= is_at_most_one(enters) && is_at_most_one(leaves);
        clip->crossed[i] = crossed;
        clip->entering |= (uint32_t)(enters != 0) << i;
        clip->leaving |= (uint32_t)(leaves != 0) << i;
    }
    return can;
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
    double from = clip->places.inside[i][j], part = from / (from - clip->places.inside[end][j]);
    const pir_corner *a = &clip->p.at[i], *b = &clip->p.at[end];
    clip->corners[clip->count++] =
        (pir_corner){a->u + part * (b->u - a->u), a->v + part * (b->v - a->v), PIR_CORNER_CROSSING, i, j};
}

/* The corners of the outline that lies in the other, where their rims do not cross. */
static void put_all(struct clip *clip) {
    uint32_t beyond = 0;
    for (uint32_t i = 0; i < clip->p.count; i++)
        beyond |= clip->places.beyond[i];
    bool of_p = clip->places.outside[0] == 0;
    uint32_t count = of_p ? clip->p.count : beyond == 0 ? clip->q.count : 0;
    for (uint32_t i = 0; i < count; i++)
        put_corner(clip, of_p ? PIR_CORNER_P : PIR_CORNER_Q, i);
}

/* Walks around P, from the end of side `first`, by which P leaves Q. */
static void walk(struct clip *clip, uint32_t first) {
    uint32_t p = clip->p.count, q = clip->q.count, left = only(clip->crossed[first] & ~clip->places.outside[first]);
    put_crossing(clip, first, left);
    for (uint32_t k = 1, i = first; k <= p; k++) {
        i = i + 1 < p ? i + 1 : 0;
        uint32_t enters = clip->crossed[i] & clip->places.outside[i],
                 leaves = clip->crossed[i] & ~clip->places.outside[i];
        if (enters) {
            uint32_t entered = only(enters);
            while (left != entered) {
                left = left + 1 < q ? left + 1 : 0;
                put_corner(clip, PIR_CORNER_Q, left);
            }
            put_crossing(clip, i, entered);
        } else if (clip->places.outside[i] == 0) {
            put_corner(clip, PIR_CORNER_P, i);
        }
        if (leaves && k < p) {
            left = only(leaves);
            put_crossing(clip, i, left);
        }
    }
}

/* The same walk where P enters Q once, so that all corners after that, up to where it leaves, are in Q. */
static void walk_once(struct clip *clip) {
    uint32_t p = clip->p.count, q = clip->q.count, first = only(clip->leaving), i = only(clip->entering);
    uint32_t left = only(clip->crossed[first] & ~clip->places.outside[first]);
    uint32_t entered = only(clip->crossed[i] & clip->places.outside[i]);
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

uint32_t pir_outline_clip(pir_outline p, pir_outline q, double snap, pir_clip_place *place, pir_corner *ret_corners) {
    if (p.count > PIR_CLIP_MOST || q.count > PIR_CLIP_MOST)
        return PIR_CLIP_UNCLEAR;
    struct clip clip;
    clip.p = p;
    clip.q = q;
    clip.corners = ret_corners;
    clip.count = 0;
    if (!place(p, q, snap, &clip.places) || !find_crossings(&clip))
        return PIR_CLIP_UNCLEAR;
    if (clip.leaving == 0)
        put_all(&clip);
    else if (clip.entering != 0 && is_at_most_one(clip.leaving) && is_at_most_one(clip.entering))
        walk_once(&clip);
    else
        walk(&clip, (uint32_t)__builtin_ctz(clip.leaving));
    return clip.count == 0 || is_hull(ret_corners, clip.count, snap) ? clip.count : PIR_CLIP_UNCLEAR;
}

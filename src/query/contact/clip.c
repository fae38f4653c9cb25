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

/*
 * A corner is clear of a line at this many times `snap`. Corners that outline.c takes for one are at most 4 snaps
 * apart.
 */
#define CLEAR 8

/* The sides of an outline as vectors, and what a corner has to exceed to be clear of each, times its length. */
struct sides {
    double u[PIR_CLIP_MOST], v[PIR_CLIP_MOST], clear[PIR_CLIP_MOST];
};

static void set_sides(pir_outline outline, double snap, struct sides *ret_sides) {
    for (uint32_t i = 0; i < outline.count; i++) {
        const pir_corner *a = &outline.at[i], *b = &outline.at[i + 1 < outline.count ? i + 1 : 0];
        double u = b->u - a->u, v = b->v - a->v;
        ret_sides->u[i] = u;
        ret_sides->v[i] = v;
        ret_sides->clear[i] = CLEAR * snap * (fabs(u) + fabs(v));
    }
}

/*
 * How far corners are inside of lines, times the length of the side, and a set of the lines that each is outside of.
 * False where one is not clear.
 */
static bool find_insides(pir_outline of, pir_outline by, const struct sides *sides, double (*ret_inside)[PIR_CLIP_MOST],
                         uint32_t *ret_outside) {
    bool clear = true;
    for (uint32_t i = 0; i < of.count; i++) {
        double u = of.at[i].u, v = of.at[i].v;
        uint32_t outside = 0;
        for (uint32_t j = 0; j < by.count; j++) {
            double inside = sides->u[j] * (v - by.at[j].v) - sides->v[j] * (u - by.at[j].u);
            ret_inside[i][j] = inside;
            clear &= fabs(inside) > sides->clear[j];
            outside |= (uint32_t)(inside < 0) << j;
        }
        ret_outside[i] = outside;
    }
    return clear;
}

struct clip {
    pir_outline p, q;
    struct sides of_p, of_q;
    double inside_q[PIR_CLIP_MOST][PIR_CLIP_MOST], inside_p[PIR_CLIP_MOST][PIR_CLIP_MOST];
    uint32_t outside_q[PIR_CLIP_MOST], outside_p[PIR_CLIP_MOST]; /* per corner of P, of Q: sets of lines */
    uint32_t crossed[PIR_CLIP_MOST];                             /* per side of P: the set of sides that it crosses */
    pir_corner *corners;
    uint32_t count;
};

/* Sets which sides of Q each side of P crosses. False where one crosses more than convex outlines can. */
static bool find_crossings(struct clip *clip) {
    uint32_t p = clip->p.count, q = clip->q.count;
    for (uint32_t i = 0; i < p; i++) {
        uint32_t beyond = 0; // corners of Q
        for (uint32_t j = 0; j < q; j++)
            beyond |= (clip->outside_p[j] >> i & 1) << j;
        uint32_t next = beyond >> 1 | (beyond & 1) << (q - 1), end = clip->outside_q[i + 1 < p ? i + 1 : 0];
        uint32_t crossed = (beyond ^ next) & (clip->outside_q[i] ^ end);
        clip->crossed[i] = crossed;
        uint32_t enters = crossed & clip->outside_q[i], leaves = crossed & end;
        if ((enters & (enters - 1)) != 0 || (leaves & (leaves - 1)) != 0)
            return false;
    }
    return true;
}

/* The side of Q in a set of one. */
static uint32_t only(uint32_t set) {
    uint32_t j = 0;
    while (!(set >> j & 1))
        j++;
    return j;
}

static void put_corner(struct clip *clip, pir_corner_kind kind, uint32_t i) {
    const pir_corner *at = kind == PIR_CORNER_P ? &clip->p.at[i] : &clip->q.at[i];
    clip->corners[clip->count++] = (pir_corner){at->u, at->v, kind, i, i};
}

static void put_crossing(struct clip *clip, uint32_t i, uint32_t j) {
    double from = clip->inside_q[i][j], to = clip->inside_q[i + 1 < clip->p.count ? i + 1 : 0][j];
    double part = from / (from - to);
    const pir_corner *a = &clip->p.at[i];
    clip->corners[clip->count++] =
        (pir_corner){a->u + part * clip->of_p.u[i], a->v + part * clip->of_p.v[i], PIR_CORNER_CROSSING, i, j};
}

/* The corners of one outline that lies in the other, where their rims do not cross. */
static void put_all(struct clip *clip) {
    uint32_t outside = 0;
    for (uint32_t j = 0; j < clip->q.count; j++)
        outside |= clip->outside_p[j];
    bool of_p = clip->outside_q[0] == 0;
    uint32_t count = of_p ? clip->p.count : outside == 0 ? clip->q.count : 0;
    for (uint32_t i = 0; i < count; i++)
        put_corner(clip, of_p ? PIR_CORNER_P : PIR_CORNER_Q, i);
}

/* Walks around P, from the end of side `first`, by which P leaves Q. */
static void walk(struct clip *clip, uint32_t first) {
    uint32_t p = clip->p.count, q = clip->q.count, left = 0;
    for (uint32_t k = 0, i = first; k <= p; k++, i = i + 1 < p ? i + 1 : 0) {
        uint32_t enters = clip->crossed[i] & clip->outside_q[i], leaves = clip->crossed[i] & ~clip->outside_q[i];
        if (k > 0 && enters) {
            uint32_t entered = only(enters);
            for (uint32_t j = left; j != entered;) {
                j = j + 1 < q ? j + 1 : 0;
                put_corner(clip, PIR_CORNER_Q, j);
            }
            put_crossing(clip, i, entered);
        } else if (k > 0 && clip->outside_q[i] == 0) {
            put_corner(clip, PIR_CORNER_P, i);
        }
        if (leaves) {
            left = only(leaves);
            if (k < p)
                put_crossing(clip, i, left);
        }
    }
}

/* Whether each corner turns left, and is clear of the line through its neighbours. */
static bool turns_left(const pir_corner *at, uint32_t count, double snap) {
    bool clear = true;
    for (uint32_t i = 0; i < count; i++) {
        const pir_corner *b = &at[i + 1 < count ? i + 1 : 0], *c = &at[i + 2 < count ? i + 2 : i + 2 - count];
        double u = b->u - at[i].u, v = b->v - at[i].v, s = c->u - b->u, t = c->v - b->v;
        clear &= u * t - v * s > CLEAR * snap * (fabs(u) + fabs(v) + fabs(s) + fabs(t));
    }
    return clear;
}

bool pir_outline_is_clear(pir_outline outline, double snap, double part) {
    if (outline.count < 3 || outline.count > PIR_CLIP_MOST || !turns_left(outline.at, outline.count, snap))
        return false;
    // twice the area of a corner's triangle is at most twice that of the outline, whose width times length is more
    double most = 0, around = 0;
    for (uint32_t i = 0; i < outline.count; i++) {
        const pir_corner *a = &outline.at[i], *b = &outline.at[i + 1 < outline.count ? i + 1 : 0];
        const pir_corner *c = &outline.at[i + 2 < outline.count ? i + 2 : i + 2 - outline.count];
        double u = b->u - a->u, v = b->v - a->v;
        most = fmax(most, u * (c->v - b->v) - v * (c->u - b->u));
        around += fabs(u) + fabs(v);
    }
    return most > part * around * around;
}

uint32_t pir_outline_clip(pir_outline p, pir_outline q, double snap, pir_corner *ret_corners) {
    if (p.count > PIR_CLIP_MOST || q.count > PIR_CLIP_MOST)
        return PIR_CLIP_UNCLEAR;
    struct clip clip;
    clip.p = p;
    clip.q = q;
    clip.corners = ret_corners;
    clip.count = 0;
    set_sides(p, snap, &clip.of_p);
    set_sides(q, snap, &clip.of_q);
    if (!find_insides(p, q, &clip.of_q, clip.inside_q, clip.outside_q) ||
        !find_insides(q, p, &clip.of_p, clip.inside_p, clip.outside_p) || !find_crossings(&clip))
        return PIR_CLIP_UNCLEAR;
    uint32_t first = 0;
    while (first < p.count && !(clip.crossed[first] & ~clip.outside_q[first]))
        first++;
    if (first == p.count)
        put_all(&clip);
    else
        walk(&clip, first);
    return clip.count == 0 || (clip.count > 2 && turns_left(ret_corners, clip.count, snap)) ? clip.count
                                                                                            : PIR_CLIP_UNCLEAR;
}

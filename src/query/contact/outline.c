/* SPDX-License-Identifier: MIT */
/*
 * Hulls come from two monotone chains (Andrew, Information Processing Letters 9(5), 1979). The overlap of two convex
 * polygons comes from the corners of each that lie in the other and from the sides that cross (after Cyrus and Beck,
 * Computers and Graphics 3(1), 1978).
 *
 * Contacts are floating answers and need a tolerance. Corners that would be one point, or on one line, but for
 * rounding must not come and go from frame to frame. So every test leaves `snap` to the side that merges.
 */
#include "query/contact/outline.h"

#include <math.h>
#include <string.h>

double pir_outline_distance(const pir_corner *a, const pir_corner *b) {
    double u = a->u - b->u, v = a->v - b->v;
    return sqrt(u * u + v * v);
}

/* --- hulls --- */

static void sift(pir_corner *points, uint32_t from, uint32_t count) {
    pir_corner moved = points[from];
    for (uint32_t child; (child = 2 * from + 1) < count; from = child) {
        if (child + 1 < count && pir_corner_before(&points[child], &points[child + 1]))
            child++;
        if (!pir_corner_before(&moved, &points[child]))
            break;
        points[from] = points[child];
    }
    points[from] = moved;
}

/* Heapsort: in place, without recursion. */
static void sort(pir_corner *points, uint32_t count) {
    for (uint32_t i = count / 2; i-- > 0;)
        sift(points, i, count);
    for (uint32_t end = count; end-- > 1;) {
        pir_corner last = points[end];
        points[end] = points[0];
        points[0] = last;
        sift(points, 0, end);
    }
}

/* Whether b lies to the right of the line from a to c. */
static bool is_right(const pir_corner *a, const pir_corner *b, const pir_corner *c) {
    return (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u) > 0;
}

/*
 * Whether b is farther than `snap` from the segment from a to c. The distance to the line would not do: b may lie
 * beyond an end.
 */
static bool stands_out(const pir_corner *a, const pir_corner *b, const pir_corner *c, double snap) {
    double u = c->u - a->u, v = c->v - a->v, square = u * u + v * v;
    double along = square > 0 ? (u * (b->u - a->u) + v * (b->v - a->v)) / square : 0;
    double t = fmin(1, fmax(0, along)), x = b->u - a->u - t * u, y = b->v - a->v - t * v;
    return x * x + y * y > snap * snap;
}

/* Drops corners at both ends of the list as long as they stand out by at most `snap`. */
static uint32_t drop_ends(pir_corner *hull, uint32_t count, double snap) {
    uint32_t first = 0, end = count;
    for (bool dropped = true; dropped && end - first > 2;) {
        dropped = true;
        if (!stands_out(&hull[end - 2], &hull[end - 1], &hull[first], snap))
            end--;
        else if (!stands_out(&hull[end - 1], &hull[first], &hull[first + 1], snap))
            first++;
        else
            dropped = false;
    }
    memmove(hull, hull + first, (end - first) * sizeof *hull);
    count = end - first;
    return count == 2 && pir_outline_distance(&hull[0], &hull[1]) <= snap ? 1 : count;
}

uint32_t pir_outline_hull(pir_corner *points, uint32_t count, double snap, pir_corner *room) {
    if (count < 2)
        return count;
    sort(points, count);
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; i++) {
        while (n > 1 && !is_right(&room[n - 2], &room[n - 1], &points[i]))
            n--;
        room[n++] = points[i];
    }
    // the other chain, backwards; its last point is the first of all
    for (uint32_t i = count - 1, lower = n; i-- > 0;) {
        while (n > lower && !is_right(&room[n - 2], &room[n - 1], &points[i]))
            n--;
        room[n++] = points[i];
    }
    // the corners are in order now: those that only rounding made go
    uint32_t kept = 0;
    for (uint32_t i = 0; i + 1 < n; i++) {
        while (kept > 1 && !stands_out(&points[kept - 2], &points[kept - 1], &room[i], snap))
            kept--;
        points[kept++] = room[i];
    }
    return drop_ends(points, kept, snap);
}

static uint32_t farthest(const pir_corner *hull, uint32_t count, const pir_corner *from) {
    uint32_t best = 0;
    for (uint32_t i = 1; i < count; i++)
        if (pir_outline_distance(from, &hull[i]) > pir_outline_distance(from, &hull[best]))
            best = i;
    return best;
}

uint32_t pir_outline_slim(pir_corner *hull, uint32_t count, double part) {
    if (count < 3)
        return count;
    pir_corner a = hull[farthest(hull, count, &hull[0])], b = hull[farthest(hull, count, &a)];
    double u = b.u - a.u, v = b.v - a.v, low = 0, high = 0;
    for (uint32_t i = 0; i < count; i++) {
        double beside = u * (hull[i].v - a.v) - v * (hull[i].u - a.u);
        low = fmin(low, beside);
        high = fmax(high, beside);
    }
    if (high - low > part * (u * u + v * v))
        return count;
    hull[0] = a;
    hull[1] = b;
    return 2;
}

/* --- overlaps --- */

/* The signed distance of a point from side `side` of an outline, positive inside. The side is longer than `snap`. */
static double inside_of(pir_outline outline, uint32_t side, const pir_corner *x) {
    const pir_corner *a = &outline.at[side], *b = &outline.at[side + 1 < outline.count ? side + 1 : 0];
    double u = b->u - a->u, v = b->v - a->v;
    return (u * (x->v - a->v) - v * (x->u - a->u)) / sqrt(u * u + v * v);
}

#define NO_SIDE UINT32_MAX

/*
 * The part of a segment that lies in an outline, as fractions of the segment, and the sides that it ends at: NO_SIDE
 * where it ends at an end of the segment.
 */
struct part {
    double from, to;
    uint32_t entered, left;
};

/* False when the segment from a to b is nowhere within `snap` of the inside. */
static bool part_inside(pir_outline outline, const pir_corner *a, const pir_corner *b, double snap,
                        struct part *ret_part) {
    struct part part = {0, 1, NO_SIDE, NO_SIDE};
    for (uint32_t i = 0; i < outline.count; i++) {
        double from = inside_of(outline, i, a) + snap, to = inside_of(outline, i, b) + snap;
        if (from < 0 && to < 0)
            return false;
        if (from < 0 && from / (from - to) > part.from) {
            part.from = from / (from - to);
            part.entered = i;
        }
        if (to < 0 && from / (from - to) < part.to) {
            part.to = from / (from - to);
            part.left = i;
        }
    }
    *ret_part = part;
    return part.from <= part.to;
}

/* A cut of one outline by another. How a corner is named depends on which outline is P's. */
struct cut {
    pir_outline of, by;
    bool of_p;
    double snap;
    pir_corner *corners;
    uint32_t count;
};

static void put(struct cut *cut, const pir_corner *at, pir_corner_kind kind, uint32_t p, uint32_t q) {
    cut->corners[cut->count++] = (pir_corner){at->u, at->v, kind, p, q};
}

static void put_own(struct cut *cut, uint32_t i) {
    put(cut, &cut->of.at[i], cut->of_p ? PIR_CORNER_P : PIR_CORNER_Q, i, i);
}

static void put_other(struct cut *cut, uint32_t j) {
    put(cut, &cut->by.at[j], cut->of_p ? PIR_CORNER_Q : PIR_CORNER_P, j, j);
}

/* Whether two corners are one point. Each may be off by `snap` along two sides. */
static bool is_one(const struct cut *cut, const pir_corner *a, const pir_corner *b) {
    return pir_outline_distance(a, b) <= 4 * cut->snap;
}

/* The point at fraction t of the segment from a to b. */
static pir_corner between(const pir_corner *a, const pir_corner *b, double t) {
    return (pir_corner){a->u + t * (b->u - a->u), a->v + t * (b->v - a->v), PIR_CORNER_CROSSING, 0, 0};
}

/* Where the segments from a to b and from c to d cross; false where they do not. */
static bool cross_at(const pir_corner *a, const pir_corner *b, const pir_corner *c, const pir_corner *d,
                     pir_corner *ret_at) {
    double u = d->u - c->u, v = d->v - c->v;
    double from = u * (a->v - c->v) - v * (a->u - c->u), to = u * (b->v - c->v) - v * (b->u - c->u);
    if ((from < 0) == (to < 0))
        return false;
    pir_corner x = between(a, b, from / (from - to));
    double along = u * (x.u - c->u) + v * (x.v - c->v);
    *ret_at = x;
    return along >= 0 && along <= u * u + v * v;
}

/*
 * Puts the crossing of side i of `of` and side j of `by`. Where side i only comes within `snap` of side j, it is the
 * point at fraction `part` of side i. Where a corner of either outline is there, that corner takes its place.
 */
static void put_crossing(struct cut *cut, uint32_t i, uint32_t j, double part) {
    uint32_t i_end = i + 1 < cut->of.count ? i + 1 : 0, j_end = j + 1 < cut->by.count ? j + 1 : 0;
    const pir_corner *a = &cut->of.at[i], *b = &cut->of.at[i_end];
    pir_corner x;
    if (!cross_at(a, b, &cut->by.at[j], &cut->by.at[j_end], &x))
        x = between(a, b, part);
    if (is_one(cut, &x, a))
        put_own(cut, i);
    else if (is_one(cut, &x, b))
        put_own(cut, i_end);
    else if (is_one(cut, &x, &cut->by.at[j]))
        put_other(cut, j);
    else if (is_one(cut, &x, &cut->by.at[j_end]))
        put_other(cut, j_end);
    else
        put(cut, &x, PIR_CORNER_CROSSING, cut->of_p ? i : j, cut->of_p ? j : i);
}

/* Puts the corners and crossings of every side of `of`. */
static void cut_sides(struct cut *cut) {
    uint32_t sides = cut->of.count > 2 ? cut->of.count : 1;
    for (uint32_t i = 0; i < sides; i++) {
        uint32_t end = i + 1 < cut->of.count ? i + 1 : 0;
        struct part part;
        if (!part_inside(cut->by, &cut->of.at[i], &cut->of.at[end], cut->snap, &part))
            continue;
        if (part.entered == NO_SIDE)
            put_own(cut, i);
        else
            put_crossing(cut, i, part.entered, part.from);
        if (part.left != NO_SIDE)
            put_crossing(cut, i, part.left, part.to);
        else if (sides == 1)
            put_own(cut, end);
    }
}

/* Puts the corners of `by` that lie in `of`. Those at a corner of `of` are put as that corner. */
static void put_others_inside(struct cut *cut) {
    for (uint32_t j = 0; j < cut->by.count; j++) {
        const pir_corner *x = &cut->by.at[j];
        bool inside = true;
        uint32_t same = NO_SIDE;
        for (uint32_t i = 0; i < cut->of.count && inside; i++) {
            inside = inside_of(cut->of, i, x) >= -cut->snap;
            if (is_one(cut, x, &cut->of.at[i]))
                same = i;
        }
        if (!inside)
            continue;
        if (same == NO_SIDE)
            put_other(cut, j);
        else
            put_own(cut, same);
    }
}

/* Puts the ends of segment `of` that lie beside segment `by`. */
static void put_ends(struct cut *cut) {
    const pir_corner *a = &cut->by.at[0], *b = &cut->by.at[1];
    double u = b->u - a->u, v = b->v - a->v, square = u * u + v * v;
    for (uint32_t i = 0; i < 2; i++) {
        const pir_corner *x = &cut->of.at[i];
        double along = u * (x->u - a->u) + v * (x->v - a->v), merge = cut->snap * sqrt(square);
        if (along >= -merge && along <= square + merge)
            put_own(cut, i);
    }
}

/* Puts the two ends of what two parallel segments share. */
static void share_segment(struct cut *cut, double part) {
    const pir_corner *a = cut->of.at, *b = cut->by.at;
    double u = a[1].u - a[0].u, v = a[1].v - a[0].v, s = b[1].u - b[0].u, t = b[1].v - b[0].v;
    if (fabs(u * t - v * s) > part * sqrt((u * u + v * v) * (s * s + t * t)))
        return;
    put_ends(cut);
    struct cut other = {cut->by, cut->of, !cut->of_p, cut->snap, cut->corners, cut->count};
    put_ends(&other);
    cut->count = other.count;
    // keep the two that are farthest apart, the first of each where several are one
    for (uint32_t end = 0; end < 2 && cut->count > 2; end++) {
        uint32_t best = end;
        for (uint32_t i = 0; i < cut->count; i++) {
            double more =
                u * (cut->corners[i].u - cut->corners[best].u) + v * (cut->corners[i].v - cut->corners[best].v);
            if ((end == 0 ? -more : more) > cut->snap * sqrt(u * u + v * v))
                best = i;
        }
        pir_corner found = cut->corners[best];
        cut->corners[best] = cut->corners[end];
        cut->corners[end] = found;
    }
    cut->count = cut->count > 2 ? 2 : cut->count;
    if (cut->count == 2 && is_one(cut, &cut->corners[0], &cut->corners[1]))
        cut->count = 1;
}

uint32_t pir_outline_overlap(pir_outline p, pir_outline q, double snap, double part, pir_corner *ret_corners) {
    if (p.count < 2 || q.count < 2)
        return 0;
    // a segment is cut by a polygon, not the reverse
    bool p_first = p.count == 2 || q.count > 2;
    struct cut cut = {p_first ? p : q, p_first ? q : p, p_first, snap, ret_corners, 0};
    if (cut.by.count == 2) {
        share_segment(&cut, part);
    } else {
        cut_sides(&cut);
        if (cut.of.count > 2)
            put_others_inside(&cut);
    }
    return cut.count;
}

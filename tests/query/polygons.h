/* SPDX-License-Identifier: MIT */
/* Convex polygons of the plane, counter-clockwise, as a second opinion on regions of contact. */
#ifndef PIR_TEST_POLYGONS_H
#define PIR_TEST_POLYGONS_H

#include <math.h>
#include <stddef.h>

#define POLYGON_CORNERS 128

typedef struct polygon_point {
    double u, v;
} polygon_point;

typedef struct polygon {
    size_t count;
    polygon_point at[POLYGON_CORNERS];
} polygon;

static inline double polygon_cross(polygon_point a, polygon_point b, polygon_point c) {
    return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

static inline double polygon_area(const polygon *p) {
    double twice = 0;
    for (size_t i = 2; i < p->count; i++)
        twice += polygon_cross(p->at[0], p->at[i - 1], p->at[i]);
    return twice / 2;
}

/* The polygon counter-clockwise. */
static inline polygon polygon_turned_left(polygon p) {
    polygon turned = p;
    for (size_t i = 0; i < p.count; i++)
        turned.at[i] = p.at[p.count - 1 - i];
    return polygon_area(&p) < 0 ? turned : p;
}

/* What two polygons share, by clipping one at each side of the other (Sutherland and Hodgman, 1974). */
static inline polygon polygon_overlap(const polygon *a, const polygon *b) {
    polygon now = *a;
    for (size_t j = 0; j < b->count; j++) {
        polygon next = {.count = 0};
        polygon_point from = b->at[j], to = b->at[(j + 1) % b->count];
        for (size_t i = 0; i < now.count; i++) {
            polygon_point x = now.at[i], y = now.at[(i + 1) % now.count];
            double s = polygon_cross(from, to, x), t = polygon_cross(from, to, y);
            if (s >= 0)
                next.at[next.count++] = x;
            if ((s > 0 && t < 0) || (s < 0 && t > 0))
                next.at[next.count++] =
                    (polygon_point){x.u + (y.u - x.u) * s / (s - t), x.v + (y.v - x.v) * s / (s - t)};
        }
        now = next;
    }
    return now;
}

/* The distance of a point beyond the sides, 0 inside. */
static inline double polygon_beyond(const polygon *p, polygon_point x) {
    double most = 0;
    for (size_t i = 0; i < p->count; i++) {
        polygon_point a = p->at[i], b = p->at[(i + 1) % p->count];
        double length = hypot(b.u - a.u, b.v - a.v);
        if (length > 1e-9)
            most = fmax(most, -polygon_cross(a, b, x) / length);
    }
    return most;
}

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The distance of two triangles in doubles, as bounds that hold whatever went wrong on the way: points of both bound it
 * from above, a direction that separates them from below. And the features that attain it, where these are certain, so
 * that pairs of triangles that share them are known to be as near without exact numbers.
 */
#ifndef PIR_MESH_SIGNS_TRIANGLE_SPAN_H
#define PIR_MESH_SIGNS_TRIANGLE_SPAN_H

#include "base/vec.h"

/* A triangle, or one point, with the numbers of its vertices. */
typedef struct pir_corners {
    pir_vec3 p[3];
    uint32_t id[3];
    int count; /* 3 or 1 */
} pir_corners;

/* A vertex, edge or face by the numbers of its vertices, which rise; the rest are UINT32_MAX. */
typedef struct pir_feature_ids {
    uint32_t id[3];
} pir_feature_ids;

typedef struct pir_span {
    double low, high; /* the distance is between these */
    bool meets;       /* certain: both are 0 then */
    bool certain;     /* whether it is that of the features below, exactly */
    pir_feature_ids a, b;
    pir_vec3 point_a, point_b; /* points of both, as near as the triangles are but for rounding */
} pir_span;

/* `error` bounds how far each coordinate is from the exact one; at least 2^-49 of the largest coordinate. */
pir_span pir_triangle_span(const pir_corners *a, const pir_corners *b, double error);

static inline bool pir_same_features(const pir_span *x, const pir_span *y) {
    bool same = x->certain && y->certain;
    for (int k = 0; k < 3; k++)
        same = same && x->a.id[k] == y->a.id[k] && x->b.id[k] == y->b.id[k];
    return same;
}

#endif

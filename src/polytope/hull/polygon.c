/* SPDX-License-Identifier: MIT */
/*
 * The convex hull of coplanar points: Andrew's monotone chain (Inf. Proc. Letters 9(5), 1979) on the two coordinates
 * that are kept, with exact order and exact turns, so that straight corners and interior points drop out.
 */
#include "polytope/hull/polygon.h"

#include <stdlib.h>
#include <string.h>

struct polygon_place {
    pir_vec3 near;
    const pir_points *points;
    uint32_t point, rank; /* rank: the place in the list that was given, so that of equal points the first stays */
    int axis;
};

/* Compares one coordinate exactly. */
static int compare_coordinate(const struct polygon_place *a, const struct polygon_place *b, int k) {
    double x = k == 0   ? a->near.x
               : k == 1 ? a->near.y
                        : a->near.z,
           y = k == 0   ? b->near.x
               : k == 1 ? b->near.y
                        : b->near.z;
    // each is within 1.01·2^-53 of the truth
    if (x - y > 0x1p-51)
        return 1;
    if (x - y < -0x1p-51)
        return -1;
    const pir_vectors *exact = a->points->exact;
    size_t i = (size_t)a->point * 3 + (size_t)k, j = (size_t)b->point * 3 + (size_t)k;
    int32_t si = exact->size[i], sj = exact->size[j];
    if (si != sj || si == 0)
        return (si > sj) - (si < sj);
    int order = mpn_cmp(exact->limb + i * exact->stride, exact->limb + j * exact->stride, abs(si));
    return si < 0 ? -order : order;
}

static bool same_place(const struct polygon_place *a, const struct polygon_place *b) {
    return compare_coordinate(a, b, (a->axis + 1) % 3) == 0 && compare_coordinate(a, b, (a->axis + 2) % 3) == 0;
}

static int compare_places(const void *left, const void *right) {
    const struct polygon_place *a = left, *b = right;
    int order = compare_coordinate(a, b, (a->axis + 1) % 3);
    if (order == 0)
        order = compare_coordinate(a, b, (a->axis + 2) % 3);
    return order != 0 ? order : (a->rank > b->rank) - (a->rank < b->rank);
}

/* Appends point p to a chain whose lowest entry is chain[low], dropping what no longer turns left;
   returns the new length. */
static uint32_t extend_chain(pir_points *points, int axis, uint32_t *chain, uint32_t low, uint32_t length, uint32_t p) {
    while (length >= low + 2 && pir_turn(points, axis, chain[length - 2], chain[length - 1], p) <= 0)
        length--;
    chain[length] = p;
    return length + 1;
}

uint32_t pir_polygon_corners(pir_points *points, const pir_allocator *allocator, int axis, int direction,
                             uint32_t *index, uint32_t count) {
    struct polygon_place *place = PIR_NEW(allocator, struct polygon_place, count);
    uint32_t *chain = PIR_NEW(allocator, uint32_t, (size_t)count * 2 + 2);
    uint32_t length = 0;
    if (!place || !chain)
        goto done;
    // sort along the kept coordinates, equal points once
    for (uint32_t i = 0; i < count; i++)
        place[i] = (struct polygon_place){points->near[index[i]], points, index[i], i, axis};
    qsort(place, count, sizeof *place, compare_places);
    uint32_t distinct = 0;
    for (uint32_t i = 0; i < count; i++)
        if (distinct == 0 || !same_place(&place[distinct - 1], &place[i]))
            place[distinct++] = place[i];
    // the lower chain, then the upper one back
    for (uint32_t i = 0; i < distinct; i++)
        length = extend_chain(points, axis, chain, 0, length, place[i].point);
    uint32_t low = length - 1;
    for (uint32_t i = distinct - 1; i-- > 0;)
        length = extend_chain(points, axis, chain, low, length, place[i].point);
    if (length > 1)
        length--;
    for (uint32_t i = 0; i < length; i++)
        index[i] = direction > 0 ? chain[i] : chain[length - 1 - i];
done:
    PIR_FREE(allocator, place, count);
    PIR_FREE(allocator, chain, (size_t)count * 2 + 2);
    return length;
}

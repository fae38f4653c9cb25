/* SPDX-License-Identifier: MIT */
/*
 * Triangles that meet a box. Two convex bodies are apart exactly when a plane across a facet's normal of either,
 * or across the product of two edges, leaves a gap (the separating axes of Akenine-Möller, Journal of Graphics
 * Tools 6(1), 2001). Seen along an axis of the box the products are turns in a plane, so every gap is an exact
 * sign.
 */
#include "mesh/query/mesh_walk.h"
#include "mesh/signs/heap_sort.h"
#include "mesh/signs/mesh_numbers.h"

struct query {
    pir_walk_box box;
    double most;
    pir_triangle_callback *callback;
    void *context;
};

static void coordinates(pir_vec3 v, double ret_c[3]) {
    ret_c[0] = v.x;
    ret_c[1] = v.y;
    ret_c[2] = v.z;
}

static void measure(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    pir_walk_box_measure(&((const struct query *)context)->box, boxes, ret_near);
}

/* Whether an edge from a to b, seen in the plane, has the rectangle strictly on its other side than the corner c. */
static bool edge_separates(const double a[2], const double b[2], const double c[2], const double low[2],
                           const double high[2]) {
    int own = pir_sign_turn(a, b, c), least = 1, most = -1;
    for (int k = 0; k < 4; k++) {
        const double corner[2] = {k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1]};
        int sign = pir_sign_turn(a, b, corner);
        least = sign < least ? sign : least;
        most = sign > most ? sign : most;
    }
    return (own >= 0 && most < 0) || (own <= 0 && least > 0);
}

/* Whether an edge of a triangle seen along axis `k` separates it from the box; *ret_sign is its normal's sign there. */
static bool outline_separates(const struct query *q, double p[3][3], int k, int *ret_sign) {
    int x = (k + 1) % 3, y = (k + 2) % 3;
    double flat[3][2];
    for (int i = 0; i < 3; i++) {
        flat[i][0] = p[i][x];
        flat[i][1] = p[i][y];
    }
    const double low[2] = {q->box.low[x], q->box.low[y]}, high[2] = {q->box.high[x], q->box.high[y]};
    *ret_sign = pir_sign_turn(flat[0], flat[1], flat[2]);
    for (int i = 0; i < 3; i++)
        if (edge_separates(flat[i], flat[(i + 1) % 3], flat[(i + 2) % 3], low, high))
            return true;
    return false;
}

static bool meets(const struct query *q, const pir_tri *tri) {
    double p[3][3];
    for (int i = 0; i < 3; i++)
        coordinates(tri->p[i], p[i]);
    if (!pir_walk_box_meets(&q->box, tri))
        return false;
    double front[3], behind[3];
    for (int k = 0; k < 3; k++) {
        int sign;
        if (outline_separates(q, p, k, &sign))
            return false;
        front[k] = sign > 0 ? q->box.high[k] : q->box.low[k];
        behind[k] = sign > 0 ? q->box.low[k] : q->box.high[k];
    }
    return pir_sign_side(tri, (pir_vec3){front[0], front[1], front[2]}) >= 0 &&
           pir_sign_side(tri, (pir_vec3){behind[0], behind[1], behind[2]}) <= 0;
}

static bool look(void *context, const pir_met_triangle *met) {
    const struct query *q = context;
    return !meets(q, &met->tri) || q->callback(q->context, met->number);
}

pir_status pir_surface_box_each(pir_surface_ref surface, pir_vec3 low, pir_vec3 high, pir_triangle_callback *callback,
                                void *context) {
    if (!callback || pir_surface_check(surface) != PIR_OK)
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(low) || !pir_vec_is_finite(high))
        return PIR_ERR_NOT_FINITE;
    struct query q = {.most = 0, .callback = callback, .context = context};
    coordinates(low, q.box.low);
    coordinates(high, q.box.high);
    for (int k = 0; k < 3; k++) {
        if (q.box.low[k] > q.box.high[k])
            return PIR_ERR_ARGUMENT;
        if (fabs(q.box.low[k]) > PIR_MESH_FARTHEST || fabs(q.box.high[k]) > PIR_MESH_FARTHEST)
            return PIR_ERR_LIMIT;
    }
    pir_surface_walk(surface, &(pir_walk){measure, look, &q, &q.most, &q.box});
    return PIR_OK;
}

struct list {
    uint32_t *triangles;
    size_t capacity, count;
};

static bool add(void *context, uint32_t triangle) {
    struct list *list = context;
    if (list->count++ < list->capacity)
        list->triangles[list->count - 1] = triangle;
    return true;
}

static int compare(const void *a, const void *b) {
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

pir_status pir_surface_box(pir_surface_ref surface, pir_vec3 low, pir_vec3 high, size_t capacity,
                           uint32_t *ret_triangles, size_t *ret_count) {
    if (!ret_count || (!ret_triangles && capacity > 0))
        return PIR_ERR_ARGUMENT;
    struct list list = {ret_triangles, capacity, 0};
    pir_status status = pir_surface_box_each(surface, low, high, add, &list);
    if (status != PIR_OK)
        return status;
    pir_heap_sort(ret_triangles, list.count < capacity ? list.count : capacity, sizeof *ret_triangles, compare);
    *ret_count = list.count;
    return PIR_OK;
}

/* SPDX-License-Identifier: MIT */
/*
 * See inner.h. Vertices are added in rounds: at first one, then an eighth of those that are there. Which vertices lie
 * in the hull already is exact, and they stay in it, so later rounds pass them over. Distance from a convex body is
 * greatest at a vertex: so that of the farthest bounds all.
 *
 * Invariant: `open` holds the vertices that are not known to lie in the hull of those in `kept`.
 */
#include "simplify/inner.h"

#include "polytope/some_vertices.h"
#include "simplify/farthest.h"

struct growth {
    pir_measure *measure;
    pir_polytope *body;
    uint32_t *kept;      /* rising */
    pir_far_point *open; /* with distances of the last round */
    uint32_t kept_count, open_count;
    pir_polytope *inner;
    double error; /* of inner */
};

static void keep(struct growth *g, uint32_t vertex) {
    uint32_t at = g->kept_count++;
    for (; at > 0 && g->kept[at - 1] > vertex; at--)
        g->kept[at] = g->kept[at - 1];
    g->kept[at] = vertex;
}

/* The hull of what is kept, and how far the open vertices are from it. */
static pir_status measure_all(struct growth *g) {
    pir_polytope *inner = NULL;
    pir_status status = pir_polytope_of_some(g->body, g->kept, g->kept_count, &inner);
    if (status != PIR_OK)
        return status;
    pir_polytope_release(g->inner);
    g->inner = inner;
    g->error = 0;
    status = pir_measure_aim(g->measure, inner);
    uint32_t left = 0;
    for (uint32_t i = 0; i < g->open_count && status == PIR_OK; i++) {
        pir_far_point point = g->open[i];
        pir_measured measured;
        status = pir_measure_vertex(g->measure, g->body, point.index, &measured);
        if (status == PIR_OK && measured.distance > 0) {
            point.distance = measured.distance;
            g->error = fmax(g->error, point.distance);
            g->open[left++] = point;
        }
    }
    g->open_count = left;
    return status;
}

/* Keeps the farthest of the open vertices. */
static void add_farthest(struct growth *g, uint32_t most) {
    uint32_t batch = g->kept_count / 8 > 1 ? g->kept_count / 8 : 1, room = most - g->kept_count;
    uint32_t taken = pir_farthest_first(g->open, g->open_count, batch < room ? batch : room);
    for (uint32_t i = 0; i < taken; i++)
        keep(g, g->open[i].index);
    g->open_count -= taken;
    for (uint32_t i = 0; i < g->open_count; i++)
        g->open[i] = g->open[i + taken];
}

static pir_status grow(struct growth *g, uint32_t most, double error) {
    const pir_polytope *body = g->body;
    for (uint32_t v = 0; v < body->vertex_count; v++)
        g->open[g->open_count++] = (pir_far_point){body->vertex[v], 0, v};
    // the first vertex: it is as good as any
    add_farthest(g, 1);
    for (;;) {
        pir_status status = measure_all(g);
        if (status != PIR_OK || g->open_count == 0 || g->kept_count == most || g->error <= error)
            return status;
        add_farthest(g, most);
    }
}

pir_status pir_simplify_inner(pir_measure *measure, pir_polytope *body, uint32_t most, double error,
                              pir_polytope **ret_inner, double *ret_error) {
    uint32_t count = body->vertex_count;
    struct growth g = {.measure = measure, .body = body};
    g.kept = PIR_NEW(&body->allocator, uint32_t, count);
    g.open = PIR_NEW(&body->allocator, pir_far_point, count);
    pir_status status = g.kept && g.open ? grow(&g, most < count ? most : count, error) : PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        // all vertices: then it is the body itself
        bool whole = g.kept_count == count;
        *ret_inner = whole ? pir_polytope_retain(body) : pir_polytope_retain(g.inner);
        *ret_error = g.error;
    }
    pir_polytope_release(g.inner);
    PIR_FREE(&body->allocator, g.open, count);
    PIR_FREE(&body->allocator, g.kept, count);
    return status;
}

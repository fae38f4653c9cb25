/* SPDX-License-Identifier: MIT */
/*
 * The sweep: which features a cover asks for. region.c has the two rules. One pass over all facets, a few operations
 * each in floats, finds those that may be near enough. The rest is done for those alone. It reads the cover and what
 * neither rotation nor scale changes: normals, directions of edges, and adjacency.
 */
#include "dymsum/region/sweep.h"

#include <string.h>

#include "base/layout.h"

/*
 * What the sweep is widened by: floats are off by less than 2^-20 in the cosine; where that becomes an angle, by less
 * than 2^-14.
 */
#define FLOAT_SLACK 0x1p-18f
#define EDGE_SLACK  0x1p-40
#define ANGLE_SLACK 0x1p-13

/* --- memory --- */

static pir_layout layout_of(pir_region_facets *facets) {
    pir_members *members = &facets->members;
    uint32_t count = members->capacity;
    return (pir_layout){{PIR_ROW(facets->x, count), PIR_ROW(facets->y, count), PIR_ROW(facets->z, count),
                         PIR_ROW(facets->cosine, count), PIR_ROW(facets->sine, count), PIR_ROW(facets->apart, count),
                         PIR_ROW(facets->hint, count), PIR_ROW(members->at, count), PIR_ROW(members->next, count),
                         PIR_ROW(members->seen, count)}};
}

static pir_layout layout_of_edges(pir_members *edges) {
    uint32_t count = edges->capacity;
    return (pir_layout){{PIR_ROW(edges->at, count), PIR_ROW(edges->next, count), PIR_ROW(edges->seen, count)}};
}

void pir_sweep_finish(pir_sweep *sweep, const pir_allocator *a) {
    pir_layout p = layout_of(&sweep->p), q = layout_of(&sweep->q), edges = layout_of_edges(&sweep->edges);
    pir_layout_free(a, &p);
    pir_layout_free(a, &q);
    pir_layout_free(a, &edges);
    *sweep = (pir_sweep){0};
}

/* Fills in what the sweep reads of p's facets, at every scale the same. */
static void fill_facets(pir_region_facets *facets, const pir_polytope *p) {
    for (uint32_t f = 0; f < p->facet_count; f++) {
        pir_vec3 n = p->normal[f];
        double least = 1;
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
            least = fmin(least, pir_vec_dot(n, p->normal[pir_right(p, p->loop[i])]));
        least = fmax(-1, least);
        facets->x[f] = (float)n.x;
        facets->y[f] = (float)n.y;
        facets->z[f] = (float)n.z;
        facets->cosine[f] = (float)sqrt((1 + least) / 2);
        facets->sine[f] = (float)sqrt((1 - least) / 2);
    }
}

bool pir_sweep_init(pir_sweep *sweep, const pir_polytope *p, const pir_polytope *q, const pir_allocator *a) {
    *sweep = (pir_sweep){0};
    sweep->p.members.capacity = p->facet_count;
    sweep->q.members.capacity = q->facet_count;
    sweep->edges.capacity = p->edge_count;
    pir_layout of_p = layout_of(&sweep->p), of_q = layout_of(&sweep->q), edges = layout_of_edges(&sweep->edges);
    bool done = pir_layout_new(a, &of_p);
    done = pir_layout_new(a, &of_q) && done;
    done = pir_layout_new(a, &edges) && done;
    if (!done) {
        pir_sweep_finish(sweep, a);
        return false;
    }
    fill_facets(&sweep->p, p);
    fill_facets(&sweep->q, q);
    return true;
}

/* --- the sweep --- */

static void count_in(pir_members *members, uint32_t i, uint32_t number, uint32_t *count) {
    if (members->seen[i] == number)
        return;
    members->seen[i] = number;
    members->next[(*count)++] = i;
}

/*
 * facets->apart: below zero for facets farther than `reach` from the axis, by the cosine, and, `by_arc`, farther by
 * more than half of their longest arc. One plain loop, which compilers vectorise.
 */
static void find_apart(pir_region_facets *facets, pir_vec3 axis, pir_arc reach, bool by_arc) {
    const float *restrict x = facets->x, *restrict y = facets->y, *restrict z = facets->z;
    const float *restrict c = facets->cosine, *restrict s = facets->sine;
    float *restrict apart = facets->apart;
    const float ax = (float)axis.x, ay = (float)axis.y, az = (float)axis.z;
    const float rc = (float)reach.cosine, rs = (float)reach.sine;
    uint32_t count = facets->members.capacity;
    if (by_arc) {
        for (uint32_t f = 0; f < count; f++) {
            float beyond = (x[f] * ax + y[f] * ay + z[f] * az) - (rc * c[f] - rs * s[f]),
                  past = -(rs * c[f] + rc * s[f]);
            // a reach beyond π includes all
            apart[f] = (beyond > past ? beyond : past) + FLOAT_SLACK;
        }
    } else {
        for (uint32_t f = 0; f < count; f++)
            apart[f] = (x[f] * ax + y[f] * ay + z[f] * az) - rc + FLOAT_SLACK;
    }
}

/* Whether the arc of halfedge h of P comes within `reach` of the axis, where neither end does. */
static bool passes(const pir_polytope *p, uint32_t h, pir_vec3 axis, pir_arc reach) {
    // its circle does not come so near
    if (reach.cosine > 0 && fabs(pir_vec_dot(axis, p->direction[h])) > reach.sine + EDGE_SLACK)
        return false;
    pir_vec3 from = p->normal[p->left[h]], to = p->normal[pir_right(p, h)];
    double c = pir_vec_dot(from, to), x = pir_vec_dot(axis, from), y = pir_vec_dot(axis, to);
    // the foot of the axis on the arc's circle is between its ends
    return x - c * y >= -EDGE_SLACK && y - c * x >= -EDGE_SLACK;
}

/*
 * Counts in the edges of P within `reach` and the facets at their ends; returns how far their arcs reach from the axis.
 */
static pir_arc sweep_p(pir_sweep *sweep, const pir_polytope *p, pir_vec3 axis, pir_arc reach) {
    pir_region_facets *facets = &sweep->p;
    uint32_t edges = 0, ends = 0;
    double inner = reach.cosine - (double)FLOAT_SLACK;
    find_apart(facets, axis, reach, true);
    for (uint32_t f = 0; f < facets->members.capacity; f++) {
        if (facets->apart[f] < 0)
            continue;
        bool inside = pir_vec_dot(axis, p->normal[f]) >= inner;
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
            uint32_t h = p->loop[i], e = p->edge[h];
            if (sweep->edges.seen[e] == sweep->number || (!inside && !passes(p, h, axis, reach)))
                continue;
            count_in(&sweep->edges, e, sweep->number, &edges);
            count_in(&facets->members, f, sweep->number, &ends);
            count_in(&facets->members, pir_right(p, h), sweep->number, &ends);
        }
    }
    // an arc whose ends are within a quarter turn reaches no farther than they do
    double least = reach.cosine;
    for (uint32_t i = 0; i < ends; i++) {
        uint32_t f = facets->members.next[i];
        double x = pir_vec_dot(axis, p->normal[f]);
        if (x < 0)
            x = pir_arc_add(pir_arc_from_cosine(x), (pir_arc){(double)facets->cosine[f], (double)facets->sine[f]})
                    .cosine;
        least = fmin(least, x);
    }
    sweep->edges.count = edges;
    facets->members.count = ends;
    return pir_arc_from_cosine(least);
}

static void sweep_q(pir_sweep *sweep, pir_vec3 axis, pir_arc reach) {
    uint32_t count = 0;
    find_apart(&sweep->q, axis, reach, false);
    for (uint32_t g = 0; g < sweep->q.members.capacity; g++)
        if (sweep->q.apart[g] >= 0)
            count_in(&sweep->q.members, g, sweep->number, &count);
    sweep->q.members.count = count;
}

static void sweep_all(pir_members *members, uint32_t number) {
    members->count = 0;
    for (uint32_t i = 0; i < members->capacity; i++)
        count_in(members, i, number, &members->count);
}

static void next_number(pir_sweep *sweep) {
    pir_members *const all[3] = {&sweep->p.members, &sweep->q.members, &sweep->edges};
    if (++sweep->number != 0)
        return;
    // numbers have run out: begin again
    for (int k = 0; k < 3; k++)
        memset(all[k]->seen, 0, all[k]->capacity * sizeof *all[k]->seen);
    sweep->number = 1;
}

void pir_sweep_run(pir_sweep *sweep, const pir_cover *cover, const pir_polytope *p) {
    next_number(sweep);
    if (cover->whole) {
        sweep_all(&sweep->p.members, sweep->number);
        sweep_all(&sweep->q.members, sweep->number);
        sweep_all(&sweep->edges, sweep->number);
        return;
    }
    pir_arc reach = pir_cover_reach(cover);
    pir_arc farthest = sweep_p(sweep, p, cover->axis_p, reach);
    double around = cover->skin_p + cover->skin_q + cover->stride + ANGLE_SLACK;
    sweep_q(sweep, cover->axis_q, pir_arc_add(farthest, pir_arc_of(around)));
}

static void take(pir_members *members) {
    uint32_t *next = members->next;
    members->next = members->at;
    members->at = next;
}

void pir_sweep_take(pir_sweep *sweep) {
    take(&sweep->p.members);
    take(&sweep->q.members);
    take(&sweep->edges);
}

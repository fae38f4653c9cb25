/* SPDX-License-Identifier: MIT */
/*
 * The sweep: which features a cover asks for. region.c has the two rules. Edges of P and facets of Q stand in clusters;
 * those in clusters that may be near enough are compared by floats, eight at a time (kernels), and where floats are not
 * certain by doubles. It reads the cover and what neither rotation nor scale changes: normals, directions of edges, and
 * adjacency.
 */
#include "dymsum/region/sweep.h"

#include <string.h>

#include "base/layout.h"

/*
 * Widens the sweep: floats are off by less than 2^-20 in the cosine; where that becomes an angle, by less
 * than 2^-14.
 */
#define FLOAT_SLACK 0x1p-18f
#define EDGE_SLACK  0x1p-40
#define ANGLE_SLACK 0x1p-13

/* --- memory --- */

static pir_layout layout_of(pir_sweep *sweep) {
    pir_members *p = &sweep->p.members, *q = &sweep->q.members, *edges = &sweep->edges;
    uint32_t arcs = pir_whole_lanes(edges->capacity), points = pir_whole_lanes(q->capacity);
    return (pir_layout){{PIR_ROW(p->at, p->capacity + 1), PIR_ROW(p->next, p->capacity + 1),
                         PIR_ROW(p->seen, p->capacity), PIR_ROW(q->at, points), PIR_ROW(q->next, points),
                         PIR_ROW(q->seen, q->capacity), PIR_ROW(edges->at, arcs), PIR_ROW(edges->next, arcs),
                         PIR_ROW(edges->seen, edges->capacity), PIR_ROW(sweep->arc, (size_t)arcs * PIR_ARC_ROWS),
                         PIR_ROW(sweep->point, (size_t)points * PIR_POINT_ROWS)}};
}

void pir_sweep_finish(pir_sweep *sweep, const pir_allocator *a) {
    pir_layout layout = layout_of(sweep);
    pir_layout_free(a, &layout);
    pir_clusters_finish(&sweep->arcs, a);
    pir_clusters_finish(&sweep->points, a);
    pir_starts_finish(&sweep->p.starts, a);
    pir_starts_finish(&sweep->q.starts, a);
    *sweep = (pir_sweep){0};
}

static pir_cap cap_of_facet(const pir_polytope *p, uint32_t f) {
    return (pir_cap){p->normal[f], {1, 0}};
}

/* About the middle of the arc; where that is not certain, the whole sphere. */
static pir_cap cap_of_edge(const pir_polytope *p, uint32_t e) {
    pir_vec3 from = p->normal[p->arc_ends[e].from], to = p->normal[p->arc_ends[e].to];
    pir_vec3 both = pir_vec_add(from, to);
    double length = sqrt(pir_vec_dot(both, both));
    if (length < 0x1p-10)
        return (pir_cap){from, {-1, 0}};
    return (pir_cap){pir_vec_scale(both, 1 / length), pir_arc_from_cosine(length / 2)};
}

/* The first of the rows of cluster k's items. */
static inline float *rows_of(float *items, uint32_t k, uint32_t rows) {
    return items + (size_t)k * rows * PIR_CLUSTER;
}

static void keep_vec(float *row, uint32_t i, pir_vec3 v) {
    row[i] = (float)v.x;
    row[i + PIR_CLUSTER] = (float)v.y;
    row[i + 2 * PIR_CLUSTER] = (float)v.z;
}

/* Fills in what the sweep reads of the arcs of P, at every scale the same. */
static void fill_arcs(pir_sweep *sweep, const pir_polytope *p) {
    for (uint32_t i = 0; i < sweep->arcs.count; i++) {
        uint32_t half = p->edge_half[sweep->arcs.item[i]], at = i % PIR_CLUSTER;
        float *rows = rows_of(sweep->arc, i / PIR_CLUSTER, PIR_ARC_ROWS);
        pir_vec3 from = p->normal[p->left[half]], to = p->normal[pir_right(p, half)];
        keep_vec(rows + PIR_ARC_FROM * PIR_CLUSTER, at, from);
        keep_vec(rows + PIR_ARC_TO * PIR_CLUSTER, at, to);
        keep_vec(rows + PIR_ARC_ALONG * PIR_CLUSTER, at, p->direction[half]);
        rows[PIR_ARC_COSINE * PIR_CLUSTER + at] = (float)pir_vec_dot(from, to);
    }
}

static void fill_points(pir_sweep *sweep, const pir_polytope *q) {
    for (uint32_t i = 0; i < sweep->points.count; i++)
        keep_vec(rows_of(sweep->point, i / PIR_CLUSTER, PIR_POINT_ROWS), i % PIR_CLUSTER,
                 q->normal[sweep->points.item[i]]);
}

bool pir_sweep_init(pir_sweep *sweep, const pir_sweep_parts *parts, const pir_allocator *a) {
    const pir_polytope *p = parts->p, *q = parts->q;
    *sweep = (pir_sweep){.kernels = parts->kernels};
    sweep->p.members.capacity = p->facet_count;
    sweep->q.members.capacity = q->facet_count;
    sweep->edges.capacity = p->edge_count;
    bool done = pir_clusters_init(&sweep->arcs, p, p->edge_count, cap_of_edge, a) &&
                pir_clusters_init(&sweep->points, q, q->facet_count, cap_of_facet, a) &&
                pir_starts_init(&sweep->p.starts, parts->kernels, parts->p_facets, q->vertex_count, a) &&
                pir_starts_init(&sweep->q.starts, parts->kernels, parts->q_facets, p->vertex_count, a);
    pir_layout layout = layout_of(sweep);
    if (!done || !pir_layout_new(a, &layout)) {
        pir_sweep_finish(sweep, a);
        return false;
    }
    fill_arcs(sweep, p);
    fill_points(sweep, q);
    return true;
}

/* --- the sweep --- */

/* Feature i is one of them, perhaps again: without a branch, since nothing foresees that. */
static inline void count_in(pir_members *members, uint32_t i, uint32_t number, uint32_t *count) {
    members->next[*count] = i;
    *count += members->seen[i] != number;
    members->seen[i] = number;
}

/* Whether the arc of halfedge h of P comes within `reach` of the axis between its ends. */
static bool passes(const pir_polytope *p, uint32_t h, pir_vec3 axis, pir_arc reach) {
    // its circle does not come so near
    if (reach.cosine > 0 && fabs(pir_vec_dot(axis, p->direction[h])) > reach.sine + EDGE_SLACK)
        return false;
    pir_vec3 from = p->normal[p->left[h]], to = p->normal[pir_right(p, h)];
    double c = pir_vec_dot(from, to), x = pir_vec_dot(axis, from), y = pir_vec_dot(axis, to);
    // the foot of the axis on the arc's circle is between its ends
    return x - c * y >= -EDGE_SLACK && y - c * x >= -EDGE_SLACK;
}

/* Whether the arc of edge e of P comes within `reach` of the axis. */
static bool is_within(const pir_polytope *p, uint32_t e, pir_vec3 axis, pir_arc reach) {
    uint32_t h = p->edge_half[e];
    double inner = reach.cosine - (double)FLOAT_SLACK;
    return pir_vec_dot(axis, p->normal[p->left[h]]) >= inner ||
           pir_vec_dot(axis, p->normal[pir_right(p, h)]) >= inner || passes(p, h, axis, reach);
}

/* Lists those of cluster k that are within `reach`. Returns how many. */
static uint32_t list_cluster(const pir_clusters *arcs, uint32_t k, const pir_polytope *p, pir_vec3 axis, pir_arc reach,
                             uint32_t *ret_edge) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < pir_cluster_size(arcs, k); i++) {
        ret_edge[found] = arcs->item[k * PIR_CLUSTER + i];
        found += is_within(p, ret_edge[found], axis, reach);
    }
    return found;
}

/* The clusters that the last search has found. */
static pir_clustered found_in(const pir_clusters *clusters, const float *row, uint32_t found) {
    return (pir_clustered){row, clusters->item, clusters->count, clusters->near, found};
}

/* Counts in the edges of P within `reach`. */
static void sweep_edges(pir_sweep *sweep, const pir_polytope *p, pir_vec3 axis, pir_arc reach) {
    const pir_sight sight = {(float)axis.x,
                             (float)axis.y,
                             (float)axis.z,
                             (float)(reach.cosine - (double)FLOAT_SLACK),
                             reach.cosine > 0 ? (float)reach.sine : 4,
                             FLOAT_SLACK};
    uint32_t count = 0, near = pir_clusters_search(&sweep->arcs, sweep->kernels, axis, reach);
    const pir_clustered arcs = found_in(&sweep->arcs, sweep->arc, near);
    for (uint32_t at = 0; at < near; at++) {
        count += sweep->kernels->list_arcs(&arcs, &sight, &at, sweep->edges.next + count);
        if (at < near)
            count += list_cluster(&sweep->arcs, arcs.cluster[at], p, axis, reach, sweep->edges.next + count);
    }
    sweep->edges.count = count;
}

/* Half of the longest arc at facet f. */
static pir_arc half_longest(const pir_polytope *p, uint32_t f) {
    double least = 1;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
        least = fmin(least, pir_vec_dot(p->normal[f], p->normal[pir_right(p, p->loop[i])]));
    least = fmax(-1, least);
    return (pir_arc){sqrt((1 + least) / 2), sqrt((1 - least) / 2)};
}

/* Counts in the edges of P within `reach` and the facets at their ends. */
static void sweep_p(pir_sweep *sweep, const pir_polytope *p, pir_vec3 axis, pir_arc reach) {
    pir_members *facets = &sweep->p.members;
    uint32_t ends = 0;
    sweep_edges(sweep, p, axis, reach);
    for (uint32_t i = 0; i < sweep->edges.count; i++) {
        const pir_arc_ends arc = p->arc_ends[sweep->edges.next[i]];
        count_in(facets, arc.from, sweep->number, &ends);
        count_in(facets, arc.to, sweep->number, &ends);
    }
    facets->count = ends;
}

/* How far the arcs reach from the axis whose ends have been counted in. */
static pir_arc farthest_of(const pir_sweep *sweep, const pir_polytope *p, pir_vec3 axis, pir_arc reach) {
    const pir_members *facets = &sweep->p.members;
    // an arc whose ends are within a quarter turn reaches no farther than they do
    double least = reach.cosine;
    for (uint32_t i = 0; i < facets->count; i++) {
        uint32_t f = facets->next[i];
        double x = pir_vec_dot(axis, p->normal[f]);
        if (x < 0)
            x = pir_arc_add(pir_arc_from_cosine(x), half_longest(p, f)).cosine;
        least = x < least ? x : least;
    }
    return pir_arc_from_cosine(least);
}

/* Counts in the facets of Q within `reach`. */
static void sweep_q(pir_sweep *sweep, pir_vec3 axis, pir_arc reach) {
    const pir_sight sight = {(float)axis.x, (float)axis.y, (float)axis.z, (float)reach.cosine, 0, FLOAT_SLACK};
    uint32_t near = pir_clusters_search(&sweep->points, sweep->kernels, axis, reach);
    const pir_clustered points = found_in(&sweep->points, sweep->point, near);
    sweep->q.members.count = sweep->kernels->list_points(&points, &sight, sweep->q.members.next);
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

/* Walks have the same skin again and again. */
static pir_arc arc_of_skin(pir_sweep *sweep, double skin) {
    if (sweep->skin != skin) {
        sweep->skin = skin;
        sweep->skin_arc = pir_arc_of(skin);
    }
    return sweep->skin_arc;
}

void pir_sweep_run(pir_sweep *sweep, const pir_cover *cover, const pir_polytope *p) {
    next_number(sweep);
    if (cover->whole) {
        sweep_all(&sweep->p.members, sweep->number);
        sweep_all(&sweep->q.members, sweep->number);
        sweep_all(&sweep->edges, sweep->number);
        return;
    }
    pir_arc reach = pir_arc_add(cover->half_angle, arc_of_skin(sweep, cover->skin_p));
    sweep_p(sweep, p, cover->axis_p, reach);
    if (cover->stride == PIR_NO_STRIDE) {
        sweep_q(sweep, cover->axis_q, pir_arc_add(cover->half_angle, arc_of_skin(sweep, cover->skin_q)));
        return;
    }
    pir_arc farthest = farthest_of(sweep, p, cover->axis_p, reach);
    double around = cover->skin_p + cover->skin_q + cover->stride + ANGLE_SLACK;
    sweep_q(sweep, cover->axis_q, pir_arc_add(farthest, pir_arc_of(around)));
}

static void mark(const pir_members *members, uint32_t number) {
    for (uint32_t i = 0; i < members->count; i++)
        members->seen[members->next[i]] = number;
}

void pir_sweep_mark(const pir_sweep *sweep) {
    mark(&sweep->p.members, sweep->number);
    mark(&sweep->q.members, sweep->number);
    mark(&sweep->edges, sweep->number);
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

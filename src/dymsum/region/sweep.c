/* SPDX-License-Identifier: MIT */
/*
 * The sweep: which features a cover asks for. region.c has the two rules. Edges of P and facets of Q stand in clusters;
 * those in clusters that may be near enough are compared by floats, a few operations each, and where floats are not
 * certain by doubles. It reads the cover and what neither rotation nor scale changes: normals, directions of edges, and
 * adjacency.
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

/* What is kept of an arc: the normals at its ends, the direction of its edge, the cosine of its length. */
enum arc_row { FROM_X, FROM_Y, FROM_Z, TO_X, TO_Y, TO_Z, ALONG_X, ALONG_Y, ALONG_Z, COSINE, ARC_ROWS };

/* What is kept of a facet of Q: its normal. */
enum { POINT_ROWS = 3 };

/* --- memory --- */

static pir_layout layout_of(pir_sweep *sweep) {
    pir_members *p = &sweep->p.members, *q = &sweep->q.members, *edges = &sweep->edges;
    uint32_t arcs = pir_cluster_count(&sweep->arcs) * PIR_CLUSTER * ARC_ROWS,
             points = pir_cluster_count(&sweep->points) * PIR_CLUSTER * POINT_ROWS;
    return (pir_layout){
        {PIR_ROW(sweep->p.hint, p->capacity), PIR_ROW(p->at, p->capacity + 1), PIR_ROW(p->next, p->capacity + 1),
         PIR_ROW(p->seen, p->capacity), PIR_ROW(sweep->q.hint, q->capacity), PIR_ROW(q->at, q->capacity),
         PIR_ROW(q->next, q->capacity), PIR_ROW(q->seen, q->capacity), PIR_ROW(edges->at, edges->capacity),
         PIR_ROW(edges->next, edges->capacity), PIR_ROW(edges->seen, edges->capacity), PIR_ROW(sweep->arc, arcs),
         PIR_ROW(sweep->point, points)}};
}

void pir_sweep_finish(pir_sweep *sweep, const pir_allocator *a) {
    pir_layout layout = layout_of(sweep);
    pir_layout_free(a, &layout);
    pir_clusters_finish(&sweep->arcs, a);
    pir_clusters_finish(&sweep->points, a);
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
        float *rows = rows_of(sweep->arc, i / PIR_CLUSTER, ARC_ROWS);
        pir_vec3 from = p->normal[p->left[half]], to = p->normal[pir_right(p, half)];
        keep_vec(rows + FROM_X * PIR_CLUSTER, at, from);
        keep_vec(rows + TO_X * PIR_CLUSTER, at, to);
        keep_vec(rows + ALONG_X * PIR_CLUSTER, at, p->direction[half]);
        rows[COSINE * PIR_CLUSTER + at] = (float)pir_vec_dot(from, to);
    }
}

static void fill_points(pir_sweep *sweep, const pir_polytope *q) {
    for (uint32_t i = 0; i < sweep->points.count; i++)
        keep_vec(rows_of(sweep->point, i / PIR_CLUSTER, POINT_ROWS), i % PIR_CLUSTER, q->normal[sweep->points.item[i]]);
}

bool pir_sweep_init(pir_sweep *sweep, const pir_polytope *p, const pir_polytope *q, const pir_allocator *a) {
    *sweep = (pir_sweep){0};
    sweep->p.members.capacity = p->facet_count;
    sweep->q.members.capacity = q->facet_count;
    sweep->edges.capacity = p->edge_count;
    bool done = pir_clusters_init(&sweep->arcs, p, p->edge_count, cap_of_edge, a) &&
                pir_clusters_init(&sweep->points, q, q->facet_count, cap_of_facet, a);
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

/*
 * The same of a cluster of arcs by floats: above FLOAT_SLACK for those that certainly come so near, below
 * −FLOAT_SLACK for those that certainly do not. One plain loop, which compilers vectorise.
 */
static void measure_arcs(const float *restrict arc, pir_vec3 axis, pir_arc reach, float *restrict ret_by) {
    const float ax = (float)axis.x, ay = (float)axis.y, az = (float)axis.z;
    const float inner = (float)(reach.cosine - (double)FLOAT_SLACK), sine = reach.cosine > 0 ? (float)reach.sine : 4;
    for (uint32_t i = 0; i < PIR_CLUSTER; i++) {
        const float *at = arc + i;
        float x = at[FROM_X * PIR_CLUSTER] * ax + at[FROM_Y * PIR_CLUSTER] * ay + at[FROM_Z * PIR_CLUSTER] * az;
        float y = at[TO_X * PIR_CLUSTER] * ax + at[TO_Y * PIR_CLUSTER] * ay + at[TO_Z * PIR_CLUSTER] * az;
        float d = at[ALONG_X * PIR_CLUSTER] * ax + at[ALONG_Y * PIR_CLUSTER] * ay + at[ALONG_Z * PIR_CLUSTER] * az;
        float c = at[COSINE * PIR_CLUSTER], one = x - c * y, other = y - c * x;
        float foot = one < other ? one : other, near = sine - fabsf(d), end = (x > y ? x : y) - inner;
        float passing = foot < near ? foot : near;
        ret_by[i] = end > passing ? end : passing;
    }
}

/* The first `count` of members->next are all of them, each once. */
static void mark_seen(pir_members *members, uint32_t number, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        members->seen[members->next[i]] = number;
    members->count = count;
}

/* Those of `found` edges listed that are within `reach` stay. Returns how many they are. */
static uint32_t sift_edges(const pir_polytope *p, pir_vec3 axis, pir_arc reach, uint32_t *edge, uint32_t found) {
    uint32_t left = 0;
    for (uint32_t i = 0; i < found; i++)
        if (is_within(p, edge[i], axis, reach))
            edge[left++] = edge[i];
    return left;
}

/* Counts in the edges of P within `reach`. How many of a cluster are is not foreseen: they are listed without branches.
 */
static void sweep_edges(pir_sweep *sweep, const pir_polytope *p, pir_vec3 axis, pir_arc reach) {
    uint32_t count = 0, clusters = pir_clusters_search(&sweep->arcs, axis, reach);
    for (uint32_t j = 0; j < clusters; j++) {
        uint32_t k = sweep->arcs.near[j];
        float by[PIR_CLUSTER];
        const uint32_t *edge = sweep->arcs.item + k * PIR_CLUSTER;
        measure_arcs(rows_of(sweep->arc, k, ARC_ROWS), axis, reach, by);
        uint32_t size = pir_cluster_size(&sweep->arcs, k), found = 0, unsure = 0, *listed = sweep->edges.next + count;
        for (uint32_t i = 0; i < size; i++) {
            listed[found] = edge[i];
            found += by[i] >= -FLOAT_SLACK;
            unsure += fabsf(by[i]) <= FLOAT_SLACK;
        }
        count += unsure == 0 ? found : sift_edges(p, axis, reach, listed, found);
    }
    mark_seen(&sweep->edges, sweep->number, count);
}

/* Half of the longest arc at facet f. */
static pir_arc half_longest(const pir_polytope *p, uint32_t f) {
    double least = 1;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
        least = fmin(least, pir_vec_dot(p->normal[f], p->normal[pir_right(p, p->loop[i])]));
    least = fmax(-1, least);
    return (pir_arc){sqrt((1 + least) / 2), sqrt((1 - least) / 2)};
}

/*
 * Counts in the edges of P within `reach` and the facets at their ends; returns how far their arcs reach from the axis.
 */
static pir_arc sweep_p(pir_sweep *sweep, const pir_polytope *p, pir_vec3 axis, pir_arc reach) {
    pir_members *facets = &sweep->p.members;
    uint32_t ends = 0;
    sweep_edges(sweep, p, axis, reach);
    for (uint32_t i = 0; i < sweep->edges.count; i++) {
        const pir_arc_ends arc = p->arc_ends[sweep->edges.next[i]];
        count_in(facets, arc.from, sweep->number, &ends);
        count_in(facets, arc.to, sweep->number, &ends);
    }
    // an arc whose ends are within a quarter turn reaches no farther than they do
    double least = reach.cosine;
    for (uint32_t i = 0; i < ends; i++) {
        uint32_t f = facets->next[i];
        double x = pir_vec_dot(axis, p->normal[f]);
        if (x < 0)
            x = pir_arc_add(pir_arc_from_cosine(x), half_longest(p, f)).cosine;
        least = x < least ? x : least;
    }
    facets->count = ends;
    return pir_arc_from_cosine(least);
}

/* Counts in the facets of Q within `reach`. */
static void sweep_q(pir_sweep *sweep, pir_vec3 axis, pir_arc reach) {
    const float ax = (float)axis.x, ay = (float)axis.y, az = (float)axis.z, rc = (float)reach.cosine;
    pir_members *facets = &sweep->q.members;
    uint32_t count = 0, clusters = pir_clusters_search(&sweep->points, axis, reach);
    for (uint32_t j = 0; j < clusters; j++) {
        uint32_t k = sweep->points.near[j];
        const float *x = rows_of(sweep->point, k, POINT_ROWS), *y = x + PIR_CLUSTER, *z = y + PIR_CLUSTER;
        float by[PIR_CLUSTER];
        for (uint32_t i = 0; i < PIR_CLUSTER; i++)
            by[i] = (x[i] * ax + y[i] * ay + z[i] * az) - rc + FLOAT_SLACK;
        for (uint32_t i = 0, size = pir_cluster_size(&sweep->points, k); i < size; i++) {
            facets->next[count] = sweep->points.item[k * PIR_CLUSTER + i];
            count += by[i] >= 0;
        }
    }
    mark_seen(facets, sweep->number, count);
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

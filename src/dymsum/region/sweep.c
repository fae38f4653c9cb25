/* SPDX-License-Identifier: MIT */
/*
 * The sweep: which features a cover asks for. region.c has the idea, and the two rules. One pass over all facets, a few
 * operations each in floats, finds those that may be near enough; the rest is for them alone. All of it is made from
 * the cover and from what does not change as bodies turn or are scaled: normals, directions of edges, and what has
 * neighbours of what.
 */
#include "dymsum/region/sweep.h"

#include <string.h>

#include "dymsum/sum.h"

/*
 * What the sweep gives away: floats are off by less than 2^-20 in the cosine; where that is turned into an angle, by
 * less than 2^-14.
 */
#define FLOAT_SLACK 0x1p-18f
#define EDGE_SLACK  0x1p-40
#define ANGLE_SLACK 0x1p-13

/* --- memory --- */

static bool members_new(pir_members *members, const pir_allocator *a, uint32_t capacity) {
    members->capacity = capacity;
    members->at = PIR_NEW(a, uint32_t, capacity);
    members->next = PIR_NEW(a, uint32_t, capacity);
    members->seen = PIR_ZEROED(a, uint32_t, capacity);
    return members->at && members->next && members->seen;
}

static void members_free(pir_members *members, const pir_allocator *a) {
    PIR_FREE(a, members->at, members->capacity);
    PIR_FREE(a, members->next, members->capacity);
    PIR_FREE(a, members->seen, members->capacity);
}

static bool facets_new(pir_region_facets *facets, const pir_allocator *a, uint32_t count) {
    float **lane[6] = {&facets->x, &facets->y, &facets->z, &facets->cosine, &facets->sine, &facets->apart};
    bool done = members_new(&facets->members, a, count);
    for (int k = 0; k < 6; k++)
        done = (*lane[k] = PIR_NEW(a, float, count)) != NULL && done;
    facets->hint = PIR_ZEROED(a, uint32_t, count);
    return done && facets->hint;
}

static void facets_free(pir_region_facets *facets, const pir_allocator *a) {
    uint32_t count = facets->members.capacity;
    float *const lane[6] = {facets->x, facets->y, facets->z, facets->cosine, facets->sine, facets->apart};
    for (int k = 0; k < 6; k++)
        PIR_FREE(a, lane[k], count);
    PIR_FREE(a, facets->hint, count);
    members_free(&facets->members, a);
}

void pir_sweep_finish(pir_sum *sum) {
    const pir_allocator *a = &sum->pairing.allocator;
    facets_free(&sum->region.p, a);
    facets_free(&sum->region.q, a);
    members_free(&sum->region.edges, a);
}

/* What the sweep reads of p's facets: that holds at every scale. */
static void fill_facets(pir_region_facets *facets, const pir_polytope *p) {
    for (uint32_t f = 0; f < p->facet_count; f++) {
        pir_vec3 n = p->normal[f];
        double least = 1;
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
            least = fmin(least, pir_vec_dot(n, p->normal[pir_right(p, p->loop[i])]));
        least = fmax(-1, least);
        facets->x[f] = (float)n.x, facets->y[f] = (float)n.y, facets->z[f] = (float)n.z;
        facets->cosine[f] = (float)sqrt((1 + least) / 2);
        facets->sine[f] = (float)sqrt((1 - least) / 2);
    }
}

bool pir_sweep_allocate(pir_sum *sum) {
    pir_region *region = &sum->region;
    const pir_allocator *a = &sum->pairing.allocator;
    bool done = facets_new(&region->p, a, sum->pairing.p->facet_count);
    done = facets_new(&region->q, a, sum->pairing.q->facet_count) && done;
    done = members_new(&region->edges, a, sum->pairing.p->edge_count) && done;
    if (!done) {
        pir_sweep_finish(sum);
        return false;
    }
    fill_facets(&region->p, sum->pairing.p);
    fill_facets(&region->q, sum->pairing.q);
    return true;
}

/* --- the sweep --- */

static void count_in(pir_members *members, uint32_t i, uint32_t sweep, uint32_t *count) {
    if (members->seen[i] == sweep)
        return;
    members->seen[i] = sweep;
    members->next[(*count)++] = i;
}

/*
 * facets->apart: below zero for those farther than `reach` from the axis, by the cosine, and, `by_arc`, farther by more
 * than half of the longest of their arcs. One plain loop, which compilers make vectors of.
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
            // farther than π in all is everywhere
            apart[f] = (beyond > past ? beyond : past) + FLOAT_SLACK;
        }
    } else {
        for (uint32_t f = 0; f < count; f++)
            apart[f] = (x[f] * ax + y[f] * ay + z[f] * az) - rc + FLOAT_SLACK;
    }
}

/* Whether the arc of halfedge h of P comes within `reach` of the axis, neither end being so near. */
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
 * Counts in the edges of P within `reach` and the facets at their ends; returns how far their arcs lead from the axis.
 */
static pir_arc sweep_p(pir_sum *sum, pir_arc reach) {
    pir_region *region = &sum->region;
    pir_region_facets *facets = &region->p;
    const pir_polytope *p = sum->pairing.p;
    pir_vec3 axis = region->cover.axis_p;
    uint32_t edges = 0, ends = 0;
    double inner = reach.cosine - (double)FLOAT_SLACK;
    find_apart(facets, axis, reach, true);
    for (uint32_t f = 0; f < facets->members.capacity; f++) {
        if (facets->apart[f] < 0)
            continue;
        bool inside = pir_vec_dot(axis, p->normal[f]) >= inner;
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
            uint32_t h = p->loop[i], e = p->edge[h];
            if (region->edges.seen[e] == region->sweep || (!inside && !passes(p, h, axis, reach)))
                continue;
            count_in(&region->edges, e, region->sweep, &edges);
            count_in(&facets->members, f, region->sweep, &ends);
            count_in(&facets->members, pir_right(p, h), region->sweep, &ends);
        }
    }
    // an arc whose ends are within a quarter turn goes no farther than they do
    double least = reach.cosine;
    for (uint32_t i = 0; i < ends; i++) {
        uint32_t f = facets->members.next[i];
        double x = pir_vec_dot(axis, p->normal[f]);
        if (x < 0)
            x = pir_arc_add(pir_arc_from_cosine(x), (pir_arc){(double)facets->cosine[f], (double)facets->sine[f]})
                    .cosine;
        least = fmin(least, x);
    }
    region->edges.count = edges;
    facets->members.count = ends;
    return pir_arc_from_cosine(least);
}

static void sweep_q(pir_sum *sum, pir_arc reach) {
    pir_region *region = &sum->region;
    uint32_t count = 0;
    find_apart(&region->q, region->cover.axis_q, reach, false);
    for (uint32_t g = 0; g < region->q.members.capacity; g++)
        if (region->q.apart[g] >= 0)
            count_in(&region->q.members, g, region->sweep, &count);
    region->q.members.count = count;
}

static void sweep_all(pir_members *members, uint32_t sweep) {
    members->count = 0;
    for (uint32_t i = 0; i < members->capacity; i++)
        count_in(members, i, sweep, &members->count);
}

static void next_sweep(pir_region *region) {
    pir_members *const all[3] = {&region->p.members, &region->q.members, &region->edges};
    if (++region->sweep != 0)
        return;
    // numbers have run out: begin again
    for (int k = 0; k < 3; k++)
        memset(all[k]->seen, 0, all[k]->capacity * sizeof *all[k]->seen);
    region->sweep = 1;
}

void pir_sweep(pir_sum *sum) {
    pir_region *region = &sum->region;
    const pir_cover *cover = &region->cover;
    next_sweep(region);
    if (cover->whole) {
        sweep_all(&region->p.members, region->sweep);
        sweep_all(&region->q.members, region->sweep);
        sweep_all(&region->edges, region->sweep);
        return;
    }
    pir_arc farthest = sweep_p(sum, pir_arc_add(cover->half_angle, pir_arc_of(cover->skin_p)));
    sweep_q(sum, pir_arc_add(farthest, pir_arc_of(cover->skin_p + cover->skin_q + cover->stride + ANGLE_SLACK)));
}

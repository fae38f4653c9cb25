/* SPDX-License-Identifier: MIT */
/*
 * Region: only the pairs are kept whose normals lie in a cone about an axis, and a skin around it, as neighbour lists of molecular
 * dynamics have one (Verlet, Physical Review 159, 1967).
 *
 * Features are active or dormant. A dormant facet has no cell and its alarm never rings; a dormant edge has no crossings and is not touched
 * by events. Which are active is chosen by a sweep over all facets, as a function of the cover alone: the axis as P and Q saw it then (a_P,
 * turned back, and a_Q), the half-angle α, a skin for each, σ_P and σ_Q, and a stride τ. With [n, m] the angle between n and m:
 *
 *   - an edge of P is active when its arc comes within α + σ_P of a_P, and so are the facets at its ends;
 *   - a facet g of Q is active when [g, a_Q] ≤ ρ + σ_P + σ_Q + τ, ρ the farthest from a_P that a point of an active arc is, and at
 *     least α + σ_P.
 *
 * Rounding errs towards active. The cover holds while [Rᵀ·axis, a_P] ≤ σ_P and [axis, a_Q] ≤ σ_Q. Invariants while it holds, which is after
 * every call that succeeds:
 *
 *   - all of the sum in the cone is kept: a facet or arc of P that meets the cone comes within α + σ_P of a_P, a facet of Q in it
 *     within α + σ_Q of a_Q, and a crossing in it is on such an arc;
 *   - what is kept is right: an active facet is in its cell, an active edge has its whole list of crossings. In a step of at most τ
 *     from where the cover holds, or to there, no dormant facet of Q comes to an active arc: a point of that is within ρ of a_P, within ρ + σ_P
 *     of where the axis was, within ρ + σ_P + τ on the way, and within ρ + σ_P + σ_Q + τ of a_Q. Nor does one in any step, of one radian at most,
 *     from where it holds to where it holds still: the axis goes along an arc of a circle whose ends are within σ_P of a_P, and leaves that by
 *     less than σ_P·(√(1 + tan² ¼) − 1) < σ_P/30, less than any τ. So the events of active facets are all that active edges have to hear of.
 *
 * An update in which the cover stops to hold first lets go of what a new one leaves out, then repairs what stays, and last brings in what is
 * new: a facet by descent from a neighbour's cell, an edge from cell to cell. What stays is in both covers. A facet of Q that the old one left
 * dormant is beyond the reach of the edges that stay when the step is within the old stride, one that the new one leaves out when it is
 * within the new. After a longer step, a leap, every edge that stays is led anew.
 *
 * The skins grow with how fast the axis goes in the sight of P and of Q, so a sweep lasts for some frames. Flat operands P have arcs of half a turn: they are kept whole.
 */
#include "dymsum/region.h"

#include <string.h>

#include "dymsum/sum.h"

/* Skins, by how far the axis goes in a step; the stride likewise, by the step's angle. */
#define SKIN_STEPS   5.0
#define STRIDE_STEPS 1.25

/* Radians: steps of more are leaps, wherever they begin and end. */
#define LONGEST_STEP 1.0

/* What the sweep gives away: floats are off by less than 2^-20 in the cosine; where that is turned into an angle, by less than 2^-14. */
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

void pir_region_finish(pir_sum *sum) {
    const pir_allocator *a = &sum->allocator;
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

static void list_all(pir_members *members) {
    members->count = members->capacity;
    for (uint32_t i = 0; i < members->count; i++)
        members->at[i] = i;
}

/* Memory for regions, unless it is there, all features being active; false when out of memory. */
static bool allocate(pir_sum *sum) {
    pir_region *region = &sum->region;
    const pir_allocator *a = &sum->allocator;
    if (region->edges.at)
        return true;
    region->admits = true;
    bool done = facets_new(&region->p, a, sum->p->facet_count);
    done = facets_new(&region->q, a, sum->q->facet_count) && done;
    done = members_new(&region->edges, a, sum->p->edge_count) && done;
    if (!done) {
        pir_region_finish(sum);
        *region = (pir_region){0};
        return false;
    }
    fill_facets(&region->p, sum->p);
    fill_facets(&region->q, sum->q);
    pir_region_open(sum);
    return true;
}

/* --- the cover --- */

bool pir_region_holds(const pir_sum *sum, const pir_rotation *rotation) {
    const pir_region *region = &sum->region;
    const pir_cover *cover = &region->cover;
    return !region->cone.set || cover->whole ||
           (pir_vec_dot(region->cone.axis, cover->axis_q) >= cover->cosine_q &&
            pir_vec_dot(pir_mat_apply_transposed(&rotation->r, region->cone.axis), cover->axis_p) >= cover->cosine_p);
}

/* Whether all is kept for a reason besides what the region needs. */
static bool is_whole(const pir_sum *sum) {
    return !sum->region.cone.set || sum->p->dimension < 3;
}

/* Centres the cover on the region of now. Each sight of the axis is taken to go on as it went, or to rest where `afresh`. */
static void centre(pir_sum *sum, bool afresh) {
    pir_region *region = &sum->region;
    const pir_cover before = region->cover;
    pir_vec3 axis_q = region->cone.axis, axis_p = pir_mat_apply_transposed(&sum->signs.rotation.r, axis_q);
    pir_vec3 off_p = pir_vec_sub(axis_p, before.axis_p), off_q = pir_vec_sub(axis_q, before.axis_q);
    double steps = afresh ? HUGE_VAL : fmax(1, region->steps) / SKIN_STEPS;
    // whatever P sees, the axis may go with Q once: when it is set before the rotation that it is set for
    double stride = afresh ? 0 : STRIDE_STEPS * fabs(sum->clock.stride);
    double skin_p = fmax(sqrt(pir_vec_dot(off_p, off_p)) / steps, stride);
    double skin_q = sqrt(pir_vec_dot(off_q, off_q)) / steps;
    region->cover = pir_cover_make(&region->cone, is_whole(sum), axis_p, axis_q, skin_p, skin_q, stride);
    region->steps = 0;
}

/* --- the sweep --- */

static void count_in(pir_members *members, uint32_t i, uint32_t sweep, uint32_t *count) {
    if (members->seen[i] == sweep)
        return;
    members->seen[i] = sweep;
    members->next[(*count)++] = i;
}

/*
 * facets->apart: below zero for those farther than `reach` from the axis, by the cosine, and, `by_arc`, farther by more than half of the
 * longest of their arcs. One plain loop, which compilers make vectors of.
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

/* Counts in the edges of P within `reach` and the facets at their ends; returns how far their arcs lead from the axis. */
static pir_arc sweep_p(pir_sum *sum, pir_arc reach) {
    pir_region *region = &sum->region;
    pir_region_facets *facets = &region->p;
    const pir_polytope *p = sum->p;
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

/* Finds the features that the cover asks for: in members->next, each member's `seen` being the number of the sweep. */
static void sweep(pir_sum *sum) {
    pir_region *region = &sum->region;
    const pir_cover *cover = &region->cover;
    next_sweep(region);
    region->changes++;
    region->admits = true;
    if (cover->whole) {
        sweep_all(&region->p.members, region->sweep);
        sweep_all(&region->q.members, region->sweep);
        sweep_all(&region->edges, region->sweep);
        return;
    }
    pir_arc farthest = sweep_p(sum, pir_arc_add(cover->half_angle, pir_arc_of(cover->skin_p)));
    sweep_q(sum, pir_arc_add(farthest, pir_arc_of(cover->skin_p + cover->skin_q + cover->stride + ANGLE_SLACK)));
}

/* --- falling dormant --- */

static void drop_facet(pir_sum *sum, pir_region_facets *facets, uint32_t *cell, uint32_t f, uint32_t alarm) {
    if (cell[f] != PIR_NO_PAIR)
        facets->hint[f] = cell[f];
    cell[f] = PIR_NO_PAIR;
    pir_alarm_clear(&sum->alarms, alarm);
    pir_journal_note(&sum->journal, alarm);
}

static void drop_edge(pir_sum *sum, uint32_t e) {
    uint32_t slot = sum->first[e];
    while (slot != PIR_NO_CROSSING) {
        uint32_t next = sum->crossings.next[slot];
        pir_crossing_free(sum, slot);
        slot = next;
    }
    sum->first[e] = PIR_NO_CROSSING;
    sum->touched[e] = PIR_DORMANT;
}

/* Takes what the last sweep found for the members. */
static void take_next(pir_members *members) {
    uint32_t *next = members->next;
    members->next = members->at;
    members->at = next;
}

/* Chooses what the cover asks for, and lets go of what it leaves out. */
static void choose(pir_sum *sum) {
    pir_region *region = &sum->region;
    pir_members *p = &region->p.members, *q = &region->q.members, *edges = &region->edges;
    uint32_t of_p = p->count, of_q = q->count, of_edges = edges->count;
    sweep(sum);
    for (uint32_t i = 0; i < of_edges; i++)
        if (edges->seen[edges->at[i]] != region->sweep)
            drop_edge(sum, edges->at[i]);
    for (uint32_t i = 0; i < of_p; i++)
        if (p->seen[p->at[i]] != region->sweep)
            drop_facet(sum, &region->p, sum->fv, p->at[i], p->at[i]);
    for (uint32_t i = 0; i < of_q; i++)
        if (q->seen[q->at[i]] != region->sweep)
            drop_facet(sum, &region->q, sum->vf, q->at[i], sum->q_facets.first_alarm + q->at[i]);
    take_next(p);
    take_next(q);
    take_next(edges);
}

void pir_region_follow(pir_sum *sum) {
    pir_region *region = &sum->region;
    double angle = fabs(sum->clock.stride), allowed = region->cover.stride;
    region->steps++;
    region->leapt = region->cone.set && !region->cover.whole && !(angle <= LONGEST_STEP);
    if (pir_region_holds(sum, &sum->signs.rotation))
        return;
    centre(sum, false);
    choose(sum);
    region->leapt = region->leapt || !(angle <= fmin(allowed, region->cover.stride));
}

/* --- waking up --- */

/* One of the operands' facets over the other's cells. */
struct place {
    pir_sum *sum;
    pir_region_facets *facets;
    const pir_polytope *own;
    uint32_t *cell, first_alarm;
    bool of_p;
};

/* An active facet's neighbour that has a cell, or PIR_NO_PAIR. */
static uint32_t cell_beside(const struct place *place, uint32_t f) {
    const pir_polytope *own = place->own;
    for (uint32_t i = own->loop_start[f]; i < own->loop_start[f + 1]; i++) {
        uint32_t v = place->cell[pir_right(own, own->loop[i])];
        if (v != PIR_NO_PAIR)
            return v;
    }
    return PIR_NO_PAIR;
}

static void locate(const struct place *place, uint32_t f, uint32_t from) {
    pir_sum *sum = place->sum;
    pir_sleep sleep;
    place->cell[f] = place->of_p ? pir_descend_fv(sum, f, pir_rotated_normal(sum, f), from, &sleep)
                                 : pir_descend_vf(sum, f, from, &sleep);
    pir_fall_asleep(sum, place->first_alarm + f, &sleep);
    pir_journal_note(&sum->journal, place->first_alarm + f);
}

/* Locates the members without a cell: from a neighbour that has one, where there is one, and then outwards, breadth first. */
static void locate_members(const struct place *place) {
    const pir_polytope *own = place->own;
    const pir_members *members = &place->facets->members;
    uint32_t *queue = place->sum->queue;
    for (uint32_t i = 0; i < members->count; i++) {
        uint32_t head = 0, tail = 0;
        if (place->cell[members->at[i]] == PIR_NO_PAIR)
            queue[tail++] = members->at[i];
        while (head < tail) {
            uint32_t f = queue[head++], beside;
            if (place->cell[f] != PIR_NO_PAIR)
                continue;
            beside = cell_beside(place, f);
            locate(place, f, beside != PIR_NO_PAIR ? beside : place->facets->hint[f]);
            for (uint32_t k = own->loop_start[f]; k < own->loop_start[f + 1]; k++) {
                uint32_t to = pir_right(own, own->loop[k]);
                // in the queue once: the rest of the members comes to those that find no room
                if (members->seen[to] == place->sum->region.sweep && place->cell[to] == PIR_NO_PAIR &&
                    tail < members->capacity)
                    queue[tail++] = to;
            }
        }
    }
}

bool pir_region_admit(pir_sum *sum) {
    pir_region *region = &sum->region;
    if (!region->admits)
        return true;
    const struct place p = {sum, &region->p, sum->p, sum->fv, 0, true},
                       q = {sum, &region->q, sum->q, sum->vf, sum->q_facets.first_alarm, false};
    pir_set_moment(sum);
    locate_members(&p);
    locate_members(&q);
    for (uint32_t i = 0; i < region->edges.count; i++) {
        uint32_t e = region->edges.at[i];
        if (sum->touched[e] != PIR_DORMANT)
            continue;
        sum->touched[e] = 0;
        if (!pir_derive_edge(sum, e))
            return false;
    }
    region->admits = false;
    return true;
}

/* --- rebuilds --- */

void pir_region_renew(pir_sum *sum) {
    if (sum->region.cone.set)
        centre(sum, true);
}

void pir_region_open(pir_sum *sum) {
    pir_region *region = &sum->region;
    if (!region->edges.at || (region->edges.count == region->edges.capacity && !region->admits))
        return;
    list_all(&region->p.members);
    list_all(&region->q.members);
    list_all(&region->edges);
    memset(sum->touched, 0, sum->p->edge_count * sizeof *sum->touched);
    sum->stamp = 0;
    region->admits = false;
}

void pir_region_close(pir_sum *sum) {
    if (!sum->region.cone.set)
        return;
    centre(sum, true);
    choose(sum);
    sum->region.admits = false;
}

bool pir_region_walk(pir_sum *sum) {
    pir_region *region = &sum->region;
    pir_members *p = &region->p.members, *q = &region->q.members, *edges = &region->edges;
    // all falls dormant, in whatever state a call that failed has left it
    for (uint32_t i = 0; i < edges->count; i++)
        drop_edge(sum, edges->at[i]);
    for (uint32_t i = 0; i < p->count; i++)
        drop_facet(sum, &region->p, sum->fv, p->at[i], p->at[i]);
    for (uint32_t i = 0; i < q->count; i++)
        drop_facet(sum, &region->q, sum->vf, q->at[i], sum->q_facets.first_alarm + q->at[i]);
    p->count = q->count = edges->count = 0;
    choose(sum);
    return pir_region_admit(sum);
}

/* Whether the members have cells and no other facet has. */
static bool fit(const pir_members *members, const uint32_t *cell, uint32_t with_cells) {
    for (uint32_t i = 0; i < members->count; i++)
        if (cell[members->at[i]] == PIR_NO_PAIR)
            return false;
    return members->count == with_cells;
}

static uint32_t count_with_cells(const uint32_t *cell, uint32_t count) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++)
        found += cell[i] != PIR_NO_PAIR;
    return found;
}

bool pir_region_adopt(pir_sum *sum, const pir_cone *cone, const pir_cover *cover, bool *ret_fits) {
    pir_region *region = &sum->region;
    if (!allocate(sum))
        return false;
    region->cone = *cone;
    region->cover = *cover;
    region->cover.whole = is_whole(sum);
    uint32_t of_p = count_with_cells(sum->fv, sum->p->facet_count),
             of_q = count_with_cells(sum->vf, sum->q->facet_count), pairs = sum->ee_count;
    choose(sum);
    region->admits = false;
    *ret_fits = fit(&region->p.members, sum->fv, of_p) && fit(&region->q.members, sum->vf, of_q) &&
                sum->ee_count == pairs && pir_region_holds(sum, &sum->signs.rotation);
    return true;
}

double pir_region_share(const pir_sum *sum) {
    const pir_region *region = &sum->region;
    uint32_t all = pir_alarm_count(sum);
    return region->cone.set && all > 0 ? (double)(region->p.members.count + region->q.members.count + 1) / (all + 1.0)
                                       : 1;
}

/* --- the calls --- */

/* Brings what is kept to a cone that the cover does not hold. */
static pir_status change_cone(pir_sum *sum, const pir_cone *cone) {
    pir_region *region = &sum->region;
    const pir_cone cone_before = region->cone;
    const pir_cover cover_before = region->cover;
    region->cone = *cone;
    centre(sum, !cone_before.set || !cone->set);
    choose(sum);
    if (pir_region_admit(sum))
        return PIR_OK;
    // back to what there was memory for
    region->cone = cone_before;
    region->cover = cover_before;
    pir_status again = pir_walk_rebuild(sum);
    PIR_ASSERT(again == PIR_OK);
    (void)again;
    return PIR_ERR_MEMORY;
}

pir_status pir_sum_set_region(pir_sum *sum, pir_vec3 axis, double half_angle) {
    if (!sum)
        return PIR_ERR_ARGUMENT;
    pir_region *region = &sum->region;
    pir_cone cone, before = region->cone;
    pir_status status = pir_cone_make(axis, half_angle, &cone);
    if (status != PIR_OK || (!cone.set && !before.set))
        return status;
    if (!allocate(sum))
        return PIR_ERR_MEMORY;
    pir_sum_changes(sum);
    if (before.set && cone.set && before.half_angle == cone.half_angle) {
        region->cone = cone;
        if (pir_region_holds(sum, &sum->signs.rotation) && pir_region_holds(sum, pir_rotation_now(sum)))
            return PIR_OK;
        region->cone = before;
    }
    // a pairing that has stayed behind comes along first
    status = pir_sum_settle(sum);
    return status == PIR_OK ? change_cone(sum, &cone) : status;
}

int pir_sum_region(const pir_sum *sum, pir_vec3 *ret_axis, double *ret_half_angle) {
    if (!sum->region.cone.set)
        return 0;
    *ret_axis = sum->region.cone.axis;
    *ret_half_angle = sum->region.cone.half_angle;
    return 1;
}

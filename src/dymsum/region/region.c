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
 * What is kept is a function of the cover alone, whatever the history. The members (region.h) are the active features,
 * and whatever is no member has no cell and no crossings, at every moment, in the midst of a call too:
 *
 *   - a choice sweeps with nothing but the cover and the normals, clears the members that the sweep leaves out, and
 *     makes members of those it found; what is no member before or after had nothing and gets nothing;
 *   - a rebuild that pairs all features, one kind after the other, first makes members of all of them (open), and then
 *     chooses (close);
 *   - an update moves cells and crossings of active features alone; admission gives cells and crossings to members
 *     alone;
 *   - a walk within a region clears all members, chooses and admits.
 *
 * Each call that succeeds and changes the cover chooses after that, and admits unless all had been paired. One that
 * fails puts the old cover back and walks. So after every call the members are what the sweep finds for the cover, and
 * a sum restored from the cover and the pairing finds the same (pir_region_adopt). The next cover is made from this
 * one, the cone, the rotations and the motion noted in the cover: two sums that agree in these go on to agree as long
 * as they are brought along by the same methods. Which method PIR_METHOD_AUTO takes is told from counted work, and that
 * depends on the history.
 *
 * The skins grow with how fast the axis goes in the sight of P and of Q, so a sweep lasts for some frames. Flat operands P have arcs of half a turn: they are kept whole.
 */
#include "dymsum/region/region.h"

#include <string.h>

#include "dymsum/region/sweep.h"
#include "dymsum/sum.h"

/* Skins, by how far the axis goes in a step; the stride likewise, by the step's angle. */
#define SKIN_STEPS   5.0
#define STRIDE_STEPS 1.25

/* Radians: steps of more are leaps, wherever they begin and end. */
#define LONGEST_STEP 1.0

/* --- memory --- */

static void list_all(pir_members *members) {
    members->count = members->capacity;
    for (uint32_t i = 0; i < members->count; i++)
        members->at[i] = i;
}

/* Memory for regions, unless it is there, all features being active; false when out of memory. */
static bool allocate(pir_sum *sum) {
    pir_region *region = &sum->region;
    if (region->edges.at)
        return true;
    if (!pir_sweep_allocate(sum)) {
        *region = (pir_region){0};
        return false;
    }
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
    return !sum->region.cone.set || sum->pairing.p->dimension < 3;
}

/* Centres the cover on the region of now. Each sight of the axis is taken to go on as it went, or to rest where `afresh`. */
static void centre(pir_sum *sum, bool afresh) {
    pir_region *region = &sum->region;
    const pir_cover before = region->cover;
    pir_vec3 axis_q = region->cone.axis, axis_p = pir_mat_apply_transposed(&sum->pairing.signs.rotation.r, axis_q);
    pir_vec3 off_p = pir_vec_sub(axis_p, before.axis_p), off_q = pir_vec_sub(axis_q, before.axis_q);
    double steps = afresh ? HUGE_VAL : fmax(1, before.steps) / SKIN_STEPS;
    // whatever P sees, the axis may go with Q once: when it is set before the rotation that it is set for
    double stride = afresh ? 0 : STRIDE_STEPS * before.step;
    double skin_p = fmax(sqrt(pir_vec_dot(off_p, off_p)) / steps, stride);
    double skin_q = sqrt(pir_vec_dot(off_q, off_q)) / steps;
    region->cover = pir_cover_make(&region->cone, is_whole(sum), axis_p, axis_q, skin_p, skin_q, stride);
    region->cover.step = afresh ? 0 : before.step;
}

void pir_region_step(pir_sum *sum, pir_quat before) {
    if (sum->region.cone.set)
        sum->region.cover.step = pir_rotation_angle_bound(before, sum->pairing.signs.rotation.unit);
}

/* --- falling dormant --- */

static void drop_facet(pir_sum *sum, pir_region_facets *facets, uint32_t *cell, uint32_t f, uint32_t certificate) {
    if (cell[f] != PIR_NO_PAIR)
        facets->hint[f] = cell[f];
    cell[f] = PIR_NO_PAIR;
    pir_certificate_clear(&sum->certificates, certificate);
    pir_journal_note(&sum->journal, certificate);
}

static void drop_edge(pir_sum *sum, uint32_t e) {
    uint32_t slot = sum->pairing.crossings.first[e];
    while (slot != PIR_NO_CROSSING) {
        uint32_t next = sum->pairing.crossings.next[slot];
        pir_crossing_free(sum, slot);
        slot = next;
    }
    sum->pairing.crossings.first[e] = PIR_NO_CROSSING;
    sum->touched[e] = PIR_INACTIVE;
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
    region->admits = true;
    pir_sweep(sum);
    for (uint32_t i = 0; i < of_edges; i++)
        if (edges->seen[edges->at[i]] != region->sweep)
            drop_edge(sum, edges->at[i]);
    for (uint32_t i = 0; i < of_p; i++)
        if (p->seen[p->at[i]] != region->sweep)
            drop_facet(sum, &region->p, sum->pairing.fv, p->at[i], p->at[i]);
    for (uint32_t i = 0; i < of_q; i++)
        if (q->seen[q->at[i]] != region->sweep)
            drop_facet(sum, &region->q, sum->pairing.vf, q->at[i], sum->q_facets.first_certificate + q->at[i]);
    take_next(p);
    take_next(q);
    take_next(edges);
}

void pir_region_follow(pir_sum *sum) {
    pir_region *region = &sum->region;
    double angle = region->cover.step, allowed = region->cover.stride;
    region->cover.steps += region->cover.steps < UINT32_MAX;
    region->jumped = region->cone.set && !region->cover.whole && !(angle <= LONGEST_STEP);
    if (pir_region_holds(sum, &sum->pairing.signs.rotation))
        return;
    centre(sum, false);
    choose(sum);
    region->jumped = region->jumped || !(angle <= fmin(allowed, region->cover.stride));
}

/* --- waking up --- */

/* One of the operands' facets over the other's cells. */
struct place {
    pir_sum *sum;
    pir_region_facets *facets;
    const pir_polytope *own;
    uint32_t *cell, first_certificate;
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
    pir_expiry expiry;
    place->cell[f] = place->of_p ? pir_descend_fv(sum, f, pir_rotated_normal(sum, f), from, &expiry)
                                 : pir_descend_vf(sum, f, from, &expiry);
    pir_certify(sum, place->first_certificate + f, &expiry);
    pir_journal_note(&sum->journal, place->first_certificate + f);
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
    const struct place p = {sum, &region->p, sum->pairing.p, sum->pairing.fv, 0, true},
                       q = {sum, &region->q, sum->pairing.q, sum->pairing.vf, sum->q_facets.first_certificate, false};
    pir_begin_step(sum);
    locate_members(&p);
    locate_members(&q);
    for (uint32_t i = 0; i < region->edges.count; i++) {
        uint32_t e = region->edges.at[i];
        if (sum->touched[e] != PIR_INACTIVE)
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

static bool is_full(const pir_members *members) {
    return members->count == members->capacity;
}

void pir_region_open(pir_sum *sum) {
    pir_region *region = &sum->region;
    // each kind by itself: facets of Q may be dormant where all arcs of P are active
    bool all = is_full(&region->p.members) && is_full(&region->q.members) && is_full(&region->edges);
    if (!region->edges.at || (all && !region->admits))
        return;
    list_all(&region->p.members);
    list_all(&region->q.members);
    list_all(&region->edges);
    memset(sum->touched, 0, sum->pairing.p->edge_count * sizeof *sum->touched);
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
        drop_facet(sum, &region->p, sum->pairing.fv, p->at[i], p->at[i]);
    for (uint32_t i = 0; i < q->count; i++)
        drop_facet(sum, &region->q, sum->pairing.vf, q->at[i], sum->q_facets.first_certificate + q->at[i]);
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
    uint32_t of_p = count_with_cells(sum->pairing.fv, sum->pairing.p->facet_count),
             of_q = count_with_cells(sum->pairing.vf, sum->pairing.q->facet_count),
             pairs = sum->pairing.crossings.count;
    choose(sum);
    region->admits = false;
    *ret_fits = fit(&region->p.members, sum->pairing.fv, of_p) && fit(&region->q.members, sum->pairing.vf, of_q) &&
                sum->pairing.crossings.count == pairs && pir_region_holds(sum, &sum->pairing.signs.rotation);
    return true;
}

double pir_region_share(const pir_sum *sum) {
    const pir_region *region = &sum->region;
    uint32_t all = pir_certificate_count(sum);
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
        if (pir_region_holds(sum, &sum->pairing.signs.rotation) && pir_region_holds(sum, pir_sum_shown_rotation(sum)))
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

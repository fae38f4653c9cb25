/* SPDX-License-Identifier: MIT */
/*
 * Region: only the pairs are kept whose normals lie in a cone about an axis, or in a skin around the cone, as neighbour
 * lists of molecular dynamics have one (Verlet, Physical Review 159, 1967).
 *
 * Features are active or inactive. An inactive facet has no cell and its certificate never expires. An inactive edge
 * has no crossings and no event changes it. A sweep over all facets chooses the active features, as a function of the
 * cover alone: the axis in the frames of P and Q when the cover was made (a_P, rotated back, and a_Q), the half-angle
 * α, a skin for each frame, σ_P and σ_Q, and a stride τ. With [n, m] the angle between n and m:
 *
 *   - an edge of P is active when its arc comes within α + σ_P of a_P, and so are the facets at its ends;
 *   - a facet g of Q is active when [g, a_Q] ≤ ρ + σ_P + σ_Q + τ, where ρ is the greatest distance from a_P of a
 *     point of an active arc, and at least α + σ_P.
 *
 * A cover that a walk has made has no stride. In it a facet g of Q is active when [g, a_Q] ≤ α + σ_Q.
 *
 * Rounding errs towards active. The cover holds while [Rᵀ·axis, a_P] ≤ σ_P and [axis, a_Q] ≤ σ_Q. It holds
 * after every call that succeeds. Invariants while it holds:
 *
 *   - All of the sum in the cone is kept: a facet or arc of P that meets the cone comes within α + σ_P of a_P, a
 *     facet of Q in it comes within α + σ_Q of a_Q, and a crossing in it is on such an arc.
 *   - What is kept is right: an active facet is in its cell, and an active edge has its whole list of crossings. In a
 *     step of at most τ from where the cover holds, or to there, no inactive facet of Q reaches an active arc: a point
 *     of that arc is within ρ of a_P, within ρ + σ_P of where the axis was, within ρ + σ_P + τ during the step,
 *     and within ρ + σ_P + σ_Q + τ of a_Q. The same is true of any step of at most one radian between two rotations
 *     at which the cover holds: the axis moves along an arc of a circle whose ends are within σ_P of a_P, and is
 *     farther from a_P than σ_P by less than σ_P·(√(1 + tan² ¼) − 1) < σ_P/30, which is less than any τ. So
 *     the events of active facets are all that concern active edges. Without a stride no step is within it.
 *
 * An update in which the cover ceases to hold, or has no stride, first drops what a new cover leaves out, then repairs
 * what stays, and last adds what is new: a facet by descent from a neighbour's cell, an edge from cell to cell. What
 * stays is in both covers. A facet of Q that was inactive in the old cover is beyond the reach of the edges that stay
 * when the step is within the old stride, and one that becomes inactive in the new cover when it is within the new
 * stride. After a longer step, a jump, every edge that stays is derived again.
 *
 * The active features are a function of the cover alone, whatever the history. They are the members (sweep.h).
 * A feature that is no member has no cell and no crossings at any time, within a call as well:
 *
 *   - A choice sweeps with nothing but the cover and the normals, drops the members that the sweep leaves out, and
 *     makes members of those that it found. What is no member before or after had nothing and gets nothing.
 *   - A rebuild that pairs all features first makes members of all of them (open), and then chooses (close).
 *   - An update moves cells and crossings of active features alone. Admission gives cells and crossings to members
 *     alone.
 *   - A walk within a region drops all members, sweeps, and makes the pairing of the new ones (region_walk.c).
 *
 * Each call that succeeds and changes the cover chooses after that, and admits unless all features had been paired. A
 * call that fails goes back to the old cover and walks. So after every call the members are what the sweep finds for
 * the cover, and a sum that is restored from the cover and the pairing finds the same (pir_region_adopt). The next
 * cover is made from this one, the cone, the rotations and the motion noted in the cover. Two sums that agree in these
 * continue to agree as long as the same methods update them. PIR_METHOD_AUTO chooses from counted work, which depends
 * on the history.
 *
 * Skins grow with the speed of the axis in the frames of P and of Q, so that a choice lasts for some frames. A walk is
 * likely to be followed by a walk, which chooses anew in any case: its cover has the least skins, and next to none
 * where the axis has rested in Q since the walk before. A flat P has arcs of half a turn and is kept whole.
 */
#include "dymsum/region/region.h"

#include <string.h>

#include "dymsum/pairing/crossings.h"
#include "dymsum/region/members.h"
#include "dymsum/update/repair.h"

/* A skin is this many times the axis's motion in a step; a stride this many times the step's angle. */
#define SKIN_STEPS   5.0
#define STRIDE_STEPS 1.25

/* Radians. Longer steps are jumps, wherever they begin and end. */
#define LONGEST_STEP 1.0

/* --- memory --- */

static void list_all(pir_members *members) {
    members->count = members->capacity;
    for (uint32_t i = 0; i < members->count; i++)
        members->at[i] = i;
}

bool pir_region_reserve(pir_region *region, pir_tracked *tracked) {
    const pir_pairing *pairing = &tracked->pairing;
    if (region->sweep)
        return true;
    const pir_allocator *a = &pairing->allocator;
    pir_sweep *sweep = PIR_ZEROED(a, pir_sweep, 1);
    const pir_sweep_parts parts = {tracked->kernels, pairing->p, pairing->q, &tracked->p_facets, &tracked->q_facets};
    if (!sweep || !pir_sweep_init(sweep, &parts, a)) {
        PIR_FREE(a, sweep, 1);
        return false;
    }
    region->sweep = sweep;
    pir_region_open(region, tracked);
    return true;
}

void pir_region_finish(pir_region *region, const pir_allocator *allocator) {
    if (region->sweep)
        pir_sweep_finish(region->sweep, allocator);
    PIR_FREE(allocator, region->sweep, 1);
}

/* --- the cover --- */

bool pir_region_holds(const pir_region *region, const pir_rotation *rotation) {
    const pir_cover *cover = &region->cover;
    return !region->cone.set || cover->whole ||
           (pir_vec_dot(region->cone.axis, cover->axis_q) >= cover->cosine_q &&
            pir_vec_dot(pir_mat_apply_transposed(&rotation->r, region->cone.axis), cover->axis_p) >= cover->cosine_p);
}

/* Whether all is kept although the cone may need less. */
static bool is_whole(const pir_region *region, const pir_tracked *tracked) {
    return !region->cone.set || tracked->pairing.p->dimension < 3;
}

/* Centres the cover on the region of now. */
static void make_cover(pir_region *region, const pir_tracked *tracked, double skin_p, double skin_q, double stride) {
    pir_vec3 axis_q = region->cone.axis, axis_p = pir_mat_apply_transposed(&tracked->pairing.signs.rotation.r, axis_q);
    region->cover = pir_cover_make(&region->cone, is_whole(region, tracked), axis_p, axis_q, skin_p, skin_q, stride);
}

void pir_region_centre_afresh(pir_region *region, const pir_tracked *tracked) {
    make_cover(region, tracked, PIR_LEAST_SKIN, PIR_LEAST_SKIN, PIR_LEAST_STRIDE);
}

/* In each frame the axis is expected to move on as it did. */
void pir_region_centre(pir_region *region, const pir_tracked *tracked) {
    const pir_cover before = region->cover;
    pir_vec3 axis_p = pir_mat_apply_transposed(&tracked->pairing.signs.rotation.r, region->cone.axis);
    pir_vec3 off_p = pir_vec_sub(axis_p, before.axis_p), off_q = pir_vec_sub(region->cone.axis, before.axis_q);
    double steps = fmax(1, before.steps) / SKIN_STEPS;
    // whatever its motion in P, the axis may move with Q once: when it is set before the rotation that it is set for
    double stride = fmax(PIR_LEAST_STRIDE, STRIDE_STEPS * before.step);
    double skin_p = fmax(sqrt(pir_vec_dot(off_p, off_p)) / steps, stride);
    double skin_q = sqrt(pir_vec_dot(off_q, off_q)) / steps;
    make_cover(region, tracked, fmax(PIR_LEAST_SKIN, skin_p), fmax(PIR_LEAST_SKIN, skin_q), stride);
    region->cover.step = before.step;
}

void pir_region_centre_walk(pir_region *region, const pir_tracked *tracked) {
    const pir_vec3 off = pir_vec_sub(region->cone.axis, region->cover.axis_q);
    // an axis that has been set since the walk before is likely to be set again before the next
    bool rests = region->cover.stride == PIR_NO_STRIDE && pir_vec_dot(off, off) == 0;
    if (rests && region->cover.skin_p == PIR_RESTING_SKIN) {
        // all else is as it was
        region->cover.axis_p = pir_mat_apply_transposed(&tracked->pairing.signs.rotation.r, region->cone.axis);
        region->cover.step = 0;
        return;
    }
    double skin = rests ? PIR_RESTING_SKIN : PIR_LEAST_SKIN;
    make_cover(region, tracked, skin, skin, PIR_NO_STRIDE);
}

/* Whether what is kept is right after a step to the rotation of now, and includes all that the region needs there. */
static bool lasts(const pir_region *region, const pir_tracked *tracked) {
    return pir_region_holds(region, &tracked->pairing.signs.rotation) &&
           (!region->cone.set || region->cover.whole || region->cover.stride != PIR_NO_STRIDE);
}

void pir_region_step(pir_region *region, const pir_tracked *tracked, pir_quat before) {
    if (region->cone.set)
        region->cover.step = pir_rotation_angle_bound(before, tracked->pairing.signs.rotation.unit);
}

/* --- choosing --- */

static void drop_facet(const pir_member_place *place, uint32_t f) {
    uint32_t certificate = place->first_certificate + f;
    place->cell[f] = PIR_NO_PAIR;
    pir_certificate_clear(&place->tracked->certificates, certificate);
    pir_journal_note(&place->tracked->journal, certificate);
}

/* Drops those of the first `count` members that the last sweep has not seen. */
static void drop_unseen_facets(const pir_member_place *place, uint32_t count) {
    const pir_members *members = &place->facets->members;
    for (uint32_t i = 0; i < count; i++)
        if (members->seen[members->at[i]] != place->sweep)
            drop_facet(place, members->at[i]);
}

static void drop_edge(pir_tracked *tracked, uint32_t e) {
    pir_pairing *pairing = &tracked->pairing;
    uint32_t slot = pairing->crossings.first[e];
    while (slot != PIR_NO_CROSSING) {
        uint32_t next = pairing->crossings.at[slot].next;
        pir_crossing_free(tracked, slot);
        slot = next;
    }
    pairing->crossings.first[e] = PIR_NO_CROSSING;
    tracked->touched[e] = PIR_INACTIVE;
}

void pir_region_choose(pir_region *region, pir_tracked *tracked) {
    pir_members *p = &region->sweep->p.members, *q = &region->sweep->q.members, *edges = &region->sweep->edges;
    uint32_t facets_p = p->count, facets_q = q->count, of_edges = edges->count;
    region->admits = true;
    pir_sweep_run(region->sweep, &region->cover, tracked->pairing.p);
    pir_sweep_mark(region->sweep);
    for (uint32_t i = 0; i < of_edges; i++)
        if (edges->seen[edges->at[i]] != region->sweep->number)
            drop_edge(tracked, edges->at[i]);
    const pir_member_place of_p = pir_members_of_p(region->sweep, tracked),
                           of_q = pir_members_of_q(region->sweep, tracked);
    drop_unseen_facets(&of_p, facets_p);
    drop_unseen_facets(&of_q, facets_q);
    pir_sweep_take(region->sweep);
}

void pir_region_follow(pir_region *region, pir_tracked *tracked) {
    double angle = region->cover.step, allowed = region->cover.stride;
    region->cover.steps += region->cover.steps < UINT32_MAX;
    region->jumped = region->cone.set && !region->cover.whole && !(angle <= LONGEST_STEP);
    if (lasts(region, tracked))
        return;
    pir_region_centre(region, tracked);
    pir_region_choose(region, tracked);
    region->jumped = region->jumped || !(angle <= fmin(allowed, region->cover.stride));
}

/* --- admitting --- */

bool pir_region_admit(pir_region *region, pir_tracked *tracked) {
    if (!region->admits)
        return true;
    const pir_member_place p = pir_members_of_p(region->sweep, tracked), q = pir_members_of_q(region->sweep, tracked);
    if (tracked->certificates.expired_all)
        pir_tracked_lay_out_certificates(tracked);
    pir_tracked_begin_step(tracked);
    pir_members_admit(&p);
    pir_members_admit(&q);
    for (uint32_t i = 0; i < region->sweep->edges.count; i++) {
        uint32_t e = region->sweep->edges.at[i];
        if (tracked->touched[e] != PIR_INACTIVE)
            continue;
        tracked->touched[e] = 0;
        if (!pir_derive_edge(tracked, e))
            return false;
    }
    region->admits = false;
    return true;
}

/* --- rebuilds --- */

static bool is_full(const pir_members *members) {
    return members->count == members->capacity;
}

void pir_region_open(pir_region *region, pir_tracked *tracked) {
    pir_sweep *sweep = region->sweep;
    // each kind separately: facets of Q may be inactive where all arcs of P are active
    if (!sweep ||
        (is_full(&sweep->p.members) && is_full(&sweep->q.members) && is_full(&sweep->edges) && !region->admits))
        return;
    list_all(&sweep->p.members);
    list_all(&sweep->q.members);
    list_all(&sweep->edges);
    memset(tracked->touched, 0, tracked->pairing.p->edge_count * sizeof *tracked->touched);
    tracked->stamp = 0;
    region->admits = false;
}

void pir_region_close(pir_region *region, pir_tracked *tracked) {
    if (!region->cone.set)
        return;
    pir_region_centre_afresh(region, tracked);
    pir_region_choose(region, tracked);
    region->admits = false;
}

/* Whether all members have cells and no other facet has. */
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

bool pir_region_adopt(pir_region *region, pir_tracked *tracked, const pir_cone *cone, const pir_cover *cover,
                      bool *ret_fits) {
    pir_pairing *pairing = &tracked->pairing;
    if (!pir_region_reserve(region, tracked))
        return false;
    region->cone = *cone;
    region->cover = *cover;
    region->cover.whole = is_whole(region, tracked);
    uint32_t of_p = count_with_cells(pairing->fv, pairing->p->facet_count),
             of_q = count_with_cells(pairing->vf, pairing->q->facet_count), pairs = pairing->crossings.count;
    pir_region_choose(region, tracked);
    region->admits = false;
    *ret_fits = fit(&region->sweep->p.members, pairing->fv, of_p) &&
                fit(&region->sweep->q.members, pairing->vf, of_q) && pairing->crossings.count == pairs &&
                pir_region_holds(region, &pairing->signs.rotation);
    return true;
}

double pir_region_share(const pir_region *region, const pir_tracked *tracked) {
    uint32_t all = pir_certificate_count(tracked);
    return region->cone.set && all > 0
               ? (double)(region->sweep->p.members.count + region->sweep->q.members.count + 1) / (all + 1.0)
               : 1;
}

/* SPDX-License-Identifier: MIT */
/*
 * The walk within a region: the pairing of the features that a cover asks for, from nothing.
 *
 * It goes as the walk of everything (rebuild/walk.c), over the members alone: facets of P by descent, the arcs of
 * active edges from cell to cell, and facets of Q from the crossings. An edge of Q tells something only where all of
 * its crossings are known. They are where both of its ends are inner: within the reach α + σ_P of a_P, which is less
 * than a quarter turn. Its arc stays within that reach then, because such a cap is convex, and whatever arc of P it
 * meets there is active. Facets that this does not give a cell are located by descent.
 *
 * It costs what is in the region and its skins, and a pass over bounds of blocks of facets (sweep.c).
 */
#include "dymsum/pairing/crossings.h"
#include "dymsum/rebuild/facet_cells.h"
#include "dymsum/rebuild/walk.h"
#include "dymsum/region/members.h"
#include "dymsum/region/region.h"

/* By which inner facets of Q are nearer than the reach, in the cosine: far more than rounding. */
#define INNER_SLACK 0x1p-30

/* All features become inactive, in whatever state a failed call has left them. */
static void drop_all(const pir_region *region, pir_tracked *tracked) {
    const pir_members *edges = &region->sweep->edges;
    const pir_member_place of[2] = {pir_members_of_p(region->sweep, tracked), pir_members_of_q(region->sweep, tracked)};
    for (uint32_t i = 0; i < edges->count; i++) {
        tracked->pairing.crossings.first[edges->at[i]] = PIR_NO_CROSSING;
        tracked->touched[edges->at[i]] = PIR_INACTIVE;
    }
    pir_crossings_forget(tracked);
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < of[k].facets->members.count; i++)
            pir_member_drop(&of[k], of[k].facets->members.at[i]);
}

/*
 * Lists inner facets of Q in work.queue, and begins to note what their sides cross: nothing, or not all of it is known.
 * Returns how many they are.
 */
static uint32_t begin_notes(const pir_region *region, pir_tracked *tracked) {
    const pir_polytope *q = tracked->pairing.q;
    const pir_members *facets = &region->sweep->q.members;
    uint32_t *vf = tracked->pairing.vf, *inner = tracked->work->queue, count = 0;
    pir_arc reach = pir_cover_reach(&region->cover);
    pir_vec3 axis = pir_mat_apply(&tracked->pairing.signs.rotation.r, region->cover.axis_p);
    double least = reach.cosine > INNER_SLACK ? reach.cosine + INNER_SLACK : HUGE_VAL;
    for (uint32_t i = 0; i < facets->count; i++) {
        inner[count] = facets->at[i];
        count += pir_vec_dot(axis, q->normal[facets->at[i]]) >= least;
    }
    // for a while, they have some cell
    for (uint32_t i = 0; i < count; i++)
        vf[inner[i]] = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = q->loop_start[inner[i]]; k < q->loop_start[inner[i] + 1]; k++) {
            uint32_t noted = vf[q->across[k].facet] == 0 ? PIR_ONE_CELL : PIR_MANY_CELLS;
            tracked->work->met[q->across[k].edge] = (pir_arc_cells){{noted, noted}};
        }
    for (uint32_t i = 0; i < count; i++)
        vf[inner[i]] = PIR_NO_PAIR;
    return count;
}

bool pir_region_walk(pir_region *region, pir_tracked *tracked) {
    drop_all(region, tracked);
    pir_sweep_run(region->sweep, &region->cover, tracked->pairing.p);
    pir_sweep_take(region->sweep);
    const pir_members *edges = &region->sweep->edges;
    const pir_member_place p = pir_members_of_p(region->sweep, tracked), q = pir_members_of_q(region->sweep, tracked);
    pir_tracked_turn_facets(tracked);
    pir_members_locate(&p);
    for (uint32_t i = 0; i < edges->count; i++)
        tracked->touched[edges->at[i]] = 0;
    uint32_t inner = begin_notes(region, tracked);
    if (!pir_walk_edges(tracked, edges->at, edges->count))
        return false;
    pir_take_noted_cells(tracked, tracked->work->queue, inner);
    pir_members_locate_beside(&q);
    pir_members_locate(&q);
    pir_tracked_expire_all(tracked);
    region->admits = false;
    return true;
}

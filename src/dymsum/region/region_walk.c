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
#include <string.h>

#include "dymsum/pairing/crossings.h"
#include "dymsum/rebuild/facet_cells.h"
#include "dymsum/rebuild/walk.h"
#include "dymsum/region/members.h"
#include "dymsum/region/region.h"

/* By which inner facets of Q are nearer than the reach, in the cosine: far more than rounding. */
#define INNER_SLACK 0x1p-30

/* A mark of an edge of Q of which no end is inner; each end that is takes HALF_KNOWN off. */
#define NOT_KNOWN  (2 * HALF_KNOWN)
#define HALF_KNOWN 3

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

/* Marks edges of Q: 0 where all crossings are known. */
static void mark_known(const pir_region *region, pir_tracked *tracked) {
    const pir_polytope *q = tracked->pairing.q;
    const pir_members *facets = &region->sweep->q.members;
    uint8_t *mark = tracked->work->mark;
    pir_arc reach = pir_cover_reach(&region->cover);
    pir_vec3 axis = pir_mat_apply(&tracked->pairing.signs.rotation.r, region->cover.axis_p);
    memset(mark, NOT_KNOWN, q->edge_count);
    if (!(reach.cosine > INNER_SLACK))
        return;
    for (uint32_t i = 0; i < facets->count; i++) {
        uint32_t g = facets->at[i];
        if (pir_vec_dot(axis, q->normal[g]) < reach.cosine + INNER_SLACK)
            continue;
        for (uint32_t k = q->loop_start[g]; k < q->loop_start[g + 1]; k++)
            mark[q->across[k].edge] -= HALF_KNOWN;
    }
}

bool pir_region_walk(pir_region *region, pir_tracked *tracked) {
    drop_all(region, tracked);
    pir_sweep_run(region->sweep, &region->cover, tracked->pairing.p);
    pir_sweep_take(region->sweep);
    const pir_members *edges = &region->sweep->edges;
    const pir_member_place p = pir_members_of_p(region->sweep, tracked), q = pir_members_of_q(region->sweep, tracked);
    pir_tracked_turn_facets(tracked);
    pir_members_locate(&p, false);
    for (uint32_t i = 0; i < edges->count; i++) {
        tracked->touched[edges->at[i]] = 0;
        if (!pir_walk_edge(tracked, edges->at[i]))
            return false;
    }
    mark_known(region, tracked);
    pir_spread_cells_of_q(tracked);
    pir_members_locate(&q, false);
    pir_tracked_expire_all(tracked);
    region->admits = false;
    return true;
}

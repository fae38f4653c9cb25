/* SPDX-License-Identifier: MIT */
/*
 * The walk within a region: the pairing of the features that a cover asks for, from nothing. Facets of both operands
 * are located by descent, many at a time, each from where a grid of directions tells (starts.c), and the arcs of active
 * edges are walked from cell to cell. In a walk of everything (rebuild/walk.c) crossings tell the cells of Q's facets;
 * here fewer would, and noting them costs more than those descents.
 *
 * It costs what is in the region, and a pass over the bounds of clusters (sweep.c).
 */
#include "dymsum/pairing/crossings.h"
#include "dymsum/rebuild/walk.h"
#include "dymsum/region/members.h"
#include "dymsum/region/region.h"

/* All features become inactive, in whatever state a failed call has left them. */
static void drop_all(const pir_sweep *sweep, pir_tracked *tracked) {
    pir_pairing *pairing = &tracked->pairing;
    const pir_members *p = &sweep->p.members, *q = &sweep->q.members, *edges = &sweep->edges;
    for (uint32_t i = 0; i < edges->count; i++) {
        pairing->crossings.first[edges->at[i]] = PIR_NO_CROSSING;
        tracked->touched[edges->at[i]] = PIR_INACTIVE;
    }
    pir_crossings_forget(tracked);
    for (uint32_t i = 0; i < p->count; i++)
        pairing->fv[p->at[i]] = PIR_NO_PAIR;
    for (uint32_t i = 0; i < q->count; i++)
        pairing->vf[q->at[i]] = PIR_NO_PAIR;
}

bool pir_region_walk(pir_region *region, pir_tracked *tracked) {
    drop_all(region->sweep, tracked);
    pir_sweep_run(region->sweep, &region->cover, tracked->pairing.p);
    pir_sweep_take(region->sweep);
    const pir_members *edges = &region->sweep->edges;
    const pir_member_place p = pir_members_of_p(region->sweep, tracked), q = pir_members_of_q(region->sweep, tracked);
    pir_tracked_turn_facets(tracked);
    pir_members_locate(&p);
    for (uint32_t i = 0; i < edges->count; i++)
        tracked->touched[edges->at[i]] = 0;
    if (!pir_walk_edges(tracked, edges->at, edges->count))
        return false;
    pir_members_locate(&q);
    pir_tracked_expire_all(tracked);
    region->admits = false;
    return true;
}

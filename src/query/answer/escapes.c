/* SPDX-License-Identifier: MIT */
/*
 * Every way out of an overlap: the true facets of D whose slack exceeds the least by at most a given length, in the
 * order of ties.
 */
#include "query/answer/extent.h"

/*
 * Facets that exceed the limit by less than this, relative to the placement's reach, are in. So facets that tie are
 * in or out together: doubles know their slacks to 2^-46 / sin at worst.
 */
#define WITHIN 0x1p-44

/* The first facet in order after `after` with a slack of at most `limit`. */
static pir_least next_within(pir_query *query, const pir_placement *placement, double limit, const pir_facet *after) {
    const pir_planes *planes = query->search.groups.planes;
    pir_least next = {.found = false};
    for (uint32_t g = 0; g < query->search.groups.count; g++) {
        const pir_group *group = &query->search.groups.at[g];
        for (uint32_t i = group->start; i < group->start + group->count; i++) {
            pir_facet facet;
            if (pir_planes_slack(planes, i, placement->x) - placement->error * planes->err[i] > limit ||
                !pir_facet_of(&query->exact, planes->piece[i], &facet) || (after && !pir_facet_before(after, &facet)) ||
                (next.found && !pir_facet_before(&facet, &next.facet)) ||
                pir_facet_slack(&query->exact, placement, &facet) > limit)
                continue;
            next = (pir_least){true, facet};
        }
    }
    return next;
}

size_t pir_query_ways_out(pir_query *query, const pir_placement *placement, const pir_escapes_ask *ask,
                          pir_escape *ret_escapes) {
    if (ask->least->outcome != PIR_OVERLAPPING || -ask->least->distance < ask->radii)
        return 0;
    size_t count = 0;
    double limit = pir_frame_from(&query->frame, -ask->least->distance - ask->radii + ask->slack);
    limit += WITHIN * placement->reach;
    for (uint32_t g = 0; g < query->search.groups.count; g++)
        pir_group_make(&query->search.groups, g);
    pir_facet last;
    for (pir_least next = next_within(query, placement, limit, NULL); next.found;
         next = next_within(query, placement, limit, &last), count++) {
        last = next.facet;
        if (count < ask->capacity)
            ret_escapes[count] = (pir_escape){
                pir_frame_length(&query->frame, pir_facet_slack(&query->exact, placement, &last)) + ask->radii, last.n,
                last.faces};
    }
    return count;
}

pir_status pir_query_escapes(pir_query *query, const pir_query_input *input, double slack, size_t capacity,
                             pir_escape *ret_escapes, size_t *ret_count) {
    pir_placement placement;
    if ((!ret_escapes && capacity > 0) || !ret_count || !(slack >= 0))
        return PIR_ERR_ARGUMENT;
    pir_query_result least;
    pir_status status = pir_query_penetration(query, input, NULL, &least);
    if (status == PIR_OK)
        status = pir_query_begin(query, input, &placement);
    if (status != PIR_OK)
        return status;
    const pir_escapes_ask ask = {&least, input->radius_p + input->radius_q, slack, capacity};
    *ret_count = pir_query_ways_out(query, &placement, &ask, ret_escapes);
    return PIR_OK;
}

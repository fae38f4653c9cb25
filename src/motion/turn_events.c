/* SPDX-License-Identifier: MIT */
/* Events as they are asked for: see the public header. */
#include "motion/turn_events.h"

#include <math.h>

#include "base/memory.h"
#include "base/options.h"
#include "dymsum/view.h"

/* --- made and freed --- */

static void free_events(pir_events *events, const pir_allocator *a) {
    pir_changes_finish(&events->changes, &events->movers);
    PIR_FREE(a, events->queue.item, events->movers.count);
    pir_movers_finish(&events->movers);
    PIR_FREE(a, events, 1);
}

static void begin(pir_events *events) {
    pir_movers_locate(&events->movers);
    pir_queue_fill(&events->queue, &events->movers);
    events->counted = false;
}

/* The events of operands as they are in a sum. */
static pir_status make(pir_polytope *const operand[2], const pir_rotation *rotation, pir_vec3 axis,
                       const pir_allocator *a, pir_events **ret_events) {
    if (pir_polytope_dimension(operand[0]) < 2 || pir_polytope_dimension(operand[1]) < 2)
        return PIR_ERR_ARGUMENT;
    pir_events *events = PIR_ZEROED(a, pir_events, 1);
    if (!events)
        return PIR_ERR_MEMORY;
    const pir_status status = pir_movers_init(&events->movers, a, operand, axis, rotation);
    if (status != PIR_OK) {
        PIR_FREE(a, events, 1);
        return status;
    }
    events->queue.item = PIR_NEW(a, uint32_t, events->movers.count);
    if (!events->queue.item || !pir_changes_init(&events->changes, &events->movers)) {
        free_events(events, a);
        return PIR_ERR_MEMORY;
    }
    begin(events);
    *ret_events = events;
    return PIR_OK;
}

pir_status pir_events_create(pir_polytope *p, pir_polytope *q, pir_quat start, pir_vec3 axis,
                             const pir_events_options *options, pir_events **ret_events) {
    pir_events_options used = pir_events_options_default();
    if (!p || !q || !ret_events)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_options_take("pir_events_options", options, &used, NULL);
    pir_rotation rotation = {.relative = false};
    if (status == PIR_OK)
        status = pir_rotation_set(&rotation, start);
    pir_polytope *reflected = NULL;
    if (status == PIR_OK && used.difference)
        status = pir_polytope_reflect(p, &reflected);
    if (status != PIR_OK)
        return status;
    const pir_allocator a = pir_allocator_or_default(used.allocator);
    pir_polytope *const operand[2] = {reflected ? reflected : p, q};
    status = make(operand, &rotation, axis, &a, ret_events);
    pir_polytope_release(reflected);
    return status;
}

pir_status pir_sum_events(const pir_sum *sum, pir_vec3 axis, const pir_allocator *allocator, pir_events **ret_events) {
    if (!sum || !ret_events)
        return PIR_ERR_ARGUMENT;
    const pir_allocator a = pir_allocator_or_default(allocator);
    // references are counted in polytopes that are otherwise never changed
    pir_polytope *const operand[2] = {(pir_polytope *)pir_sum_p(sum), (pir_polytope *)pir_sum_q(sum)};
    return make(operand, &pir_sum_pairing(sum)->signs.rotation, axis, &a, ret_events);
}

void pir_events_destroy(pir_events *events) {
    if (!events)
        return;
    const pir_allocator a = events->movers.allocator;
    free_events(events, &a);
}

/* --- from event to event --- */

pir_status pir_events_next(pir_events *events, pir_event *ret_event, bool *ret_found) {
    if (!events || !ret_event || !ret_found)
        return PIR_ERR_ARGUMENT;
    const pir_face_list *lost = &events->changes.lost, *gained = &events->changes.gained;
    while (events->queue.count > 0) {
        const pir_status status = pir_changes_make(&events->changes, &events->movers, &events->queue);
        if (status != PIR_OK)
            return status;
        events->facets += gained->count - lost->count;
        if (lost->count + gained->count > 0) {
            *ret_event = (pir_event){lost->at, gained->at, lost->count, gained->count};
            *ret_found = true;
            return PIR_OK;
        }
    }
    *ret_found = false;
    return PIR_OK;
}

pir_status pir_events_seek(pir_events *events, double kappa) {
    if (!events)
        return PIR_ERR_ARGUMENT;
    if (isnan(kappa) || kappa == -INFINITY)
        return PIR_ERR_NOT_FINITE;
    if (kappa == INFINITY)
        pir_movers_begin(&events->movers);
    else
        pir_movers_go_to(&events->movers, kappa);
    begin(events);
    return PIR_OK;
}

/* --- facets --- */

/* Counts the facets, and adds them to a list where there is one; false when out of memory. */
static bool look_at_facets(pir_events *events, pir_face_list *list, uint32_t *ret_count) {
    pir_movers *movers = &events->movers;
    const pir_allocator *a = &movers->allocator;
    uint32_t count = 0;
    bool fits = true;
    // a facet on one of the other body is that one's too
    for (uint32_t m = 0; m < movers->count && fits; m++)
        if (m < movers->body[1].first || movers->mover[m].pinned == PIR_NONE) {
            count++;
            fits = !list || pir_face_list_add(list, a, pir_changes_faces(movers, m));
        }
    const pir_polytope *p = movers->operand[0], *q = movers->operand[1];
    for (uint32_t k = 0; k < q->edge_count && fits; k++) {
        // an arc of P crosses that of k only where it leads from one side to the other
        for (uint32_t f = 0; f < p->facet_count; f++)
            movers->row[f] = (int8_t)pir_movers_sign(movers, f, q->edge_half[k], PIR_AFTER);
        for (uint32_t i = 0; i < p->edge_count && fits; i++) {
            if (movers->row[p->arc_ends[i].from] * movers->row[p->arc_ends[i].to] >= 0 ||
                !pir_changes_cross(movers, i, k, PIR_AFTER))
                continue;
            const pir_witness faces = {{PIR_FEATURE_EDGE, i}, {PIR_FEATURE_EDGE, k}};
            count++;
            fits = !list || pir_face_list_add(list, a, faces);
        }
    }
    *ret_count = count;
    return fits;
}

bool pir_events_list(pir_events *events, pir_face_list *list) {
    uint32_t count;
    return look_at_facets(events, list, &count);
}

uint32_t pir_events_facet_count(pir_events *events) {
    if (!events->counted)
        look_at_facets(events, NULL, &events->facets);
    events->counted = true;
    return events->facets;
}

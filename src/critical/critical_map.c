/* SPDX-License-Identifier: MIT */
/*
 * Maps made, and what they hold: see critical_map.h.
 *
 * The events of a turn tell which facets end and begin. These notes are sorted by facet, so that a beginning and the
 * end that belongs to it stand together and make a life.
 */
#include "critical/critical_map.h"

#include <stdlib.h>

#include <pirouette/exact.h>

#include "base/memory.h"
#include "exact/rotation.h"
#include "motion/turn_events.h"

/* A facet begins, or ends, before an interval. */
struct note {
    pir_witness faces;
    uint32_t interval;
    bool begins;
};

struct notes {
    struct note *at;
    size_t count, room;
};

/* --- notes --- */

int pir_faces_order(const pir_witness *a, const pir_witness *b) {
    const uint32_t x[4] = {3 - (uint32_t)a->p.kind, a->p.index, 3 - (uint32_t)a->q.kind, a->q.index};
    const uint32_t y[4] = {3 - (uint32_t)b->p.kind, b->p.index, 3 - (uint32_t)b->q.kind, b->q.index};
    for (int k = 0; k < 4; k++)
        if (x[k] != y[k])
            return x[k] < y[k] ? -1 : 1;
    return 0;
}

/* By facet, then in order of time; no facet ends and begins at one event. */
static int compare_notes(const void *a, const void *b) {
    const struct note *x = a, *y = b;
    const int order = pir_faces_order(&x->faces, &y->faces);
    return order != 0 ? order : (x->interval > y->interval) - (x->interval < y->interval);
}

static int compare_lives(const void *a, const void *b) {
    const pir_facet_life *x = a, *y = b;
    return x->first != y->first ? (x->first > y->first) - (x->first < y->first) : pir_faces_order(&x->faces, &y->faces);
}

static bool add_notes(struct notes *notes, const pir_allocator *a, const pir_witness *faces, uint32_t count,
                      uint32_t interval, bool begins) {
    if (notes->room - notes->count < count) {
        const size_t room = 2 * notes->room + count;
        struct note *grown = PIR_RESIZE(a, notes->at, notes->room, room);
        if (!grown)
            return false;
        notes->at = grown;
        notes->room = room;
    }
    for (uint32_t i = 0; i < count; i++)
        notes->at[notes->count++] = (struct note){faces[i], interval, begins};
    return true;
}

static bool add_event(pir_critical_map *map, pir_events *events) {
    if (map->event_count == map->event_room) {
        const uint32_t room = 2 * map->event_room + 64;
        pir_turn_event *grown = PIR_RESIZE(&map->allocator, map->event, map->event_room, room);
        if (!grown)
            return false;
        map->event = grown;
        map->event_room = room;
    }
    pir_turn_event *event = &map->event[map->event_count++];
    *event = (pir_turn_event){events->movers.now.mover, events->movers.now.half, {0, 0}};
    pir_events_kappa(events, event->kappa);
    return true;
}

/* Goes through the turn. */
static pir_status collect(pir_critical_map *map, pir_events *events, struct notes *notes) {
    const pir_allocator *a = &map->allocator;
    pir_face_list first = {0};
    bool fits = pir_events_list(events, &first) && add_notes(notes, a, first.at, first.count, 0, true);
    // the list grew by the allocator of the events, which is the map's
    PIR_FREE(a, first.at, first.room);
    while (fits) {
        pir_event event;
        bool found;
        const pir_status status = pir_events_next(events, &event, &found);
        if (status != PIR_OK || !found)
            return status;
        const uint32_t interval = map->event_count + 1;
        fits = add_event(map, events) && add_notes(notes, a, event.lost, event.lost_count, interval, false) &&
               add_notes(notes, a, event.gained, event.gained_count, interval, true);
    }
    return PIR_ERR_MEMORY;
}

/* --- lives --- */

static bool make_lives(pir_critical_map *map, struct notes *notes) {
    const pir_allocator *a = &map->allocator;
    qsort(notes->at, notes->count, sizeof *notes->at, compare_notes);
    uint32_t count = 0;
    for (size_t i = 0; i < notes->count; i++)
        count += notes->at[i].begins;
    map->life_count = count;
    map->life = PIR_NEW(a, pir_facet_life, count);
    map->plane = PIR_NEW(a, pir_rounded_plane, count);
    if (!map->life || !map->plane)
        return false;
    count = 0;
    // by facet
    for (size_t i = 0; i < notes->count; i++) {
        const struct note *note = &notes->at[i];
        if (note->begins) {
            map->life[count++] = (pir_facet_life){note->faces, note->interval, map->event_count};
            continue;
        }
        // what ends has begun, and was noted last
        PIR_ASSERT(count > 0 && map->life[count - 1].last == map->event_count &&
                   pir_faces_order(&map->life[count - 1].faces, &note->faces) == 0);
        map->life[count - 1].last = note->interval - 1;
    }
    // those that live at one time near each other
    qsort(map->life, count, sizeof *map->life, compare_lives);
    return true;
}

static void make_planes(pir_critical_map *map) {
    pir_exact_plane exact;
    pir_exact_plane_init(&exact);
    for (uint32_t i = 0; i < map->life_count; i++) {
        pir_turned_plane(&map->turned, &map->life[i].faces, &exact);
        map->plane[i] = pir_turned_round(&map->turned, &exact);
    }
    pir_exact_plane_clear(&exact);
}

/* Counts the entries of each node, behind it, or enters the lives there. */
static void enter_lives(pir_critical_map *map, bool counts) {
    const size_t size = pir_critical_intervals(map);
    for (uint32_t i = 0; i < map->life_count; i++) {
        size_t low = map->life[i].first + size, high = map->life[i].last + 1 + size;
        for (; low < high; low /= 2, high /= 2) {
            size_t node[2], nodes = 0;
            if (low % 2 == 1)
                node[nodes++] = low++;
            if (high % 2 == 1)
                node[nodes++] = --high;
            for (size_t k = 0; k < nodes; k++) {
                if (counts)
                    map->node_start[node[k] + 1]++;
                else
                    map->node_life[map->node_start[node[k]]++] = i;
            }
        }
    }
}

static bool make_tree(pir_critical_map *map) {
    const size_t nodes = 2 * (size_t)pir_critical_intervals(map);
    map->node_start = PIR_ZEROED(&map->allocator, uint32_t, nodes + 1);
    if (!map->node_start)
        return false;
    enter_lives(map, true);
    uint64_t entries = 0;
    for (size_t n = 0; n <= nodes; n++) {
        entries += map->node_start[n];
        if (entries > UINT32_MAX)
            return false;
        map->node_start[n] = (uint32_t)entries;
    }
    map->entry_count = (size_t)entries;
    map->node_life = PIR_NEW(&map->allocator, uint32_t, map->entry_count);
    if (!map->node_life)
        return false;
    enter_lives(map, false);
    // each start has become the next one's
    for (size_t n = nodes; n > 0; n--)
        map->node_start[n] = map->node_start[n - 1];
    map->node_start[0] = 0;
    return true;
}

/* --- made and freed --- */

static pir_status make(pir_critical_map *map) {
    pir_events_options options = pir_events_options_default();
    options.allocator = &map->allocator;
    options.difference = true;
    pir_events *events;
    pir_status status = pir_events_create(map->p, map->q, map->start, map->axis, &options, &events);
    if (status != PIR_OK)
        return status;
    struct notes notes = {0};
    const pir_polytope *const body[2] = {map->minus_p, map->q};
    status = collect(map, events, &notes);
    if (status == PIR_OK && !make_lives(map, &notes))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK)
        status = pir_turned_init(&map->turned, &map->allocator, body, &events->movers.turning, map->start);
    PIR_FREE(&map->allocator, notes.at, notes.room);
    pir_events_destroy(events);
    if (status != PIR_OK)
        return status;
    make_planes(map);
    return make_tree(map) ? PIR_OK : PIR_ERR_MEMORY;
}

pir_status pir_critical_map_create(pir_polytope *p, pir_polytope *q, pir_quat start, pir_vec3 axis,
                                   const pir_allocator *allocator, pir_critical_map **ret_map) {
    if (!p || !q || !ret_map)
        return PIR_ERR_ARGUMENT;
    const int of_p = pir_polytope_dimension(p), of_q = pir_polytope_dimension(q);
    if (of_p < 2 || of_q < 2 || of_p + of_q < 5)
        return PIR_ERR_ARGUMENT;
    const pir_allocator a = pir_allocator_or_default(allocator);
    pir_polytope *reflected;
    pir_status status = pir_polytope_reflect(p, &reflected);
    if (status != PIR_OK)
        return status;
    pir_critical_map *map = PIR_ZEROED(&a, pir_critical_map, 1);
    if (!map) {
        pir_polytope_release(reflected);
        return PIR_ERR_MEMORY;
    }
    *map = (pir_critical_map){.allocator = a,
                              .p = pir_polytope_retain(p),
                              .minus_p = reflected,
                              .q = pir_polytope_retain(q),
                              .start = start,
                              .axis = axis};
    status = make(map);
    if (status == PIR_OK)
        *ret_map = map;
    else
        pir_critical_map_destroy(map);
    return status;
}

void pir_critical_map_destroy(pir_critical_map *map) {
    if (!map)
        return;
    const pir_allocator a = map->allocator;
    if (map->turned.body[0])
        pir_turned_finish(&map->turned);
    PIR_FREE(&a, map->event, map->event_room);
    PIR_FREE(&a, map->life, map->life_count);
    PIR_FREE(&a, map->plane, map->life_count);
    PIR_FREE(&a, map->node_start, 2 * (size_t)pir_critical_intervals(map) + 1);
    PIR_FREE(&a, map->node_life, map->entry_count);
    pir_polytope_release(map->p);
    pir_polytope_release(map->minus_p);
    pir_polytope_release(map->q);
    PIR_FREE(&a, map, 1);
}

/* --- what it holds --- */

pir_critical_turn pir_critical_map_turn(const pir_critical_map *map) {
    return (pir_critical_turn){map->p, map->q, map->start, map->axis};
}

uint32_t pir_critical_map_event_count(const pir_critical_map *map) {
    return map->event_count;
}

pir_status pir_critical_map_event(const pir_critical_map *map, uint32_t event, pir_critical_angle *ret_angle) {
    if (!map || !ret_angle || event >= map->event_count)
        return PIR_ERR_ARGUMENT;
    const double *kappa = map->event[event].kappa;
    *ret_angle = (pir_critical_angle){.kappa = {kappa[0], kappa[1]}};
    pir_turning_degrees(map->turned.length, map->turned.exponent, kappa, ret_angle->degrees);
    return PIR_OK;
}

static int compare_faces(const void *a, const void *b) {
    return pir_faces_order(a, b);
}

pir_status pir_critical_map_facets(const pir_critical_map *map, uint32_t interval, pir_witness *ret_faces,
                                   uint32_t *ret_count) {
    if (!map || !ret_count || interval > map->event_count)
        return PIR_ERR_ARGUMENT;
    uint32_t count = 0;
    for (size_t node = (size_t)interval + pir_critical_intervals(map); node > 0; node /= 2)
        for (uint32_t i = map->node_start[node]; i < map->node_start[node + 1]; i++, count++)
            if (ret_faces)
                ret_faces[count] = map->life[map->node_life[i]].faces;
    if (ret_faces)
        qsort(ret_faces, count, sizeof *ret_faces, compare_faces);
    *ret_count = count;
    return PIR_OK;
}

void pir_critical_map_angle(const pir_critical_map *map, uint32_t event, pir_turn_angle *angle) {
    const pir_turn_event *at = &map->event[event];
    const uint32_t first = map->minus_p->facet_count;
    const bool of_p = at->mover < first;
    pir_turned_sign(&map->turned, of_p, of_p ? at->mover : at->mover - first, at->half, angle->c);
    angle->first = false;
    angle->between[0] = at->kappa[0];
    angle->between[1] = at->kappa[1];
    angle->direction = pir_turn_direction_of(&map->turned, at->kappa[0]);
    if (at->kappa[0] == 0 && at->kappa[1] == 0)
        angle->direction = (pir_turn_direction){0, 1, true};
}

pir_status pir_critical_map_polynomial_exact(const pir_critical_map *map, uint32_t event, mpz_t *ret_coefficients) {
    if (!map || !ret_coefficients || event >= map->event_count)
        return PIR_ERR_ARGUMENT;
    pir_turn_angle angle;
    pir_turn_angle_init(&angle);
    pir_critical_map_angle(map, event, &angle);
    pir_turn_angle_polynomial(&angle, &map->turned, ret_coefficients);
    pir_turn_angle_clear(&angle);
    return PIR_OK;
}

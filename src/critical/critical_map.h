/* SPDX-License-Identifier: MIT */
/*
 * A critical map: the events of a turn, and the lives of the facets of the difference.
 *
 * Interval i lies between events i − 1 and i. A facet's life is a run of intervals; a facet that ends and comes back
 * has two. The closed half-spaces of all facets of an interval meet in the difference, at both of its ends too, where
 * those are left out that have no area there (turned_features.h). One operand has dimension 3, so the difference has an
 * inside, and t is inside exactly where all slacks are negative.
 *
 * Invariants
 *   - events are at falling κ, each the exit root of a mover's sign; the doubles around it are neighbours or one.
 *   - lives stand by their first interval, then by facet; those of one facet do not meet.
 *   - a life stands in the nodes of a tree over the intervals that make up its run: node n has the children 2n and
 *     2n + 1, interval i is node i + intervals, and the lives of interval i are those in the nodes above that.
 */
#ifndef PIR_CRITICAL_CRITICAL_MAP_H
#define PIR_CRITICAL_CRITICAL_MAP_H

#include <pirouette/critical.h>

#include "critical/turn_angle.h"

/* An event: the mover whose sign has it for its exit root, as in motion/movers.h, and the doubles around κ. */
typedef struct pir_turn_event {
    uint32_t mover, half;
    double kappa[2];
} pir_turn_event;

/* A facet of the difference in the intervals from `first` to `last`. */
typedef struct pir_facet_life {
    pir_witness faces;
    uint32_t first, last;
} pir_facet_life;

struct pir_critical_map {
    pir_allocator allocator;
    pir_polytope *p, *minus_p, *q; /* held */
    pir_quat start;
    pir_vec3 axis;
    pir_turned turned;
    pir_turn_event *event;
    uint32_t event_count, event_room;
    pir_facet_life *life;
    pir_rounded_plane *plane; /* per life */
    uint32_t life_count;
    uint32_t *node_start, *node_life; /* of the tree: 2 · intervals + 1, and numbers of lives */
    size_t entry_count;
};

static inline uint32_t pir_critical_intervals(const pir_critical_map *map) {
    return map->event_count + 1;
}

/* An order of facets: facets of P first, then edges, then vertices, each by number, then likewise of Q. */
int pir_faces_order(const pir_witness *a, const pir_witness *b);

/* Sets an angle to that of an event. */
void pir_critical_map_angle(const pir_critical_map *map, uint32_t event, pir_turn_angle *angle);

#endif

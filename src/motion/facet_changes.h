/* SPDX-License-Identifier: MIT */
/*
 * The facets that the true sum loses and gains at an instant.
 *
 * A true facet is a point of the overlay of the two Gaussian maps: a mover's, with the face of the other body that it
 * is on, or a crossing of two arcs within both. A mover's face changes at its instants alone. A crossing begins or ends
 * where the end of one arc comes to the other: there too a mover has an instant, and both arcs are among those that
 * meet at the two points.
 *
 * All movers that have an instant together change together. What only touches changes nothing.
 */
#ifndef PIR_MOTION_FACET_CHANGES_H
#define PIR_MOTION_FACET_CHANGES_H

#include <pirouette/witness.h>

#include "motion/queue.h"

/* Facets of the sum by the faces that make them. */
typedef struct pir_face_list {
    pir_witness *at;
    uint32_t count, room;
} pir_face_list;

/* Adds a facet behind the others; false when out of memory. */
bool pir_face_list_add(pir_face_list *list, const pir_allocator *allocator, pir_witness faces);

/* A mover at its instant: on the arc of `half`, or on the point of the facet `corner`, the other PIR_NONE. */
typedef struct pir_stop {
    uint32_t mover, half, corner;
    pir_witness before; /* its facet until then */
} pir_stop;

typedef struct pir_changes {
    pir_face_list lost, gained;
    pir_stop *stop; /* room for all movers */
    uint32_t stops;
    uint64_t *pair, *sorting; /* edges of P and Q that may begin or cease to cross: P's in the upper half */
    uint32_t pairs, pair_room;
} pir_changes;

/* Makes room for the changes of a few movers. False when out of memory. */
bool pir_changes_init(pir_changes *changes, const pir_movers *movers);
void pir_changes_finish(pir_changes *changes, const pir_movers *movers);

/*
 * Takes all movers of the next instant from the queue, moves now there, sets `lost` and `gained` in order, and puts the
 * movers back with the instant after it. The queue must not be empty. PIR_ERR_MEMORY; nothing changes then.
 */
pir_status pir_changes_make(pir_changes *changes, pir_movers *movers, pir_queue *queue);

/* The facet of the sum that a mover is. */
pir_witness pir_changes_faces(const pir_movers *movers, uint32_t m);

/* Whether two arcs cross within both, just before or after now. */
bool pir_changes_cross(pir_movers *movers, uint32_t edge_p, uint32_t edge_q, pir_when when);

#endif

/* SPDX-License-Identifier: MIT */
/* The events of a turn: movers, their queue, and the facets that change. */
#ifndef PIR_MOTION_TURN_EVENTS_H
#define PIR_MOTION_TURN_EVENTS_H

#include <pirouette/events.h>

#include "motion/facet_changes.h"

struct pir_events {
    pir_movers movers;
    pir_queue queue;
    pir_changes changes;
    bool counted; /* facets holds */
    uint32_t facets;
};

/* Adds the facets of the true sum just after the place to a list, in no order; false when out of memory. */
bool pir_events_list(pir_events *events, pir_face_list *list);

#endif

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

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Deals the units of a job to workers: the most expensive ones first, as far as is known, so that the last ones are
 * short; and a unit that is late once more, to a worker that has nothing to do. Makes no calls of MPI.
 *
 * Units are numbered pair by pair, as many of each. What a unit costs is the mean of those of its pair that are done;
 * each pair is tried once first. Times are in seconds of any one clock.
 */
#ifndef TOOLS_RANKS_DEALER_H
#define TOOLS_RANKS_DEALER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A unit that some worker makes. */
struct dealt {
    uint64_t unit;
    double since; /* when it was dealt last */
    bool again;   /* a second worker makes it too */
};

struct dealer_pair {
    uint64_t next; /* unit of the pair that is dealt next */
    uint64_t timed;
    double seconds; /* of the timed ones */
};

struct dealer {
    uint64_t units, pairs, per_pair;
    uint64_t done;
    uint64_t tried; /* pairs of which a unit was dealt */
    struct dealer_pair *pair;
    uint8_t *is_done; /* a bit per unit */
    struct dealt *dealt;
    size_t dealt_count, dealt_room;
};

/* `pairs` divides `units`. False when out of memory; dealer_finish releases whatever is there. */
bool dealer_init(struct dealer *dealer, uint64_t units, uint64_t pairs);
void dealer_finish(struct dealer *dealer);

/* The unit to be made next; `units` when all are dealt, or when out of memory. */
uint64_t dealer_deal(struct dealer *dealer, double now);

/*
 * Takes note that a unit is done, for the first time or again. `is_new`: it was made, not found made already, so that
 * its time tells what units of its pair cost.
 */
void dealer_done(struct dealer *dealer, uint64_t unit, bool is_new, double now);

/* Takes note that the worker of a unit is lost: the unit is late at once. */
void dealer_lost(struct dealer *dealer, uint64_t unit);

/*
 * A late unit for a second worker, once all are dealt: one that takes longer than twice the mean of its pair, and than
 * two seconds. `units` when none is late.
 */
uint64_t dealer_late(struct dealer *dealer, double now);

#endif

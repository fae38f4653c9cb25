/* SPDX-License-Identifier: MIT */
#include "dealer.h"

#include <math.h>
#include <stdlib.h>

/* A unit is late after so many seconds at the earliest, and so many times the mean of its pair. */
#define LATE_LEAST 2.0
#define LATE_TIMES 2.0

bool dealer_init(struct dealer *dealer, uint64_t units, uint64_t pairs) {
    *dealer = (struct dealer){.units = units, .pairs = pairs, .per_pair = pairs ? units / pairs : 0};
    dealer->pair = calloc(pairs + 1, sizeof *dealer->pair);
    dealer->is_done = calloc(units / 8 + 1, 1);
    return dealer->pair && dealer->is_done;
}

void dealer_finish(struct dealer *dealer) {
    free(dealer->pair);
    free(dealer->is_done);
    free(dealer->dealt);
    *dealer = (struct dealer){0};
}

static bool is_done(const struct dealer *dealer, uint64_t unit) {
    return dealer->is_done[unit / 8] >> (unit % 8) & 1;
}

/* The pair with units left that costs most; `pairs` when none is left. */
static uint64_t dearest_pair(const struct dealer *dealer) {
    uint64_t best = dealer->pairs;
    double most = -1;
    for (uint64_t p = 0; p < dealer->pairs; p++) {
        const struct dealer_pair *pair = &dealer->pair[p];
        double mean = pair->timed ? pair->seconds / (double)pair->timed : 0;
        if (pair->next < dealer->per_pair && mean > most) {
            most = mean;
            best = p;
        }
    }
    return best;
}

uint64_t dealer_deal(struct dealer *dealer, double now) {
    if (dealer->dealt_count == dealer->dealt_room) {
        size_t room = 2 * dealer->dealt_room + 16;
        struct dealt *grown = realloc(dealer->dealt, room * sizeof *grown);
        if (!grown)
            return dealer->units;
        dealer->dealt = grown;
        dealer->dealt_room = room;
    }
    uint64_t pair = dealer->tried < dealer->pairs ? dealer->tried++ : dearest_pair(dealer);
    if (pair == dealer->pairs || dealer->pair[pair].next == dealer->per_pair)
        return dealer->units;
    uint64_t unit = pair * dealer->per_pair + dealer->pair[pair].next++;
    dealer->dealt[dealer->dealt_count++] = (struct dealt){unit, now, false};
    return unit;
}

/* The place of a unit among those being made; their count when it is none. */
static size_t find_dealt(const struct dealer *dealer, uint64_t unit) {
    size_t i = 0;
    while (i < dealer->dealt_count && dealer->dealt[i].unit != unit)
        i++;
    return i;
}

void dealer_done(struct dealer *dealer, uint64_t unit, bool is_new, double now) {
    if (unit >= dealer->units || is_done(dealer, unit))
        return;
    dealer->is_done[unit / 8] |= (uint8_t)(1u << (unit % 8));
    dealer->done++;
    size_t at = find_dealt(dealer, unit);
    if (at == dealer->dealt_count)
        return;
    struct dealer_pair *pair = &dealer->pair[unit / dealer->per_pair];
    if (is_new && isfinite(dealer->dealt[at].since)) {
        pair->seconds += now - dealer->dealt[at].since;
        pair->timed++;
    }
    dealer->dealt[at] = dealer->dealt[--dealer->dealt_count];
}

void dealer_lost(struct dealer *dealer, uint64_t unit) {
    size_t at = find_dealt(dealer, unit);
    if (at < dealer->dealt_count) {
        dealer->dealt[at].since = -HUGE_VAL;
        dealer->dealt[at].again = false;
    }
}

uint64_t dealer_late(struct dealer *dealer, double now) {
    for (size_t i = 0; i < dealer->dealt_count; i++) {
        struct dealt *dealt = &dealer->dealt[i];
        const struct dealer_pair *pair = &dealer->pair[dealt->unit / dealer->per_pair];
        double mean = pair->timed ? pair->seconds / (double)pair->timed : 0;
        if (!dealt->again && now - dealt->since > fmax(LATE_LEAST, LATE_TIMES * mean)) {
            dealt->again = true;
            dealt->since = now;
            return dealt->unit;
        }
    }
    return dealer->units;
}

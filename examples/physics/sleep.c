/* SPDX-License-Identifier: MIT */
/*
 * Groups are found by union of numbers: a body's leads, by way of others, to that of one body of its group. A body that
 * sleeps stays as still as it was when it fell asleep, so that a group with one that moves is awake.
 */
#include "sleep.h"

/* A body slower than this everywhere is still, in m/s, and sleeps after so many seconds. */
#define STILL_SPEED   0.01
#define STILL_SECONDS 0.5

static uint32_t leader(uint32_t *group, uint32_t i) {
    while (group[i] != i)
        i = group[i] = group[group[i]];
    return i;
}

/* What may sleep. */
static bool may_sleep(const struct body *body) {
    return body->kind == PIR_BODY_MOVING;
}

void sleep_update(struct body *body, uint32_t count, const struct contacts *contacts, double step, uint32_t *group) {
    for (uint32_t i = 0; i < count; i++) {
        double speed = vec_length(body[i].velocity) + body[i].radius * vec_length(body[i].spin) +
                       vec_length(body[i].push) + body[i].radius * vec_length(body[i].push_spin);
        if (!body[i].asleep)
            body[i].still = speed < STILL_SPEED ? body[i].still + step : 0;
        group[i] = i;
    }
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        uint32_t p = contacts->link[i].body_p, q = contacts->link[i].body_q;
        if (may_sleep(&body[p]) && may_sleep(&body[q]))
            group[leader(group, p)] = leader(group, q);
        else if (body_is_driven(&body[p]))
            body[q].still = 0;
        else if (body_is_driven(&body[q]))
            body[p].still = 0;
    }
    // the least time of all of a group is its leader's, then that of each
    for (uint32_t i = 0; i < count; i++) {
        uint32_t of = leader(group, i);
        body[of].still = fmin(body[of].still, body[i].still);
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!may_sleep(&body[i]))
            continue;
        bool sleeps = body[leader(group, i)].still >= STILL_SECONDS;
        if (sleeps)
            body[i].velocity = body[i].spin = (pir_vec3){0, 0, 0};
        else if (body[i].asleep)
            body[i].still = 0;
        body[i].asleep = sleeps;
    }
}

/* SPDX-License-Identifier: MIT */
/* Profiles of runs; see profile.h. */
#include "profile.h"

#include <stdlib.h>

#include "../measure.h"

/* Measures: times, of which the first is their sum, then counts. */
static const struct {
    const char *name;
    bool is_time;
} measures[PROFILE_MEASURES] = {
    {"update", true},
    {"poses and boxes", true},
    {"tree", true},
    {"pairs found", true},
    {"looks", true},
    {"questions", true},
    {"unions and surfaces", true},
    {"events", true},
    {"bodies moved", false},
    {"boxes made", false},
    {"pieces that left their boxes", false},
    {"pairs looked at", false},
    {"pairs asked", false},
    {"answered by an earlier proof", false},
    {"by a walk", false},
    {"by the nearest point", false},
    {"by depth", false},
    {"by the whole difference", false},
    {"manifolds", false},
    {"contacts", false},
};

void profile_clear(struct profile *profile) {
    for (int i = 0; i < PROFILE_MEASURES; i++)
        free(profile->value[i]);
    *profile = (struct profile){0};
}

static bool reserve(struct profile *profile) {
    if (profile->count < profile->room)
        return true;
    const size_t room = 2 * profile->room + 1024;
    for (int i = 0; i < PROFILE_MEASURES; i++) {
        double *grown = realloc(profile->value[i], room * sizeof *grown);
        if (!grown)
            return false;
        profile->value[i] = grown;
    }
    profile->room = room;
    return true;
}

bool profile_add(struct profile *profile, const pir_scene *scene) {
    const pir_scene_profile p = pir_scene_get_profile(scene);
    const uint64_t parts[] = {p.places_ns, p.tree_ns, p.pairs_ns, p.looks_ns, p.questions_ns, p.unions_ns, p.events_ns};
    const uint64_t counts[] = {p.moved,   p.boxes,      p.replaced, p.looked,   p.asked,     p.by_proof,
                               p.by_walk, p.by_nearest, p.by_depth, p.by_whole, p.manifolds, p.contacts};
    if (!reserve(profile))
        return false;
    double sum = 0, *const *value = profile->value;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        sum += value[1 + i][profile->count] = (double)parts[i] / 1e3;
    value[0][profile->count] = sum;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        value[8 + i][profile->count] = (double)counts[i];
    profile->count++;
    return true;
}

bool profile_print(FILE *file, const struct profile *profile) {
    const char *before = "[";
    for (int i = 0; i < PROFILE_MEASURES; i++) {
        struct order order;
        double sum = 0;
        if (profile->count == 0 || (measures[i].is_time && !profile->timed))
            continue;
        if (!order_of(profile->value[i], profile->count, &order))
            return false;
        for (size_t k = 0; k < profile->count; k++)
            sum += profile->value[i][k];
        fprintf(file, "%s[\"%s\",\"%s\",%.6g,%.6g,%.6g]", before, measures[i].name, measures[i].is_time ? "µs" : "",
                sum / (double)profile->count, order.p99, order.max);
        before = ",";
    }
    fputs(*before == '[' ? "[]" : "]", file);
    return true;
}

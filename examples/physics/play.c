/* SPDX-License-Identifier: MIT */
/*
 * Plays; see play.h. A character moves after a frame; its body follows with the velocity that brings it there in the
 * next one. A rollback keeps the world and the characters after frame `to`, until frame `at` has come.
 */
#include "play.h"

#include <character.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vec.h"

/* A point is reached within this, in metres. */
#define REACHED 0.05

struct walker {
    struct character character;
    uint32_t next; /* the point that it goes to */
};

struct kept {
    struct world_state *world;
    struct walker *walker;
};

struct play {
    const struct stage *stage;
    struct world *world;
    struct walker *walker;
    struct kept *kept; /* per rollback */
    uint32_t frame, steps;
    void (*watch)(void *context, struct world *world);
    void *context;
};

static void drop(struct kept *kept) {
    world_state_destroy(kept->world);
    free(kept->walker);
    *kept = (struct kept){0};
}

void play_end(struct play *play) {
    if (!play)
        return;
    for (uint32_t i = 0; play->kept && i < play->stage->back_count; i++)
        drop(&play->kept[i]);
    world_destroy(play->world);
    free(play->kept);
    free(play->walker);
    free(play);
}

struct world *play_world(struct play *play) {
    return play->world;
}

uint32_t play_steps(const struct play *play) {
    return play->steps;
}

static size_t walkers_size(const struct play *play) {
    return (play->stage->walk_count + (size_t)1) * sizeof *play->walker;
}

/* Keeps the state for rollbacks that go to this frame. */
static pir_status keep(struct play *play) {
    for (uint32_t i = 0; i < play->stage->back_count; i++) {
        struct kept *kept = &play->kept[i];
        if (play->stage->back[i].to != play->frame || kept->world)
            continue;
        kept->world = world_save(play->world);
        kept->walker = malloc(walkers_size(play));
        if (!kept->world || !kept->walker)
            return PIR_ERR_MEMORY;
        memcpy(kept->walker, play->walker, walkers_size(play));
    }
    return PIR_OK;
}

static pir_status go_back(struct play *play) {
    pir_status status = PIR_OK;
    for (uint32_t i = 0; status == PIR_OK && i < play->stage->back_count; i++) {
        const struct stage_back *back = &play->stage->back[i];
        if (back->at != play->frame)
            continue;
        status = world_restore(play->world, play->kept[i].world);
        memcpy(play->walker, play->kept[i].walker, walkers_size(play));
        drop(&play->kept[i]);
        if (status == PIR_OK && back->body != UINT32_MAX)
            world_set_velocity(play->world, back->body, back->velocity);
    }
    return status;
}

pir_status play_begin(const struct stage *stage, void (*watch)(void *context, struct world *world), void *context,
                      struct play **ret_play) {
    struct play *play = calloc(1, sizeof *play);
    if (!play)
        return PIR_ERR_MEMORY;
    *play = (struct play){.stage = stage, .watch = watch, .context = context};
    play->steps = (uint32_t)nearbyint(1 / (STAGE_RATE * stage->options.step));
    play->walker = calloc(1, walkers_size(play));
    play->kept = calloc(stage->back_count + (size_t)1, sizeof *play->kept);
    pir_status status = play->walker && play->kept ? stage_world(stage, &play->world) : PIR_ERR_MEMORY;
    for (uint32_t i = 0; status == PIR_OK && i < stage->walk_count; i++) {
        const struct stage_walk *walk = &stage->walk[i];
        play->walker[i].character = (struct character){.spine = walk->spine,
                                                       .radius = walk->radius,
                                                       .body = walk->body,
                                                       .at = world_motion(play->world, walk->body).pose.translation};
    }
    status = status == PIR_OK ? keep(play) : status;
    if (status == PIR_OK)
        *ret_play = play;
    else
        play_end(play);
    return status;
}

/* Moves a character, and has its body follow. */
static pir_status walk(struct play *play, uint32_t number) {
    const struct stage_walk *walk = &play->stage->walk[number];
    struct walker *walker = &play->walker[number];
    pir_vec3 way = {0, 0, 0};
    while (walker->next < walk->count) {
        const double *to = walk->point[walker->next];
        way = (pir_vec3){to[0] - walker->character.at.x, to[1] - walker->character.at.y, 0};
        if (vec_length(way) > REACHED)
            break;
        walker->next++;
        way = (pir_vec3){0, 0, 0};
    }
    const double length = vec_length(way);
    way = length > 0 ? vec_times(walk->speed / length, way) : way;
    character_move(&walker->character, world_scene(play->world), way, 1. / STAGE_RATE);
    const pir_vec3 from = world_motion(play->world, walk->body).pose.translation;
    world_set_velocity(play->world, walk->body, vec_times(STAGE_RATE, vec_less(walker->character.at, from)));
    return walker->character.status;
}

pir_status play_frame(struct play *play) {
    pir_status status = PIR_OK;
    for (uint32_t i = 0; status == PIR_OK && i < play->steps; i++) {
        status = world_step(play->world);
        if (status == PIR_OK && play->watch)
            play->watch(play->context, play->world);
    }
    for (uint32_t k = 0; status == PIR_OK && k < play->stage->walk_count; k++)
        status = walk(play, k);
    play->frame++;
    status = status == PIR_OK ? go_back(play) : status;
    return status == PIR_OK ? keep(play) : status;
}

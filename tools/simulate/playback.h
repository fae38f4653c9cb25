/* SPDX-License-Identifier: MIT */
/*
 * A run of a world as one page of HTML that needs nothing else: bodies and contacts, played back by WebGL of its own.
 * Places are kept in quanta, a two-thousandth of the smallest moving body, and frames as what has changed since the one
 * before. Functions that return false have complained.
 */
#ifndef TOOLS_SIMULATE_PLAYBACK_H
#define TOOLS_SIMULATE_PLAYBACK_H

#include <stdbool.h>
#include <stdio.h>

#include <stage.h>

#include "../views/bytes.h"
#include "profile.h"

/* Frames a second. */
#define PLAYBACK_RATE 30

struct playback {
    const struct stage *stage;
    double quantum;
    struct bytes motion;   /* all frames */
    struct bytes contacts; /* those of the last frame */
    int64_t *pose;         /* seven numbers a body, as of the last frame */
    uint8_t *look, *next;  /* a level a body, of the last frame and of the one that is being made */
    uint32_t frames;
};

/* The stage outlives the playback. */
bool playback_init(struct playback *playback, const struct stage *stage);

void playback_clear(struct playback *playback);

/* Adds a frame: the world as it is. Bodies of the stage beyond those of the world are where the stage has them. */
bool playback_add(struct playback *playback, const struct world *world);

/* Prints the page, with a profile, or NULL; whether what was written arrived is the caller's to see. */
bool playback_print(FILE *file, const struct playback *playback, const char *title, const struct profile *profile);

#endif

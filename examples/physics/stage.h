/* SPDX-License-Identifier: MIT */
/*
 * A scene in a file: JSON with shapes and bodies. All keys but `shapes` and `bodies` may be missing.
 *
 *     {"title": TEXT, "about": TEXT, "gravity": [x,y,z], "seconds": S, "margin": METRES, "sleep": FLAG,
 *      "iterations": N, "relaxations": N,
 *      "rollbacks": [{"at": S, "to": S, "body": NUMBER, "velocity": [x,y,z]}, ...],
 *      "shapes": {NAME: SHAPE, ...},
 *      "bodies": [{"shape": NAME, "kind": "moving" | "kinematic" | "static", "position": [x,y,z], "quat": [x,y,z,w],
 *                  "velocity": [x,y,z], "spin": [x,y,z], "density": KG/M3, "friction": F, "restitution": R,
 *                  "sensor": FLAG, "walk": [[x,y], ...], "speed": M/S,
 *                  "grid": [N,N,N], "apart": [x,y,z], "turned": SEED}, ...]}
 *     SHAPE: {"model": "shape:NAME" or a file, from the folder of the scene on, "scale": F, "solid": FLAG},
 *            {"points": [[x,y,z], ...]}, whose hull is taken, or {"pieces": [SHAPE, ...]};
 *            of bodies that do not move by themselves also {"mesh": FILE, "scale": F, "two_sided": FLAG}, triangles as
 *            they are, or {"heights": FILE or [[z, ...], ...], "step": [x,y], "range": [z,z], "two_sided": FLAG}:
 *            a PNG, whose black and white are at the range, or rows of numbers, the first at
 *            y = 0, null or nan for a hole
 *
 * A solid is divided into convex pieces; of other models the hull is taken. A position is that of the shape's own
 * origin. A body with a grid is so many bodies, `apart` from one another, the first along x at its position. Their
 * `shape` may be an array of names, which are dealt out in turn; with `turned` each is turned by numbers of that seed.
 *
 * A body that walks is a character (examples/character): kinematic, convex, upright. It goes from point to point and
 * then stays. With rollbacks, the run goes at a time back to the state that it had at an earlier one, and gives a body
 * another velocity: times are those of the run.
 */
#ifndef PHYSICS_STAGE_H
#define PHYSICS_STAGE_H

#include "world.h"

struct stage_body {
    struct world_body body; /* its shape is one of the stage's */
    uint32_t shape;         /* which */
};

/* A body that walks. */
struct stage_walk {
    uint32_t body, count;
    double (*point)[2]; /* x and y */
    double speed, radius;
    pir_polytope *spine; /* with the radius the capsule that holds the body */
};

/* After frame `at` of the run the world is as it was after frame `to`. */
struct stage_back {
    uint32_t at, to;
    uint32_t body; /* gets the velocity; or UINT32_MAX */
    pir_vec3 velocity;
};

/* How many frames a second a run has, of steps of 1/240 s. */
#define STAGE_RATE 60

struct stage {
    char title[120], about[240];
    struct world_options options;
    double seconds;
    struct world_shape *shape;
    struct stage_body *body;
    struct stage_walk *walk;
    struct stage_back *back; /* in the order of `at` */
    uint32_t shape_count, body_count, walk_count, back_count;
};

/* Room for a line that says what is wrong with a file. */
#define STAGE_WHY 400

/* Reads a file, or standard input where `path` is "-". False after a line, which names the file, was left in `why`. */
bool stage_read(const char *path, struct stage *ret_stage, char why[STAGE_WHY]);

/* Reads a text; `name` is what the line calls it, and the folder of models is where the program runs. */
bool stage_read_text(const char *name, const char *text, struct stage *ret_stage, char why[STAGE_WHY]);

/* A zeroed stage is accepted. */
void stage_clear(struct stage *stage);

/* A world with the bodies of the stage, which must outlive it. */
pir_status stage_world(const struct stage *stage, struct world **ret_world);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * A scene in a file: JSON with shapes and bodies. All keys but `shapes` and `bodies` may be missing.
 *
 *     {"title": TEXT, "gravity": [x,y,z], "seconds": S, "margin": METRES, "sleep": FLAG, "iterations": N,
 *      "relaxations": N,
 *      "shapes": {NAME: SHAPE, ...},
 *      "bodies": [{"shape": NAME, "kind": "moving" | "kinematic" | "static", "position": [x,y,z], "quat": [x,y,z,w],
 *                  "velocity": [x,y,z], "spin": [x,y,z], "density": KG/M3, "friction": F, "restitution": R}, ...]}
 *     SHAPE: {"model": "shape:NAME" or a file, from the folder of the scene on, "scale": F, "solid": FLAG},
 *            {"points": [[x,y,z], ...]}, whose hull is taken, or {"pieces": [SHAPE, ...]};
 *            of bodies that do not move by themselves also {"mesh": FILE, "scale": F, "two_sided": FLAG}, triangles as
 *            they are, or {"heights": FILE or [[z, ...], ...], "step": [x,y], "range": [z,z], "two_sided": FLAG}:
 *            a PNG, whose black and white are at the range, or rows of numbers, the first at
 *            y = 0, null or nan for a hole
 *
 * A solid is divided into convex pieces; of other models the hull is taken. A position is that of the shape's own
 * origin.
 */
#ifndef PHYSICS_STAGE_H
#define PHYSICS_STAGE_H

#include "world.h"

struct stage_body {
    struct world_body body; /* its shape is one of the stage's */
    uint32_t shape;         /* which */
};

struct stage {
    char title[120];
    struct world_options options;
    double seconds;
    struct world_shape *shape;
    struct stage_body *body;
    uint32_t shape_count, body_count;
};

/* Room for a line that says what is wrong with a file. */
#define STAGE_WHY 400

/* Reads a file, or standard input where `path` is "-". False after a line, which names the file, was left in `why`. */
bool stage_read(const char *path, struct stage *ret_stage, char why[STAGE_WHY]);

/* A zeroed stage is accepted. */
void stage_clear(struct stage *stage);

/* A world with the bodies of the stage, which must outlive it. */
pir_status stage_world(const struct stage *stage, struct world **ret_world);

#endif

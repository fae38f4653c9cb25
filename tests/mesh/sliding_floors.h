/* SPDX-License-Identifier: MIT */
/* Floors that ghosts are felt on by those that have them, to slide over; and bodies that slide. */
#ifndef PIR_TEST_SLIDING_FLOORS_H
#define PIR_TEST_SLIDING_FLOORS_H

#include <pirouette/trimesh_contact.h>

/* A floor is FLOOR_LENGTH long in x, about 0, and repeats by FLOOR_STEP. */
#define FLOOR_LENGTH 60
#define FLOOR_STEP   4
#define FLOOR_KINDS  8
#define FLOOR_RIDGE  6
#define FLOOR_VALLEY 7
/* How steep the sides of the ridge and the valley are. */
#define FLOOR_SLOPE 0.25

typedef struct sliding_floor {
    const char *name;
    pir_trimesh **mesh;
    pir_height_field *field[2];
    pir_posed_surface *surface;
    double *from, *to; /* of each surface in x */
    uint32_t count;
} sliding_floor;

void floor_make(sliding_floor *floor, int kind);
void floor_clear(sliding_floor *floor);

/* The surfaces that reach from one x to another; how many. */
uint32_t floor_between(const sliding_floor *floor, double from, double to, pir_posed_surface *ret_surfaces,
                       uint32_t room);

#define SLIDER_KINDS  4
#define SLIDER_PIECES 4

typedef struct slider {
    const char *name;
    pir_polytope *piece[SLIDER_PIECES];
    uint32_t pieces;
    double radius, inertia; /* of a unit mass, about any axis */
    pir_pose pose;
    pir_vec3 velocity, spin;
} slider;

/* A body at rest on the plane z = 0, at a gap. */
void slider_make(slider *body, int kind, double gap);
void slider_clear(slider *body);

/* One frame under gravity with no friction: bodies rest at the gap. */
void slider_step(slider *body, const pir_surface_contact *contacts, size_t count, double gap);

#endif

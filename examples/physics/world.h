/* SPDX-License-Identifier: MIT */
/*
 * A small world of rigid bodies on pir_scene: bodies fall, touch, rub and come to rest.
 *
 * A step is 1/240 s. It takes the contacts that the scene found at the end of the step before and half of gravity,
 * finds impulses (solver.h), moves the bodies until something stops them (sweep.h), and tells the scene where they
 * are. With the other half of gravity, what meets bounces there (bounce.h), and what touches is held. Impulses are
 * kept by the ids of contacts from step to step. Bodies that have been still for half a second, with all that they
 * touch, sleep: they cost nothing until something that moves touches them.
 *
 * Numbers are made with +, −, ·, / and the square root alone, and the scene's are the same everywhere: so are runs.
 *
 * Units: metres, kilograms, seconds, radians.
 */
#ifndef PHYSICS_WORLD_H
#define PHYSICS_WORLD_H

#include <stdbool.h>

#include <pirouette/pirouette.h>

#define WORLD_CORES 3

/* A body's form: convex pieces about their common centre of mass. */
struct world_shape {
    pir_polytope **piece; /* `count` of them, a reference each */
    /* Each piece smaller about its middle, a little, more, and much: what may not be passed through. */
    pir_polytope **core[WORLD_CORES];
    uint32_t count;
    pir_mass mass;   /* of density 1, about the origin */
    double radius;   /* no point is farther from the origin */
    pir_vec3 offset; /* what was taken away from all coordinates */
    /* A surface in place of pieces, a reference: one of these. Its bodies are static or kinematic. */
    pir_trimesh *mesh;
    pir_height_field *field;
};

/* Moves pieces so that their centre of mass is the origin, exactly by a double. The pieces stay the caller's. */
pir_status world_shape_make(pir_polytope *const *pieces, uint32_t count, struct world_shape *ret_shape);

/* The shapes of surfaces, of which they hold a reference. */
struct world_shape world_shape_of_mesh(pir_trimesh *mesh);
struct world_shape world_shape_of_field(pir_height_field *field);

static inline bool world_shape_is_surface(const struct world_shape *shape) {
    return shape->mesh || shape->field;
}

/* Gives the references back; a zeroed shape is accepted. */
void world_shape_release(struct world_shape *shape);

struct world_options {
    pir_vec3 gravity;
    double step;          /* seconds */
    double margin;        /* how far apart pieces may be that have contacts */
    uint32_t iterations;  /* passes over all contacts before bodies move, which also push overlapping ones apart */
    uint32_t relaxations; /* passes after they moved */
    bool sleep;
    uint32_t threads; /* of the scene */
    double reuse;     /* of the scene: how far bodies may move before their contacts are found anew, in m */
    bool profile;     /* of the scene */
    /* NULL, or a clock in nanoseconds, by which the profile has times. */
    uint64_t (*clock)(void *context);
};

/* 9.81 m/s² along −z, 1/240 s, 5 mm, 8 and 4 passes, sleeping, one thread, contacts found anew in each step. */
struct world_options world_options_default(void);

struct world_body {
    pir_body_kind kind;
    pir_pose pose;
    pir_vec3 velocity, spin;
    const struct world_shape *shape; /* its pieces are referenced; a moving body's has a volume */
    double density;                  /* > 0 */
    double friction;                 /* ≥ 0; of two bodies the geometric mean counts */
    double restitution;              /* 0 to 1; of two bodies the greater counts */
    bool sensor;                     /* no moving one: nothing touches it, and what is in it is told */
};

/* Two pieces that touch or nearly do, as of the last step. */
struct world_contact {
    pir_vec3 point; /* in the middle between both bodies */
    pir_vec3 normal;
    double distance; /* negative where they overlap */
    double impulse;  /* along the normal, in the last step */
    uint32_t body_p, body_q;
};

/* What a body does. */
struct world_motion {
    pir_pose pose;
    pir_vec3 velocity, spin;
    bool asleep;
    bool sensed; /* in a sensor */
};

struct world;

pir_status world_create(const struct world_options *options, struct world **ret_world);

/* NULL is accepted. */
void world_destroy(struct world *world);

/* Bodies are numbered in the order in which they come. */
pir_status world_add(struct world *world, const struct world_body *body);

uint32_t world_count(const struct world *world);

/*
 * One step. Fails where memory runs out, or where a body goes where the scene does not reach (PIR_ERR_LIMIT,
 * PIR_ERR_NOT_FINITE); the world is then not to be used any more, but to be destroyed.
 */
pir_status world_step(struct world *world);

struct world_motion world_motion(const struct world *world, uint32_t body);

/* Gives a kinematic body another velocity, or a moving one, which it wakes. */
void world_set_velocity(struct world *world, uint32_t body, pir_vec3 velocity);

/*
 * All that steps depend on, to go back to: the same steps after it have the same bits. The bodies of the world must be
 * those that it had then. NULL where memory runs out.
 */
struct world_state *world_save(struct world *world);
pir_status world_restore(struct world *world, const struct world_state *state);

/* NULL is accepted. */
void world_state_destroy(struct world_state *state);

/* Mean over the moving bodies of speed; 0 where there are none. */
double world_mean_speed(const struct world *world);

/* The number of contacts, and each. */
uint32_t world_contact_count(const struct world *world);
struct world_contact world_contact(const struct world *world, uint32_t index);

/* What finds the contacts: for statistics and queries between steps. */
pir_scene *world_scene(struct world *world);

#endif

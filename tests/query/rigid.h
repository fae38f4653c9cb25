/* SPDX-License-Identifier: MIT */
/*
 * A small world of rigid bodies to try contact manifolds in: sequential impulses with warm starting by the contacts'
 * ids, Coulomb friction, no restitution, penetration pushed out by velocities of its own that do not last (after
 * Catto, "Iterative dynamics with temporal coherence", 2005).
 */
#ifndef PIR_TEST_RIGID_H
#define PIR_TEST_RIGID_H

#include <pirouette/query.h>

#define RIGID_BODIES   3
#define RIGID_PAIRS    3
#define RIGID_CONTACTS 64

typedef struct rigid_body {
    pir_polytope *shape; /* its centre of mass is its origin */
    pir_quat rotation;
    pir_vec3 place, velocity, spin;
    pir_vec3 push, push_spin; /* what ends penetration; cleared every frame */
    double inverse_mass;      /* 0: does not move */
    double inertia[3][3];     /* the inverse, in the body's frame */
} rigid_body;

typedef struct rigid_contact {
    uint64_t id;
    double distance;
    pir_vec3 arm_p, arm_q;
    pir_vec3 axis[3];              /* the normal and two tangents */
    pir_vec3 turn_p[3], turn_q[3]; /* the spin that an impulse of 1 along each gives the bodies, of Q its negative */
    double softness[3];            /* and how much it changes the speed along it */
    double impulse[3], push;       /* along the axes; of the pushes along the normal */
} rigid_contact;

typedef struct rigid_pair {
    uint32_t p, q;
    pir_sum *sum;
    pir_query *query;
    pir_query_cache cache;
    pir_vec3 normal;
    rigid_contact contact[RIGID_CONTACTS];
    size_t count;
} rigid_pair;

typedef struct rigid_world {
    rigid_body body[RIGID_BODIES];
    uint32_t bodies;
    rigid_pair pair[RIGID_PAIRS];
    uint32_t pairs;
    /* what tests ask for */
    unsigned long asked, missed; /* manifolds, and those that did not hold their answer */
    size_t most;                 /* contacts of one manifold */
} rigid_world;

pir_vec3 rigid_turn(pir_quat q, pir_vec3 v);
pir_quat rigid_product(pir_quat a, pir_quat b);
pir_quat rigid_inverse(pir_quat q);

/* The turn by the least angle that takes unit vector `from` to unit vector `to`, not its opposite. */
pir_quat rigid_turn_to(pir_vec3 from, pir_vec3 to);

/* Takes the shape over; `density` 0 makes a body that does not move. */
void rigid_add(rigid_world *world, pir_polytope *shape, double density, pir_vec3 place, pir_quat rotation);

/* Makes the pairs, all but those of two bodies that do not move. */
void rigid_start(rigid_world *world);

void rigid_step(rigid_world *world, double seconds);

/* The greatest speed of any point of the body, bounded by its farthest vertex. */
double rigid_speed(const rigid_body *body);

void rigid_clear(rigid_world *world);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Moves bodies so that none passes another. Fast ones are held against all that is in their way, one after the other,
 * and stop where they come near something: by the time of impact of a cast. The rest of the step is lost to them, and
 * nothing else: they keep their speed, with which they bounce or come to rest in the next one.
 *
 * What a body rests on is left to the impulses. It is only kept out of the body's cores, lest a fast spin carry these
 * past it within a step.
 *
 * It has scenes of its own, in which bodies stand where they are at that moment of the step.
 */
#ifndef PHYSICS_SWEEP_H
#define PHYSICS_SWEEP_H

#include "solver.h"

struct sweep {
    pir_scene *scene, *cores; /* of the bodies, and of their smallest cores */
    uint32_t *pending;        /* bodies that are still to move; room for all */
    pir_scene_move *moves;
    uint32_t room, stops; /* how many were stopped, in all steps */
};

struct sweep_rules {
    pir_vec3 gravity;
    double step;
    double margin; /* bodies farther apart than this have no contact yet */
    double near;   /* where one stops */
    double held;   /* what is nearer is held by impulses, and kept out of cores only */
};

pir_status sweep_init(struct sweep *sweep);
void sweep_finish(struct sweep *sweep);

/* Adds the body of the next number. */
pir_status sweep_add(struct sweep *sweep, const struct body *body, uint32_t number);

/* Moves all that moves over a step; the bodies that moved are the first *ret_moved of sweep->moves. */
pir_status sweep_step(struct sweep *sweep, struct body *body, uint32_t count, const struct sweep_rules *rules,
                      size_t *ret_moved);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Impulses at contacts, found one contact after the other (Guendelman, Bridson and Fedkiw, SIGGRAPH 2003; Catto, GDC
 * 2006), in many cheap passes that begin with the impulses of the step before.
 *
 * Overlap is a stiff, strongly damped spring (Catto, "Soft constraints", GDC 2011): passes before the bodies move push
 * them apart by it, passes afterwards take away the speed that this left. A contact of bodies that are still apart lets
 * them approach by just that distance.
 */
#ifndef PHYSICS_SOLVER_H
#define PHYSICS_SOLVER_H

#include "vec.h"
#include "world.h"

struct body {
    pir_body_kind kind;
    pir_pose pose;
    pir_vec3 velocity, spin;
    double inverse_mass; /* 0 unless it is a moving one, as is the inverse inertia */
    double radius, friction, restitution;
    struct mat3 inertia, inverse_inertia; /* in the body's frame */
    struct mat3 inverse_in_world;         /* at its pose */
    double still;                         /* for how many seconds it has been */
    bool asleep;
};

/* Whether it goes its own way: what it touches is kept awake. */
static inline bool body_is_driven(const struct body *body) {
    return body->kind == PIR_BODY_KINEMATIC &&
           vec_dot(body->velocity, body->velocity) + vec_dot(body->spin, body->spin) > 0;
}

/* One point of a contact. */
struct point {
    uint64_t id;
    pir_vec3 at_p, at_q; /* from the centres of both bodies to the middle of the contact */
    double distance;     /* where the step begins; after the bodies moved, where they are */
    double approach;     /* their speed along the normal before the step, negative where they near */
    double impulse;      /* along the normal, ≥ 0 */
    pir_vec3 rub;        /* the impulse of friction, across the normal */
    double mass, mass_across[2];
};

/* Two pieces in contact. */
struct link {
    uint32_t body_p, body_q, piece_p, piece_q;
    pir_vec3 normal, across[2]; /* from Q to P; across it, orthonormal */
    uint32_t first, count;      /* its points */
};

/* All contacts, in the order of body_p, body_q, piece_p, piece_q. */
struct contacts {
    struct link *link;
    struct point *point;
    uint32_t link_count, point_count, link_room, point_room;
};

/* Sets the masses of points and applies the impulses that they have. */
void solver_begin(struct body *body, const struct contacts *contacts);

/* One pass; `push` is whether overlap is worked off. */
void solver_pass(struct body *body, const struct contacts *contacts, double step, bool push);

/* Brings the distances of points to where the bodies are after a step at their present speeds. */
void solver_advance(const struct body *body, const struct contacts *contacts, double step);

/* Has bodies with a restitution bounce. */
void solver_bounce(struct body *body, const struct contacts *contacts);

#endif

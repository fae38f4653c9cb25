/* SPDX-License-Identifier: MIT */
/*
 * Impulses at contacts, found one contact after the other in many cheap passes that begin with the impulses of the
 * solve before (Guendelman, Bridson and Fedkiw, SIGGRAPH 2003; Catto, GDC 2006).
 *
 * A contact of bodies that are apart lets them approach by just the distance, less the gap at which they rest. Overlap
 * is worked off by speeds of its own, which move bodies and are then forgotten: no energy comes of it.
 *
 * A fast approach of bodies with a restitution is no business of these passes: such bodies fly until they meet, and
 * bounce there (bounce.h).
 */
#ifndef PHYSICS_SOLVER_H
#define PHYSICS_SOLVER_H

#include "motion.h"
#include "world.h"

struct body {
    pir_body_kind kind;
    pir_pose pose;
    pir_vec3 velocity, spin;
    double inverse_mass; /* 0 unless it is a moving one, as is the inverse inertia */
    double radius, friction, restitution;
    struct mat3 inertia, inverse_inertia; /* in the body's frame */
    struct mat3 inverse_in_world;         /* at its pose */
    pir_vec3 push, push_spin;             /* the speeds that work off overlap in this step */
    bool flies;                           /* towards something that it is to bounce from */
    bool waits;                           /* to be moved in this step */
    bool touches;                         /* something that may come to hold it */
    double work, change;                  /* of the impacts of its group, while they are found */
    double still;                         /* for how many seconds it has been */
    bool asleep;
    bool sensor;
    uint32_t sensed; /* how many pairs of pieces it shares with sensors */
    const struct world_shape *shape;
};

/* Whether it goes its own way: what it touches is kept awake. */
static inline bool body_is_driven(const struct body *body) {
    return body->kind == PIR_BODY_KINEMATIC &&
           vec_dot(body->velocity, body->velocity) + vec_dot(body->spin, body->spin) > 0;
}

static inline bool body_is_awake(const struct body *body) {
    return body->kind == PIR_BODY_MOVING && !body->asleep;
}

/* One point of a contact. */
struct point {
    uint64_t id;
    pir_vec3 at_p, at_q; /* from the centres of both bodies to the middle of the contact */
    double distance;
    double impulse; /* along the normal, ≥ 0 */
    double spent;   /* likewise, of the passes before the bodies moved, and of impacts */
    pir_vec3 rub;   /* the impulse of friction, across the normal */
    double push;    /* the impulse that works off overlap */
    bool free;      /* left to bounce.h */
    double mass, mass_across[2];
    struct {
        pir_vec3 before;    /* the relative velocity */
        double impulse;     /* along the normal, that stops the approach */
        pir_vec3 rub, both; /* across it; all that was applied */
        bool is;
    } bounce;
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

/* What the contacts of a world have in common. */
struct solver_rules {
    double step;   /* seconds */
    double gap;    /* at which bodies rest */
    double near;   /* nearer ones have met: they bounce, and may come to be held while they move (sweep.h) */
    double slop;   /* overlap that is left alone: working off the errors of passes would rock what stands */
    double bounce; /* slower approaches do not bounce, in m/s */
};

/* --- one contact --- */

/* Whether an impulse moves one of them. */
bool solver_yields(const struct body *p, const struct body *q);
void solver_apply(struct body *p, struct body *q, const struct point *point, pir_vec3 impulse);

/* How fast P moves as Q sees it, at a point. */
pir_vec3 solver_relative(const struct body *p, const struct body *q, const struct point *point);

/* The restitution of two bodies, and their friction. */
double solver_restitution(const struct body *p, const struct body *q);
double solver_friction(const struct body *p, const struct body *q);

/* --- all contacts --- */

/* Sets the masses of points, where bodies are now. */
void solver_place(const struct body *body, const struct contacts *contacts);

/* Applies the impulses that points have, to begin with. Those that are free are left out, and their bodies fly. */
void solver_begin(struct body *body, const struct contacts *contacts, const struct solver_rules *rules);

/* So many passes; `push` is whether overlap is worked off too. */
void solver_passes(struct body *body, const struct contacts *contacts, const struct solver_rules *rules, uint32_t count,
                   bool push);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The facets of two bodies as points that move over each other's Gaussian maps during a turn.
 *
 * A mover is a facet of P in Q's map, or one of Q in P's, seen from P. Where it is at κ follows from nothing else:
 * in a cell; on an arc for all κ of an interval, hence for all κ (`on`); or on a facet's point for all κ
 * (`pinned`). Cells are convex, so it leaves its cell at the first exit root after now of a side's s, quadratics that
 * are negative within. That root is its next instant, at which it is on the border of its cell, perhaps only to touch
 * it.
 *
 * Now is a value of κ: the beginning, where κ is greater than all roots, or a root. Places are those of a hair after
 * now.
 *
 * A key in [−1, 1] grows as κ falls: −σ/(|σ| + τ), which is no steeper in the angle θ/2 than 1 and at least
 * half as steep. Keys from doubles tell two roots apart where they differ by more than their slacks together; else
 * the roots are compared as quadratics.
 */
#ifndef PIR_MOTION_MOVERS_H
#define PIR_MOTION_MOVERS_H

#include "motion/parallels.h"
#include "motion/turning.h"

#define PIR_NONE UINT32_MAX

/* A side's root as seen by one mover. */
typedef struct pir_instant {
    double key, slack; /* the key is within the slack; infinite where there is none */
    uint32_t half;     /* of the other body, which leaves the mover's cell: the root is the exit root of its s */
    bool alone;        /* no other side of the cell has the root */
    bool simple;       /* certainly no double root */
} pir_instant;

typedef struct pir_mover {
    uint32_t cell;   /* a vertex of the other body, whose closed cell holds the mover */
    uint32_t on;     /* a halfedge that leaves `cell`, whose arc the mover stays on, or PIR_NONE */
    uint32_t pinned; /* a facet of the other body that the mover stays at, or PIR_NONE */
    pir_instant next;
} pir_mover;

/* Where now is. */
typedef struct pir_now {
    bool first;        /* the beginning: all else is that of (1, 0), without a root */
    double sigma, tau; /* of length 1 */
    double key, slack;
    uint32_t mover, half; /* whose root it is; PIR_NONE for a double */
    bool simple;          /* certainly no double root */
    bool has_root;        /* `root` of the movers is its quadratic */
    double kappa;         /* that double, finite */
} pir_now;

typedef enum pir_when { PIR_BEFORE, PIR_AT, PIR_AFTER } pir_when;

/* A body that the movers of the other one move over. */
typedef struct pir_ground {
    const pir_polytope *polytope;
    const pir_vec3 *direction; /* per halfedge, in the frame of Q at the beginning */
    uint32_t first;            /* the mover that its facet 0 is */
} pir_ground;

typedef struct pir_movers {
    pir_allocator allocator;
    pir_polytope *operand[2]; /* held; P as it is in the sum */
    pir_turning turning;
    pir_ground body[2];
    pir_vec3 *turned; /* P's directions by q₀ */
    pir_parallels parallels[2];
    int8_t *row; /* per mover: room for signs */
    uint32_t count;
    pir_form *form;   /* per mover */
    pir_mover *mover; /* per mover */
    pir_now now;
    pir_quadratic root; /* room for the quadratic of now */
    mp_limb_t *root_limbs;
    uint32_t limbs; /* of a coefficient */
    pir_limbs scratch;
    uint64_t by_filter, by_exact; /* how signs and orders were found */
} pir_movers;

/* Takes references to the operands. On failure there is nothing to finish. Sets no places. */
pir_status pir_movers_init(pir_movers *movers, const pir_allocator *allocator, pir_polytope *const operand[2],
                           pir_vec3 axis, const pir_rotation *rotation);
void pir_movers_finish(pir_movers *movers);

/* 0 for a facet of P, 1 for one of Q. */
static inline int pir_mover_body(const pir_movers *movers, uint32_t m) {
    return m >= movers->body[1].first;
}

static inline uint32_t pir_mover_facet(const pir_movers *movers, uint32_t m) {
    return m - movers->body[pir_mover_body(movers, m)].first;
}

static inline const pir_ground *pir_mover_ground(const pir_movers *movers, uint32_t m) {
    return &movers->body[1 - pir_mover_body(movers, m)];
}

/* Moves now to the beginning, to a finite κ, or to a mover's next instant. */
void pir_movers_begin(pir_movers *movers);
void pir_movers_go_to(pir_movers *movers, double kappa);
void pir_movers_advance(pir_movers *movers, uint32_t m);

/* Finds the place of every mover a hair after now, and its next instant. */
void pir_movers_locate(pir_movers *movers);

/* Finds `on`, `pinned` and the next instant of a mover, whose cell is that of a hair after now. */
void pir_movers_follow(pir_movers *movers, uint32_t m);

/*
 * The sign of s at now for a mover and a halfedge of the other body: positive where the halfedge's end is farther along
 * the mover's normal than its origin. The filter's alone is 0 where doubles cannot tell.
 */
int pir_movers_sign(pir_movers *movers, uint32_t m, uint32_t half, pir_when when);
int pir_movers_filter(const pir_movers *movers, uint32_t m, uint32_t half);

/* The sign of how far in the future the next instant of a is behind that of b: −1 where a's comes first. */
int pir_movers_order(pir_movers *movers, uint32_t a, uint32_t b);

/* The facet of the other body between side `half` of a mover's cell and the next, or another, both zero at now. */
uint32_t pir_movers_corner(pir_movers *movers, uint32_t m);

/* s of a mover and a halfedge, in room for it. */
void pir_movers_quadratic(const pir_movers *movers, uint32_t m, uint32_t half, pir_quadratic *dst, pir_limbs *scratch);

/* The quadratic of which now is the exit root, until now moves; not at the beginning. */
const pir_quadratic *pir_movers_now(pir_movers *movers);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The frame that queries compute in.
 *
 * Each operand is moved so that the middle of its bounding box is the origin, and scaled by one power of two, so that
 * sizes are near 1. The difference of the two operands is D = R·P ⊕ Q, where P is kept reflected. A translation t
 * becomes the point x of the frame, worked out in double-double, so neither a far origin nor a small scale costs
 * digits.
 *
 * The slack of a plane of D with unit normal n and offset h is s = h − n·x: all slacks positive is inside, one negative
 * is outside, and the least slack of all facets of D is the depth.
 */
#ifndef PIR_QUERY_FRAME_FRAME_H
#define PIR_QUERY_FRAME_FRAME_H

#include <math.h>

#include "base/memory.h"
#include "exact/rotation.h"
#include "polytope/polytope.h"
#include "query/frame/climb.h"
#include "query/frame/dd.h"

/*
 * A slack is known within err · PIR_SLACK_BOUND · (size_p + size_q + |x|).
 *
 * With u = 2^-53 and sizes r_P, r_Q: a rotated unit normal is off by 42u (exact/sign.h), which moves n·(q − x) by 42u
 * (r_Q + |x|); P's own offset n·p is off by 14u r_P (vertices 3u, normal 8u, dot product 3u); q, x and the last
 * operations add less than 12u (r_P + r_Q + |x|). Together below 68u; 2^-46 = 128u. An edge pair's normal is a cross
 * product of unit vectors off by 8u and 42u, so it is off by less than 64u / sin of their angle, and err is 1 / sin
 * there.
 */
#define PIR_SLACK_BOUND 0x1p-46

/* An operand in the frame: P reflected, not turned, or Q. */
typedef struct pir_body {
    const pir_polytope *polytope;
    pir_vec3 *vertex; /* about the middle of its bounds */
    double *offset;   /* per facet: normal · vertex */
    double size;      /* the length of the farthest vertex, rounded up */
    double swing;     /* how fast its support changes as directions turn: see planes/bounds.c */
    pir_dd3 centre;   /* the middle of its bounds, in units of the frame */
    double far;       /* how far that is from the origin, at most */
    uint32_t landmarks[PIR_LANDMARKS];
} pir_body;

typedef struct pir_frame {
    pir_body p, q;
    int exponent;    /* one unit of the frame is 2^exponent */
    double up, down; /* 2^exponent and 2^-exponent, or 0 where either is no normal number */

    /* the rotation that the frame is at */
    bool is_set;
    pir_quat given, unit; /* as the caller gave it, and of length 1 */
    pir_mat3 r;
    pir_dd3 offset; /* x = translation / 2^exponent − offset */
} pir_frame;

/* A placement brought into the frame. */
typedef struct pir_placement {
    pir_vec3 translation;
    pir_vec3 x;
    double reach; /* size_p + size_q + |x| */
    double error; /* PIR_SLACK_BOUND · reach, and what x itself may be off by */
} pir_placement;

/* Memory for two operands; they are borrowed. False when out of memory: pir_frame_finish frees what is there. */
bool pir_frame_init(pir_frame *frame, const pir_allocator *allocator, const pir_polytope *p, const pir_polytope *q);
void pir_frame_finish(pir_frame *frame, const pir_allocator *allocator);

/*
 * Fills in all that depends on coordinates, for operands that differ from those of pir_frame_init in scale alone. The
 * frame has no rotation after. `room` has the limbs of a vertex and one more. PIR_ERR_LIMIT where an operand is too far
 * from its origin.
 */
pir_status pir_frame_fill(pir_frame *frame, const pir_polytope *p, const pir_polytope *q, mp_limb_t *room);

/* Brings the frame to a rotation; false where it is there already. */
bool pir_frame_turn(pir_frame *frame, const pir_rotation *rotation);

/* Checks and converts a translation: PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT. */
pir_status pir_frame_place(const pir_frame *frame, pir_vec3 translation, pir_placement *ret_placement);

/* A point of the frame in world coordinates: that of Q's body, y given relative to Q's centre. */
pir_vec3 pir_frame_world(const pir_frame *frame, pir_vec3 y);

static inline double pir_frame_length(const pir_frame *frame, double length) {
    return frame->up != 0 ? length * frame->up : ldexp(length, frame->exponent);
}

static inline double pir_frame_from(const pir_frame *frame, double length) {
    return frame->up != 0 ? length * frame->down : ldexp(length, -frame->exponent);
}

/* Vertex (a, b) of D. */
static inline pir_vec3 pir_frame_vertex(const pir_frame *frame, uint32_t a, uint32_t b) {
    return pir_vec_add(pir_mat_apply(&frame->r, frame->p.vertex[a]), frame->q.vertex[b]);
}

#endif

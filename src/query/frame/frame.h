/* SPDX-License-Identifier: MIT */
/*
 * The frame that queries compute in.
 *
 * Each operand is moved so that the middle of its bounding box is the origin, and scaled by one power of two, so that
 * sizes are near 1. D = R·P ⊕ Q is the difference of the two operands; P is stored reflected. A translation t
 * becomes the point x of the frame. It is computed in double-double, so that neither a far origin nor a small scale
 * costs digits.
 *
 * The slack of a plane of D with unit normal n and offset h is s = h − n·x. Where all slacks are positive, x is
 * inside D. Where one is negative, x is outside. Inside, the least slack of all facets is the penetration depth.
 */
#ifndef PIR_QUERY_FRAME_FRAME_H
#define PIR_QUERY_FRAME_FRAME_H

#include <math.h>

#include "base/memory.h"
#include "exact/rotation.h"
#include "polytope/polytope.h"
#include "query/frame/around.h"
#include "query/frame/climb.h"
#include "query/frame/dd.h"
#include "query/frame/facet_shape.h"

/*
 * The error of a slack in doubles is at most err · PIR_SLACK_BOUND · (size_p + size_q + |x|).
 *
 * Proof, with u = 2^-53 and sizes r_P, r_Q (tests/proofs/slack.g has it for a machine). A unit normal is off by 6u,
 * and by 47u once rotated: the matrix is off by 35u where it is relative, the product rounds by 5.3u (exact/sign.h).
 * That moves n·(q − x) by 47u (r_Q + |x|). P's own offset n·p is off by 12u r_P: vertices 3u, normal 6u, dot
 * product 3u. A vertex of P that is rotated is off by 44u r_P, where the normal is Q's. q, x and the last operations
 * add less than 12u (r_P + r_Q + |x|). Together that is below 60u, and the bound is 128u.
 *
 * The normal of an edge pair is a cross product of unit vectors off by 6u and 47u. The product rounds by 3u and its
 * scaling by 5u, so the unit normal is off by less than 64u / sin of the edges' angle. `err` is 1 / sin for such
 * planes and 1 for all others. A slack then is off by less than (64 + 44 + 8)u · err.
 */
#define PIR_SLACK_BOUND 0x1p-46

/*
 * The limit on the distance of bodies and translations from their origins, in units of the frame. Beyond it squares
 * of squares could overflow.
 */
#define PIR_FARTHEST 0x1p400

/*
 * The error of a placement in double-double, relative to the distances of the bodies and of the translation from
 * their origins. It is sixteen times the proven one.
 */
#define PIR_FAR_ERROR 0x1p-96

/* An operand in the frame: P reflected, not turned, or Q. */
typedef struct pir_body {
    const pir_polytope *polytope;
    pir_vec3 *vertex; /* relative to the middle of its bounds */
    double *offset;   /* per facet: normal · vertex; behind them lie the facets' shapes */
    double size;      /* the length of the farthest vertex, rounded up */
    double swing;     /* how fast its support changes as directions turn: see depth/bounds.c */
    pir_dd3 centre;   /* the middle of its bounds, in units of the frame */
    double far;       /* an upper bound on the distance of the middle from the origin */
    uint32_t landmarks[PIR_LANDMARKS];
    const pir_around *around; /* NULL where there is none */
} pir_body;

/* The shapes of its facets, those that are known. */
static inline pir_kept_shape *pir_body_shapes(const pir_body *body) {
    return (pir_kept_shape *)(body->offset + body->polytope->facet_count);
}

typedef struct pir_frame {
    pir_body p, q;
    int exponent;    /* one unit of the frame is 2^exponent */
    float inner;     /* a ball about 0 with this radius is in D; minus infinity where none is known */
    double up, down; /* 2^exponent and 2^-exponent; both 0 where either is no normal number */

    /* the rotation that the frame is at */
    bool is_set;
    pir_quat given, unit; /* as the caller gave it, and of length 1 */
    pir_quat rest;        /* what `given` leaves: see exact/rotation.h */
    pir_mat3 r;
    pir_dd3 offset; /* x = translation / 2^exponent − offset */
} pir_frame;

/* A placement brought into the frame. */
typedef struct pir_placement {
    pir_vec3 translation;
    pir_vec3 x;
    double reach; /* size_p + size_q + |x| */
    double error; /* bound on the error of a slack at x, for a plane whose err is 1 */
} pir_placement;

/* Where both bodies stand: P's translation, and Q's place. */
typedef struct pir_world {
    pir_vec3 translation_p, translation_q;
    pir_rotation *rotation_q; /* its integers are made on demand */
} pir_world;

/* Whether Q is at the origin, not turned. */
static inline bool pir_world_is_plain(const pir_world *world) {
    pir_vec3 t = world->translation_q;
    return pir_quat_is_identity(world->rotation_q->given) && t.x == 0 && t.y == 0 && t.z == 0;
}

/*
 * The exponent of the greatest difference of two coordinates; INT_MIN for a point. `room` has the limbs of a vertex
 * and one more.
 */
int pir_body_exponent(const pir_polytope *polytope, mp_limb_t *room);

/* The exponent of the frame of two operands with these. */
int pir_frame_exponent(int exponent_p, int exponent_q, const pir_polytope *p, const pir_polytope *q);

/*
 * Fills in a body whose polytope and arrays are set; `room` as above. PIR_ERR_LIMIT where it is too far from its
 * origin.
 */
pir_status pir_body_fill(pir_body *body, int exponent, mp_limb_t *room);

/* Sets the unit. */
void pir_frame_set_exponent(pir_frame *frame, int exponent);

/* Sets the rotation. False where the frame has it already. */
bool pir_frame_turn(pir_frame *frame, const pir_rotation *rotation);

/* Sets the offset where P's middle is far from its origin. */
void pir_frame_set_far_offset(pir_frame *frame);

/* Whether P's middle is so far from its origin that turning it takes more than doubles. */
static inline bool pir_frame_is_far(const pir_frame *frame) {
    return frame->p.far > 4 * (frame->p.size + frame->q.size);
}

/*
 * Sets the offset of the frame: Q's middle plus P's rotated middle. Doubles suffice where P's middle is near its
 * origin.
 */
static inline void pir_frame_set_offset(pir_frame *frame) {
    if (frame->p.far == 0)
        frame->offset = frame->q.centre;
    else if (!pir_frame_is_far(frame))
        frame->offset = pir_dd3_add_vec(frame->q.centre, pir_mat_apply(&frame->r, pir_dd3_round(frame->p.centre)));
    else
        pir_frame_set_far_offset(frame);
}

/*
 * Sets a rotation that the frame may be at already, whose doubles it has; of one that is not relative `rest` is 0. The
 * offset is left to the caller; where P's middle is at its origin it is that of the bodies.
 */
static inline void pir_frame_set_given(pir_frame *frame, pir_quat given, pir_quat rest) {
    frame->is_set = true;
    frame->given = given;
    frame->rest = rest;
}

/* A translation in units of the frame. */
static inline pir_vec3 pir_frame_units(const pir_frame *frame, pir_vec3 t) {
    if (frame->down > 0)
        return pir_vec_scale(t, frame->down);
    return (pir_vec3){ldexp(t.x, -frame->exponent), ldexp(t.y, -frame->exponent), ldexp(t.z, -frame->exponent)};
}

/* Whether such a translation is finite and not too far. */
static inline bool pir_frame_is_near(pir_vec3 t) {
    return (fabs(t.x) < PIR_FARTHEST) & (fabs(t.y) < PIR_FARTHEST) & (fabs(t.z) < PIR_FARTHEST);
}

/* Sets x from the translation as Q has it, in units of the frame. */
static inline void pir_frame_set_x(const pir_frame *frame, pir_vec3 t, pir_placement *placement) {
    // about an offset of 0 the sum is t, and 0 where that is -0
    if (frame->p.far + frame->q.far > 0)
        placement->x = pir_dd3_add_rounded(pir_dd3_negate(frame->offset), t);
    else
        placement->x = (pir_vec3){t.x + 0.0, t.y + 0.0, t.z + 0.0};
}

/* Sets reach and error from x, for translations of length `far` at most. */
static inline void pir_frame_set_reach(const pir_frame *frame, double far, pir_placement *placement) {
    placement->reach = frame->p.size + frame->q.size + sqrt(pir_vec_dot(placement->x, placement->x));
    placement->error = PIR_SLACK_BOUND * placement->reach + PIR_FAR_ERROR * (far + frame->p.far + frame->q.far);
}

/* Checks a translation and converts it: PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT. */
static inline pir_status pir_frame_place(const pir_frame *frame, pir_vec3 translation, pir_placement *ret_placement) {
    const pir_vec3 t = pir_frame_units(frame, translation);
    if (!pir_frame_is_near(t))
        return pir_vec_is_finite(translation) ? PIR_ERR_LIMIT : PIR_ERR_NOT_FINITE;
    ret_placement->translation = translation;
    pir_frame_set_x(frame, t, ret_placement);
    pir_frame_set_reach(frame, fabs(t.x) + fabs(t.y) + fabs(t.z), ret_placement);
    return PIR_OK;
}

/*
 * The error of a translation that is turned in doubles, relative to its length: u = 2^-53 for its rounding, 31u for the
 * matrix, 6u for the product and the sum, together below 64u.
 */
#define PIR_TURN_ERROR 0x1p-47

/*
 * Places P as Q sees it, where Q is not at the identity and the difference of translations is not much longer than the
 * bodies. False elsewhere, and where translations may be wrong.
 */
static inline bool pir_frame_place_near(const pir_frame *frame, const pir_world *world, pir_placement *ret_placement) {
    const pir_vec3 to = pir_frame_units(frame, world->translation_p);
    const pir_vec3 from = pir_frame_units(frame, world->translation_q);
    const pir_dd x = pir_dd_two_sum(to.x, -from.x), y = pir_dd_two_sum(to.y, -from.y),
                 z = pir_dd_two_sum(to.z, -from.z);
    const pir_vec3 near = {x.hi + x.lo, y.hi + y.lo, z.hi + z.lo};
    if (!pir_frame_is_near(to) || !pir_frame_is_near(from) ||
        !(pir_vec_taxicab(near) <= 4 * (frame->p.size + frame->q.size)))
        return false;
    const pir_vec3 turned = pir_mat_apply_transposed(&world->rotation_q->r, near);
    ret_placement->translation = world->translation_p;
    pir_frame_set_x(frame, turned, ret_placement);
    pir_frame_set_reach(frame, pir_vec_taxicab(to) + pir_vec_taxicab(from), ret_placement);
    ret_placement->error += PIR_TURN_ERROR * pir_vec_taxicab(near);
    return true;
}

/*
 * Likewise where P is not turned in the world and its middle is far from its origin, as of a triangle of a terrain: the
 * way from middle to middle is turned, and not the way to P's origin and P's middle, each. It needs no offset.
 */
static inline bool pir_frame_place_middles(const pir_frame *frame, const pir_world *world,
                                           pir_placement *ret_placement) {
    const pir_vec3 to = pir_frame_units(frame, world->translation_p);
    const pir_vec3 from = pir_frame_units(frame, world->translation_q);
    const pir_dd3 t = {{pir_dd_two_sum(to.x, -from.x), pir_dd_two_sum(to.y, -from.y), pir_dd_two_sum(to.z, -from.z)}};
    double way[3];
    for (int k = 0; k < 3; k++) {
        const pir_dd part = pir_dd_sub(t.c[k], frame->p.centre.c[k]);
        way[k] = part.hi + part.lo;
    }
    const pir_vec3 near = {way[0], way[1], way[2]};
    if (!pir_frame_is_near(to) || !pir_frame_is_near(from) ||
        !(pir_vec_taxicab(near) <= 4 * (frame->p.size + frame->q.size)))
        return false;
    const pir_vec3 turned = pir_mat_apply_transposed(&world->rotation_q->r, near);
    ret_placement->translation = world->translation_p;
    ret_placement->x = pir_dd3_add_rounded(pir_dd3_negate(frame->q.centre), turned);
    pir_frame_set_reach(frame, pir_vec_taxicab(to) + pir_vec_taxicab(from), ret_placement);
    ret_placement->error += PIR_TURN_ERROR * pir_vec_taxicab(near);
    return true;
}

/*
 * Converts P's translation as Q sees it, for a body Q that stands in the world with a rotation and a translation.
 * Where Q is at the identity it is the same to the bit.
 */
pir_status pir_frame_place_relative(const pir_frame *frame, const pir_world *world, pir_placement *ret_placement);

static inline double pir_frame_length(const pir_frame *frame, double length) {
    return frame->up > 0 ? length * frame->up : ldexp(length, frame->exponent);
}

static inline double pir_frame_from(const pir_frame *frame, double length) {
    return frame->up > 0 ? length * frame->down : ldexp(length, -frame->exponent);
}

/* A point y in the frame of Q's body, relative to Q's middle, in world coordinates. */
static inline pir_vec3 pir_frame_world(const pir_frame *frame, pir_vec3 y) {
    // about a middle at the origin the sum is y, and 0 where that is -0
    pir_vec3 w =
        frame->q.far > 0 ? pir_dd3_add_rounded(frame->q.centre, y) : (pir_vec3){y.x + 0.0, y.y + 0.0, y.z + 0.0};
    if (frame->up > 0)
        return pir_vec_scale(w, frame->up);
    return (pir_vec3){pir_frame_length(frame, w.x), pir_frame_length(frame, w.y), pir_frame_length(frame, w.z)};
}

/* Vertex (a, b) of D. */
static inline pir_vec3 pir_frame_vertex(const pir_frame *frame, uint32_t a, uint32_t b) {
    return pir_vec_add(pir_mat_apply(&frame->r, frame->p.vertex[a]), frame->q.vertex[b]);
}

#endif

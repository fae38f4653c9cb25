/* SPDX-License-Identifier: MIT */
/*
 * The rest of a proof after the bodies have moved little.
 *
 * A facet of D was proven at a placement: its features were exposed, by so much that R has to turn by an angle before
 * they may not be, and its foot was inside of the rim by so much. At a placement that differs by a turn and a way of x
 * less than that both still hold. The foot has come nearer to the rim by no more than the way and the turn times the
 * reach. So only the numbers of the facet are computed anew, from the few vertices that they depend on.
 *
 * The same goes for a manifold of one contact.
 *
 * Decisions alone are held, never numbers: an answer has the bits of one for which all was proven anew.
 */
#ifndef PIR_PAIR_FACET_HELD_PROOF_H
#define PIR_PAIR_FACET_HELD_PROOF_H

#include "query/answer/manifold.h"
#include "query/last/same_facet.h"

typedef struct pir_held {
    bool some;
    uint16_t served; /* the calls that have looked at it, up to the most that it holds */
    float pace;      /* how far R turned from call to call while the last one lasted */
    pir_vec3 at;     /* the place of the proof */
    pir_quat turned;
    double falls;         /* as of pir_same_facet */
    pir_same_known known; /* at that place */
    pir_lone lone;
} pir_held;

/*
 * Whether R has certainly turned by too much, which most that is too long is told by: half of the angle between two
 * rotations is no less than the distance of their unit quaternions, up to sign.
 */
static inline bool pir_held_is_past(const pir_held *held, const pir_frame *frame) {
    return !(4 * pir_rotation_chord_square(held->turned, frame->unit) < held->falls * held->falls);
}

/* Ends it, R having turned by so much or more since. It may have served no call. */
static inline void pir_held_end(pir_held *held, double turn) {
    if (held->served > 0)
        held->pace = (float)(turn / held->served);
    held->some = false;
}

/* How far things have moved since. */
static inline pir_leeway pir_held_moved(const pir_held *held, const pir_frame *frame, const pir_placement *placement) {
    pir_vec3 way = pir_vec_sub(placement->x, held->at);
    // both ends of the way are off by the error of a placement
    return (pir_leeway){pir_rotation_angle_bound(held->turned, frame->unit),
                        sqrt(pir_vec_dot(way, way)) * (1 + 0x1p-40) + 4 * placement->error};
}

/* Holds what a proof of a facet at a placement has found. */
static inline void pir_held_set(pir_held *held, const pir_frame *frame, const pir_placement *placement,
                                const pir_same_facet *same) {
    const pir_facet *facet = &same->facet;
    uint32_t corner = facet->piece.kind == PIR_FACET_FV ? facet->a : facet->b;
    // member by member: of the lone contact only its kind says that there is none
    held->some = same->falls > 0;
    held->served = 0;
    held->at = placement->x;
    held->turned = frame->unit;
    held->falls = same->falls;
    held->known = (pir_same_known){same->margin, corner};
    held->lone.kind = PIR_LONE_UNKNOWN;
}

/* The rest of the proof after the bodies have moved; false where nothing is left. */
static inline bool pir_held_known(const pir_held *held, pir_leeway moved, const pir_placement *placement,
                                  pir_same_known *ret_known) {
    *ret_known = held->known;
    ret_known->margin -= (moved.way + moved.turn * placement->reach) * (1 + 0x1p-40);
    return moved.turn < held->falls && ret_known->margin > 0;
}

#endif

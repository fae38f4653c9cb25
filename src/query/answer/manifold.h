/* SPDX-License-Identifier: MIT */
/* The contact manifold of an answer, without a query object. */
#ifndef PIR_QUERY_ANSWER_MANIFOLD_H
#define PIR_QUERY_ANSWER_MANIFOLD_H

#include "query/contact/single.h"
#include "query/frame/frame.h"

/* Why a manifold is the answer's own contact and no other, or that nothing is known. */
typedef enum pir_lone_kind {
    PIR_LONE_UNKNOWN = 0,
    PIR_LONE_EDGES,  /* two edges cross, and nothing grows from either */
    PIR_LONE_VERTEX, /* a vertex is carried by a facet, no other corner is near */
} pir_lone_kind;

/* That it is, while the bodies have moved by no more since, and the answer has the same features. */
typedef struct pir_lone {
    pir_lone_kind kind;
    pir_leeway leeway; /* the turn of R, the way of x */
    pir_witness witness;
    double radius_p, radius_q, margin;
} pir_lone;

/* Calls from one to the next of which R turns by more than this, in radians, gain nothing from such a leeway. */
#define PIR_LONE_PACE 0x1p-9

typedef struct pir_manifold_ask {
    const pir_query_input *input; /* its radii and margin */
    const pir_query_result *answer;
    size_t capacity;
    pir_lone *ret_lone; /* or NULL; else the answer's normal is that of a facet of D */
    double pace;        /* then: how far R turns from call to call */
} pir_manifold_ask;

/* As pir_query_manifold, at a placement, in Q's frame; `room` is for the two bodies of the frame. */
pir_status pir_manifold_find(const pir_frame *frame, const pir_placement *placement, pir_patch_room *room,
                             const pir_manifold_ask *ask, pir_contact *ret_contacts, size_t *ret_count);

/*
 * The same where a lone contact is known to be one. False where it is for another input, or where the answer does not
 * say so: then nothing has been written.
 */
bool pir_manifold_lone(const pir_frame *frame, const pir_placement *placement, pir_patch_room *room,
                       const pir_manifold_ask *ask, const pir_lone *lone, pir_contact *ret_contacts);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Operands in the frame of an exponent. Such a body depends on one polytope alone, is made when it is first asked for,
 * stays with the polytope (polytope/attachment.h), and is shared by all pairs, queries and threads. Only the shapes of
 * its facets become known later, one by one (facet_shape.h).
 */
#ifndef PIR_QUERY_FRAME_BODY_H
#define PIR_QUERY_FRAME_BODY_H

#include "polytope/attachment.h"
#include "query/frame/frame.h"

/* A polytope in the frame of one exponent. */
typedef struct pir_kept_body {
    pir_attachment attachment;
    pir_body body;
    pir_around around; /* what body.around points to */
    pir_vec3 inner;    /* a point of it, inside where it has an inside, and of no symmetry */
    double inside;     /* the radius of a ball about the middle that it holds; minus infinity for none */
    double slip;       /* how far its support may be above where a climb ends, per slope; negative where not known */
} pir_kept_body;

/* The exponent of its size; INT_MIN for a point. PIR_ERR_MEMORY. */
pir_status pir_kept_exponent(pir_polytope *p, int *ret_exponent);

/* The polytope in the frame of an exponent. PIR_ERR_MEMORY, PIR_ERR_LIMIT where it is too far from its origin. */
pir_status pir_kept_body_of(pir_polytope *p, int exponent, const pir_kept_body **ret_body);

/* Sets both bodies of a frame, but not what depends on its unit. */
static inline void pir_frame_take_bodies(pir_frame *frame, const pir_kept_body *p, const pir_kept_body *q) {
    frame->p = p->body;
    frame->q = q->body;
    // less than what the sum is rounded by
    frame->inner = (float)((p->inside + q->inside) * (1 - 0x1p-20));
}

/*
 * Sets both bodies of a frame, which then has no rotation. p and q must outlive the frame's use. Errors as above; the
 * frame is then as it was.
 */
pir_status pir_frame_set_bodies(pir_frame *frame, pir_polytope *p, pir_polytope *q);

#endif

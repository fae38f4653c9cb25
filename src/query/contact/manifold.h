/* SPDX-License-Identifier: MIT */
/* The contact manifold of an answer, without a query object. */
#ifndef PIR_QUERY_CONTACT_MANIFOLD_H
#define PIR_QUERY_CONTACT_MANIFOLD_H

#include "query/contact/single.h"
#include "query/frame/frame.h"

typedef struct pir_manifold_ask {
    const pir_query_input *input; /* its radii and margin */
    const pir_query_result *answer;
    size_t capacity;
} pir_manifold_ask;

/* As pir_query_manifold, at a placement, in Q's frame; `room` is for the two bodies of the frame. */
pir_status pir_manifold_find(const pir_frame *frame, const pir_placement *placement, pir_patch_room *room,
                             const pir_manifold_ask *ask, pir_contact *ret_contacts, size_t *ret_count);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * What pairs keep of one polytope: it depends on that body alone, is made when a pair first needs it, stays with the
 * polytope (polytope/attachment.h) and is shared by all pairs and threads.
 */
#ifndef PIR_PAIR_BODY_H
#define PIR_PAIR_BODY_H

#include "polytope/attachment.h"
#include "query/frame/frame.h"

/* A polytope in the frame of one exponent. */
typedef struct pir_pair_body {
    pir_attachment attachment;
    pir_body body;
    pir_vec3 inner; /* a point of it, inside where it has an inside, and of no symmetry */
    double point;   /* along some direction all edges of a vertex fall by this sine at least; 0 where not known */
} pir_pair_body;

/* The exponent of its size; INT_MIN for a point. PIR_ERR_MEMORY. */
pir_status pir_pair_exponent(pir_polytope *p, int *ret_exponent);

/* The polytope in the frame of an exponent. PIR_ERR_MEMORY, PIR_ERR_LIMIT. */
pir_status pir_pair_body_of(pir_polytope *p, int exponent, const pir_pair_body **ret_body);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The slices asked last, each as a query on its sum. When there is no more room the one not asked for longest gives
 * way.
 */
#ifndef PIR_CSPACE_ANSWER_HELD_H
#define PIR_CSPACE_ANSWER_HELD_H

#include <stdbool.h>

#include "cspace/answer/source.h"

/* A slice that is held. */
typedef struct pir_held_slice {
    pir_cspace_place place;
    pir_query *query; /* NULL: nothing is held here */
    pir_query_cache cache;
    pir_vec3 inner_at; /* a translation of P, */
    double inner;      /* and a length by which it is at least inside of the difference; 0 where it is not */
    uint32_t next;     /* of its chain in the table */
    uint32_t newer, older;
} pir_held_slice;

typedef struct pir_held {
    pir_held_slice *slice;
    uint32_t *table; /* chains by a hash of the place */
    uint32_t room, used, newest, oldest;
} pir_held;

/* Room for `room` slices; false when out of memory. */
bool pir_held_init(pir_held *held, uint32_t room, const pir_allocator *allocator);
void pir_held_finish(pir_held *held, const pir_allocator *allocator);

/* The slice at a place, made from the source where it is not held. `inner_at` is for slices that are made. */
pir_status pir_held_get(pir_held *held, const pir_slice_source *source, pir_cspace_place place, pir_vec3 inner_at,
                        pir_report *report, pir_held_slice **ret_slice);

#endif

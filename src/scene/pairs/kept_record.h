/* SPDX-License-Identifier: MIT */
/*
 * Records of earlier answers of pairs, which updates may use again while the bodies have moved little: how far apart
 * they were, and contacts as points of each body; and the pool that records come from.
 *
 * Invariants
 *   - Points are in the frames of their bodies, so that they move with these.
 *   - `seen` is where one body stood to the other then: a pair sees the same one in all updates.
 *   - A record that is given back stays in the pool, for the next of its room.
 */
#ifndef PIR_SCENE_PAIRS_KEPT_RECORD_H
#define PIR_SCENE_PAIRS_KEPT_RECORD_H

#include <pirouette/query.h>

#include "base/memory.h"

/* A body as another one sees it, and a bound on how far that is from the exact place of any of its points. */
typedef struct pir_seen {
    pir_quat rotation; /* of length 1 but for rounding */
    pir_vec3 translation;
    double error;
} pir_seen;

/* An answer, and where the bodies stood. */
typedef struct pir_kept_answer {
    pir_seen seen;
    double distance;   /* signed */
    pir_vec3 point[2]; /* of P and of Q, in their frames, that far apart */
    pir_vec3 normal;   /* in the frame of the body that the other is seen from */
    pir_state state;
    pir_witness witness;
} pir_kept_answer;

/* The place of a contact in its list. */
typedef enum pir_kept_place {
    PIR_KEPT_ON = 0, /* of the event of the one before */
    PIR_KEPT_FIRST,  /* the first of an event */
    PIR_KEPT_NONE,   /* an event without contacts: no point counts */
} pir_kept_place;

typedef struct pir_kept_contact {
    pir_vec3 point[2]; /* of P and of Q, in their frames */
    pir_vec3 normal;   /* in the frame of the body that the other is seen from */
    pir_kept_place place;
    uint64_t id;
} pir_kept_contact;

typedef struct pir_kept_record {
    struct pir_kept_record *next; /* in the pool, or in a list of records to be */
    uint32_t room, count;         /* of contacts */
    pir_kept_answer answer;       /* of a pair alone */
    pir_seen made;                /* where the bodies stood when contacts were found */
    uint64_t union_number;        /* of a union: which one, and how many pairs it has; else 0 */
    uint32_t members;
    uint32_t label; /* in a snapshot: the first contact of the union, or the contact that a record is read for */
    pir_kept_contact contact[];
} pir_kept_record;

/* Rooms are 0, 4, 8, 16 and so on up to 2^20. */
#define PIR_KEPT_CLASSES 20

typedef struct pir_kept_pool {
    pir_kept_record *unused[PIR_KEPT_CLASSES];
} pir_kept_pool;

void pir_kept_pool_finish(pir_kept_pool *pool, const pir_allocator *allocator);

/* A record with room for so many contacts, without any; NULL when out of memory. */
pir_kept_record *pir_kept_pool_take(pir_kept_pool *pool, const pir_allocator *allocator, uint32_t contacts);

/* Gives a record back; NULL is accepted. */
void pir_kept_pool_give(pir_kept_pool *pool, pir_kept_record *record);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Records of contacts in bytes: the part of a snapshot of a scene with options.reuse behind its ends, for each contact
 *
 *     u32 flags: 1 has one of the pair, 2 of a union; contacts of both; pairs of the union, the first of these, state
 *     of the pair:  its answer: view, f64 distance, point of P[3], of Q[3], normal[3]; u32 kind, index of the feature
 *                   of P, of Q; the view when its contacts were found; contacts
 *     of the union: the view when they were found; contacts
 *
 * A view is f64 rotation[4], translation[3], error; a contact f64 point of P[3], of Q[3], normal[3]; u64 id, place.
 * Unions are told by the number of their first contact, for their own numbers depend on history.
 */
#ifndef PIR_SCENE_FILE_KEPT_BYTES_H
#define PIR_SCENE_FILE_KEPT_BYTES_H

#include "scene/file/snapshot.h"

/* Bytes of what the pair of a contact keeps. */
uint64_t pir_kept_size(const pir_scene_pair *pair);

/* Writes it; `first` is the number of the first contact of its union. */
void pir_put_kept(uint8_t **at, const pir_scene_pair *pair, uint32_t first);

/* Bytes that are being read, and the records that were in them. */
typedef struct pir_kept_reader {
    const uint8_t *at, *end;
    pir_kept_record *first, **last; /* `members` is that of a union, `label` the contact that it is of */
    bool keeps;                     /* whether the scene has a use for them */
} pir_kept_reader;

/*
 * Reads what contact `number`, of the pair `pair`, keeps. Records join the list. PIR_ERR_FORMAT, PIR_ERR_MEMORY; what
 * is in the list is the caller's to give back.
 */
pir_status pir_take_kept(pir_scene *scene, pir_kept_reader *reader, uint32_t number, const pir_scene_pair *pair);

#endif

/* SPDX-License-Identifier: MIT */
/* Records of contacts to bytes and back: see kept_bytes.h. */
#include "scene/file/kept_bytes.h"

#include <math.h>
#include <string.h>

#include "polytope/polytope.h"
#include "scene/file/put_bytes.h"

#define HAS_OWN   1u
#define HAS_UNION 2u

#define HEADER  24u
#define VIEW    64u
#define ANSWER  (VIEW + 96u)
#define CONTACT 88u

/* How far the length of a rotation may be from 1, squared: unit ones are within 2^-48. */
#define UNIT_ERROR 0x1p-46

/* --- to bytes --- */

static void put_vec(uint8_t **at, pir_vec3 v) {
    pir_put_double(at, v.x);
    pir_put_double(at, v.y);
    pir_put_double(at, v.z);
}

static void put_seen(uint8_t **at, const pir_seen *seen) {
    put_vec(at, (pir_vec3){seen->rotation.x, seen->rotation.y, seen->rotation.z});
    pir_put_double(at, seen->rotation.w);
    put_vec(at, seen->translation);
    pir_put_double(at, seen->error);
}

static void put_contacts(uint8_t **at, const pir_kept_record *record) {
    for (uint32_t i = 0; i < record->count; i++) {
        const pir_kept_contact *contact = &record->contact[i];
        put_vec(at, contact->point[0]);
        put_vec(at, contact->point[1]);
        put_vec(at, contact->normal);
        pir_put_bytes(at, contact->id, 8);
        pir_put_bytes(at, contact->place, 8);
    }
}

uint64_t pir_kept_size(const pir_scene_pair *pair) {
    return HEADER + (pair->kept ? ANSWER + VIEW + CONTACT * (uint64_t)pair->kept->count : 0) +
           (pair->united ? VIEW + CONTACT * (uint64_t)pair->united->count : 0);
}

void pir_put_kept(uint8_t **at, const pir_scene_pair *pair, uint32_t first) {
    const pir_kept_record *own = pair->kept, *united = pair->united;
    const uint32_t header[6] = {(own ? HAS_OWN : 0) | (united ? HAS_UNION : 0),
                                own ? own->count : 0,
                                united ? united->count : 0,
                                united ? united->members : 0,
                                united ? first : 0,
                                own ? (uint32_t)own->answer.state : 0};
    for (int k = 0; k < 6; k++)
        pir_put_bytes(at, header[k], 4);
    if (own) {
        const pir_witness *witness = &own->answer.witness;
        put_seen(at, &own->answer.seen);
        pir_put_double(at, own->answer.distance);
        put_vec(at, own->answer.point[0]);
        put_vec(at, own->answer.point[1]);
        put_vec(at, own->answer.normal);
        pir_put_bytes(at, witness->p.kind, 4);
        pir_put_bytes(at, witness->p.index, 4);
        pir_put_bytes(at, witness->q.kind, 4);
        pir_put_bytes(at, witness->q.index, 4);
        put_seen(at, &own->made);
        put_contacts(at, own);
    }
    if (united) {
        put_seen(at, &united->made);
        put_contacts(at, united);
    }
}

/* --- from bytes --- */

/* A number; *good becomes false where it is not finite. */
static double take_double(const uint8_t **at, bool *good) {
    const uint64_t bits = pir_snapshot_take(at, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    *good = *good && isfinite(value);
    return value;
}

static pir_vec3 take_vec(const uint8_t **at, bool *good) {
    pir_vec3 v;
    v.x = take_double(at, good);
    v.y = take_double(at, good);
    v.z = take_double(at, good);
    return v;
}

/* A view; one that was never set, of a pair without contacts, is of zeros. */
static pir_seen take_seen(const uint8_t **at, bool may_be_zero, bool *good) {
    pir_seen seen;
    const pir_vec3 v = take_vec(at, good);
    seen.rotation = (pir_quat){v.x, v.y, v.z, take_double(at, good)};
    seen.translation = take_vec(at, good);
    seen.error = take_double(at, good);
    const double norm = pir_quat_norm(seen.rotation);
    *good = *good && (fabs(norm - 1) <= UNIT_ERROR || (may_be_zero && norm == 0)) && seen.error >= 0;
    return seen;
}

/* A feature of a piece; a triangle's polytope may not be there yet. */
static pir_feature take_feature(const uint8_t **at, const pir_scene_piece *piece, bool *good) {
    const uint32_t kind = (uint32_t)pir_snapshot_take(at, 4), index = (uint32_t)pir_snapshot_take(at, 4);
    uint32_t count[PIR_FEATURE_FACET + 1] = {1, 3, 3, 2};
    const pir_polytope *p = piece->extent.polytope;
    if (p) {
        count[PIR_FEATURE_VERTEX] = pir_polytope_vertex_count(p);
        count[PIR_FEATURE_EDGE] = pir_polytope_edge_count(p);
        count[PIR_FEATURE_FACET] = pir_polytope_facet_count(p);
    }
    *good = *good && kind <= PIR_FEATURE_FACET && index < count[kind];
    return (pir_feature){kind <= PIR_FEATURE_FACET ? (pir_feature_kind)kind : PIR_FEATURE_NONE, index};
}

/* Contacts in `record`, or nowhere; those of a pair are of one event. */
static void take_contacts(const uint8_t **at, uint32_t count, bool is_own, pir_kept_record *record, bool *good) {
    for (uint32_t i = 0; i < count; i++) {
        pir_kept_contact contact;
        contact.point[0] = take_vec(at, good);
        contact.point[1] = take_vec(at, good);
        contact.normal = take_vec(at, good);
        contact.id = pir_snapshot_take(at, 8);
        const uint64_t place = pir_snapshot_take(at, 8);
        *good = *good && place <= PIR_KEPT_NONE && (i > 0 || place != PIR_KEPT_ON) &&
                (!is_own || (place == PIR_KEPT_FIRST) == (i == 0));
        if (!*good)
            return;
        contact.place = (pir_kept_place)place;
        if (record)
            record->contact[record->count++] = contact;
    }
}

/* A record for so many contacts in the list; `scratch` where the scene has no use for it. NULL when out of memory. */
static pir_kept_record *add_record(pir_scene *scene, pir_kept_reader *reader, uint32_t contacts, uint32_t number,
                                   pir_kept_record *scratch) {
    if (!reader->keeps)
        return scratch;
    pir_kept_record *record = pir_kept_pool_take(&scene->pairs.kept, &scene->allocator, contacts);
    if (!record)
        return NULL;
    record->label = number;
    *reader->last = record;
    reader->last = &record->next;
    return record;
}

static pir_kept_answer take_answer(const uint8_t **at, const pir_scene *scene, const pir_scene_pair *pair,
                                   uint32_t state, bool *good) {
    const pir_scene_piece *piece = scene->bodies.piece;
    pir_kept_answer answer;
    answer.seen = take_seen(at, false, good);
    answer.distance = take_double(at, good);
    answer.point[0] = take_vec(at, good);
    answer.point[1] = take_vec(at, good);
    answer.normal = take_vec(at, good);
    answer.witness.p = take_feature(at, &piece[pair->piece[0]], good);
    answer.witness.q = take_feature(at, &piece[pair->piece[1]], good);
    answer.state = (pir_state)state;
    return answer;
}

pir_status pir_take_kept(pir_scene *scene, pir_kept_reader *reader, uint32_t number, const pir_scene_pair *pair) {
    uint32_t header[6];
    pir_kept_record scratch = {.count = 0};
    if (reader->end - reader->at < (ptrdiff_t)HEADER)
        return PIR_ERR_FORMAT;
    for (int k = 0; k < 6; k++)
        header[k] = (uint32_t)pir_snapshot_take(&reader->at, 4);
    const bool own = (header[0] & HAS_OWN) != 0, united = (header[0] & HAS_UNION) != 0;
    const uint64_t need = (own ? ANSWER + VIEW : 0) + (united ? VIEW : 0) + CONTACT * ((uint64_t)header[1] + header[2]);
    bool good = header[0] <= (HAS_OWN | HAS_UNION) && (own || (header[1] == 0 && header[5] == 0)) &&
                (united ? header[3] > 0 && header[4] <= number : (header[2] | header[3] | header[4]) == 0) &&
                header[5] <= PIR_INSIDE && need <= (uint64_t)(reader->end - reader->at);
    if (own && good) {
        pir_kept_record *record = add_record(scene, reader, header[1], number, &scratch);
        if (!record)
            return PIR_ERR_MEMORY;
        record->answer = take_answer(&reader->at, scene, pair, header[5], &good);
        record->made = take_seen(&reader->at, header[1] == 0, &good);
        take_contacts(&reader->at, header[1], true, reader->keeps ? record : NULL, &good);
    }
    if (united && good) {
        pir_kept_record *record = add_record(scene, reader, header[2], number, &scratch);
        if (!record)
            return PIR_ERR_MEMORY;
        record->made = take_seen(&reader->at, false, &good);
        record->members = header[3];
        record->union_number = scene->unions_asked + 1 + header[4];
        take_contacts(&reader->at, header[2], false, reader->keeps ? record : NULL, &good);
    }
    return good ? PIR_OK : PIR_ERR_FORMAT;
}

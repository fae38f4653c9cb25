/* SPDX-License-Identifier: MIT */
/* See replay_hash.h. */
#include "history/replay_hash.h"

#include <string.h>

#include "base/byte_block.h"

static uint64_t hash_number(uint64_t hash, uint64_t number) {
    uint8_t bytes[8];
    for (int k = 0; k < 8; k++)
        bytes[k] = (uint8_t)(number >> (8 * k));
    return pir_hash_bytes(hash, bytes, sizeof bytes);
}

static uint64_t hash_double(uint64_t hash, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return hash_number(hash, bits);
}

static uint64_t hash_vec(uint64_t hash, pir_vec3 v) {
    return hash_double(hash_double(hash_double(hash, v.x), v.y), v.z);
}

uint64_t pir_replay_hash_sum(uint64_t hash, const pir_sum *sum, uint32_t (*pairs)[2]) {
    uint32_t facets = pir_polytope_facet_count(pir_sum_p(sum)), count = pir_sum_ee_count(sum);
    for (uint32_t f = 0; f < facets; f++)
        hash = hash_number(hash, pir_sum_fv(sum)[f]);
    facets = pir_polytope_facet_count(pir_sum_q(sum));
    for (uint32_t g = 0; g < facets; g++)
        hash = hash_number(hash, pir_sum_vf(sum)[g]);
    pir_sum_ee(sum, pairs);
    for (uint32_t i = 0; i < count; i++)
        hash = hash_number(hash_number(hash, pairs[i][0]), pairs[i][1]);
    return hash_double(hash, pir_sum_shortfall_bound(sum));
}

static uint64_t hash_witness(uint64_t hash, const pir_witness *witness) {
    hash = hash_number(hash_number(hash, witness->p.kind), witness->p.index);
    return hash_number(hash_number(hash, witness->q.kind), witness->q.index);
}

uint64_t pir_replay_hash_answer(uint64_t hash, const pir_query_result *answer) {
    hash = hash_number(hash_number(hash, answer->state), answer->outcome);
    hash = hash_vec(hash_double(hash, answer->distance), answer->normal);
    hash = hash_vec(hash_vec(hash, answer->point_p), answer->point_q);
    return hash_witness(hash, &answer->witness);
}

uint64_t pir_replay_hash_contacts(uint64_t hash, const pir_contact *contacts, size_t count) {
    hash = hash_number(hash, count);
    for (size_t i = 0; i < count; i++) {
        hash = hash_vec(hash_vec(hash, contacts[i].point_p), contacts[i].point_q);
        hash = hash_number(hash_double(hash, contacts[i].distance), contacts[i].id);
    }
    return hash;
}

uint64_t pir_replay_hash_events(uint64_t hash, const pir_scene *scene) {
    size_t count;
    const pir_scene_event *events = pir_scene_events(scene, &count);
    hash = hash_number(hash, count);
    for (size_t i = 0; i < count; i++) {
        const pir_scene_event *e = &events[i];
        const uint32_t numbers[7] = {e->kind,    e->body_p,           e->body_q, e->piece_p,
                                     e->piece_q, (uint32_t)e->sensor, e->state};
        for (int k = 0; k < 7; k++)
            hash = hash_number(hash, numbers[k]);
        hash = hash_double(hash_vec(hash_double(hash, e->distance), e->normal), e->approach);
        hash = pir_replay_hash_contacts(hash_witness(hash, &e->witness), e->contacts, e->contact_count);
    }
    return hash;
}

/* SPDX-License-Identifier: MIT */
/* Hashes and random numbers of golden histories. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "golden/golden.h"

test_random golden_random(uint64_t kind, uint64_t number) {
    test_random random = {{number + 1, 0x9e3779b97f4a7c15u * (kind + 1), 0xd1342543de82ef95u, kind + 1}};
    // the first numbers of states that differ little differ little
    for (int k = 0; k < 16; k++)
        test_random_bits(&random);
    return random;
}

void golden_require(pir_status status, const char *call) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "golden: %s: %s\n", call, pir_status_text(status));
    exit(2);
}

uint64_t golden_bytes(uint64_t hash, const void *data, size_t size) {
    const uint8_t *byte = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ byte[i]) * 0x100000001b3u;
    return hash;
}

uint64_t golden_number(uint64_t hash, uint64_t number) {
    for (int k = 0; k < 8; k++)
        hash = (hash ^ (number >> (8 * k) & 0xff)) * 0x100000001b3u;
    return hash;
}

uint64_t golden_double(uint64_t hash, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return golden_number(hash, bits);
}

uint64_t golden_vector(uint64_t hash, pir_vec3 v) {
    return golden_double(golden_double(golden_double(hash, v.x), v.y), v.z);
}

uint64_t golden_polytope(uint64_t hash, const pir_polytope *polytope) {
    hash = golden_number(hash, (uint64_t)pir_polytope_dimension(polytope));
    for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope); v++) {
        hash = golden_vector(hash, pir_polytope_vertex(polytope, v));
        hash = golden_number(hash, pir_polytope_source(polytope, v));
    }
    for (uint32_t e = 0; e < pir_polytope_edge_count(polytope); e++) {
        uint32_t ends[2];
        pir_polytope_edge(polytope, e, ends);
        hash = golden_number(golden_number(hash, ends[0]), ends[1]);
    }
    for (uint32_t f = 0; f < pir_polytope_facet_count(polytope); f++)
        hash =
            golden_vector(golden_number(hash, pir_polytope_facet_size(polytope, f)), pir_polytope_normal(polytope, f));
    return golden_double(hash, pir_polytope_volume(polytope));
}

uint64_t golden_answer(uint64_t hash, const pir_query_result *answer) {
    const pir_witness *w = &answer->witness;
    const uint32_t whole[6] = {answer->state, answer->outcome, w->p.kind, w->p.index, w->q.kind, w->q.index};
    for (int k = 0; k < 6; k++)
        hash = golden_number(hash, whole[k]);
    hash = golden_vector(golden_double(hash, answer->distance), answer->normal);
    return golden_vector(golden_vector(hash, answer->point_p), answer->point_q);
}

uint64_t golden_contacts(uint64_t hash, const pir_contact *contacts, size_t count) {
    hash = golden_number(hash, count);
    for (size_t i = 0; i < count; i++) {
        hash = golden_vector(golden_vector(hash, contacts[i].point_p), contacts[i].point_q);
        hash = golden_number(golden_double(hash, contacts[i].distance), contacts[i].id);
    }
    return hash;
}

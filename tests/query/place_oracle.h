/* SPDX-License-Identifier: MIT */
/*
 * The oracle of placements (oracle/place.h) as tests of single poses use it: where a translation lies in the
 * difference, how far from it, how deep in it.
 */
#ifndef PIR_TEST_PLACE_ORACLE_H
#define PIR_TEST_PLACE_ORACLE_H

#include <pirouette/query.h>

typedef struct place_oracle place_oracle;

place_oracle *place_oracle_make(pir_polytope *p, pir_polytope *q, pir_quat rotation);
void place_oracle_free(place_oracle *oracle);

typedef struct place_answer {
    pir_state state;
    double distance; /* outside */
    double depth;    /* inside */
} place_answer;

/* Exact but for the last rounding. */
place_answer place_oracle_ask(place_oracle *oracle, pir_vec3 translation);

/* How far the difference reaches beyond t along a direction of any length but zero; rounded. */
double place_oracle_slack(place_oracle *oracle, pir_vec3 translation, pir_vec3 direction);

/*
 * A vertex of the difference (index modulo their number), the middle of a facet, a point between two of its vertices,
 * rounded: translations nearly or quite on the boundary.
 */
pir_vec3 place_oracle_vertex(const place_oracle *oracle, uint32_t index);
pir_vec3 place_oracle_on_facet(const place_oracle *oracle, uint32_t index);
pir_vec3 place_oracle_on_edge(const place_oracle *oracle, uint32_t index);

/* The diagonal of a box about the difference. */
double place_oracle_size(const place_oracle *oracle);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The oracle of placements (oracle/place.h) for tests of single poses: where a translation lies in the difference,
 * its distance from it, its depth in it.
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

/* The answer at a translation, exact but for the last rounding. */
place_answer place_oracle_ask(place_oracle *oracle, pir_vec3 translation);

/* The distance that the difference reaches beyond t along a direction of any length but zero, rounded. */
double place_oracle_slack(place_oracle *oracle, pir_vec3 translation, pir_vec3 direction);

/*
 * Translations on the boundary, or nearly, because they are rounded: a vertex of the difference (index modulo their
 * number), the middle of a facet, a point between two of its vertices.
 */
pir_vec3 place_oracle_vertex(const place_oracle *oracle, uint32_t index);
pir_vec3 place_oracle_on_facet(const place_oracle *oracle, uint32_t index);
pir_vec3 place_oracle_on_edge(const place_oracle *oracle, uint32_t index);

/* The diagonal of a box about the difference. */
double place_oracle_size(const place_oracle *oracle);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The oracle of placement queries: where a translation lies in the difference, how far from it, how deep in it, by brute force over every
 * facet, edge and vertex of the exact hull of all pairwise sums, in GMP rationals. It shares nothing with the queries but that hull,
 * which knows no pairing.
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

/* The slack along any direction (of any length but zero): how far t can move along it, less what the support allows; rounded. */
double place_oracle_slack(place_oracle *oracle, pir_vec3 translation, pir_vec3 direction);

/* Vertex `index` (modulo their number), the middle of a facet, of an edge of it, rounded: translations that are nearly or quite on the boundary. */
pir_vec3 place_oracle_vertex(const place_oracle *oracle, uint32_t index);
pir_vec3 place_oracle_on_facet(const place_oracle *oracle, uint32_t index);
pir_vec3 place_oracle_on_edge(const place_oracle *oracle, uint32_t index);

/* The largest distance between two vertices of the difference's bounds. */
double place_oracle_size(const place_oracle *oracle);

#endif

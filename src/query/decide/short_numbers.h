/* SPDX-License-Identifier: MIT */
/*
 * Exact numbers of a placement in integers of fixed length, for bodies and poses as scenes have them: both turned and
 * moved by doubles of like size, coordinates that are doubles.
 *
 * The integers are those of placed.h but for powers of two, and numbers come from them by the same steps, so they have
 * the same bits. Every call returns false where the integers would be too long; then nothing is said.
 *
 * Few frames come here, so code comes from memory, and that takes longer than its instructions: `cold` has it short.
 */
#ifndef PIR_QUERY_DECIDE_SHORT_NUMBERS_H
#define PIR_QUERY_DECIDE_SHORT_NUMBERS_H

#include "query/decide/facet.h"

/* A corner of D, or an edge from there that is an edge of P or of Q at a vertex of the other. */
typedef struct pir_edge_of_d {
    uint32_t a, b;
    bool of_p, of_q; /* neither for a corner */
    uint32_t half;
} pir_edge_of_d;

/* The slack and its sign. */
bool pir_short_slack(const pir_exact *exact, pir_vec3 translation, const pir_facet *facet, int *ret_sign,
                     double *ret_slack);

/* The unit normal of two edges; 0 where they are parallel. */
__attribute__((cold)) bool pir_short_normal(const pir_exact *exact, pir_piece piece, pir_vec3 *ret_normal);

/* The fraction of an edge of Q at which an edge of P crosses it, as both are seen along their common normal. */
__attribute__((cold)) bool pir_short_part(const pir_exact *exact, pir_vec3 translation, uint32_t half_p,
                                          uint32_t half_q, double *ret_part);

/* The distance of x from a corner or the line of an edge, and the direction from there; (1, 0, 0) where x is on it. */
__attribute__((cold)) bool pir_short_distance(const pir_exact *exact, pir_vec3 translation, const pir_edge_of_d *edge,
                                              double *ret_distance, pir_vec3 *ret_normal);

#endif

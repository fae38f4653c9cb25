/* SPDX-License-Identifier: MIT */
/*
 * Critical angles of small bodies by brute force in integers of any length, which shares nothing with the library but
 * the exact vertices and the facets that polytopes tell.
 *
 * All quadratics of a normal of one body and an edge of the other are set up, and their roots found to 2^-BITS. Between
 * neighbouring roots the true sum is constant. Its facets at a rational κ are all pairs of faces that are farthest in
 * the direction of one of all normals it can have, and that span a plane.
 */
#ifndef PIR_TEST_BRUTE_TURN_H
#define PIR_TEST_BRUTE_TURN_H

#include <gmp.h>

#include <pirouette/polytope.h>

/* Bodies have at most so many vertices. */
#define BRUTE_VERTICES 62

/*
 * A facet of a sum: the vertices of P and of Q that make it, a bit each. With all vertices of a polygon goes bit 62 for
 * its facet 0 and bit 63 for the other one.
 */
typedef struct brute_facet {
    uint64_t p, q;
} brute_facet;

typedef struct brute_facets {
    brute_facet *at; /* in order */
    size_t count, room;
} brute_facets;

typedef struct brute_event {
    mpz_t low; /* 2^BITS κ, rounded */
    brute_facets before, after;
} brute_event;

typedef struct brute_turn {
    brute_event *event; /* κ falling */
    size_t count;
} brute_turn;

/* The bits of a root behind the point. Roots are one where they differ by less than 2^-BRUTE_SAME. */
#define BRUTE_BITS 1600
#define BRUTE_SAME 1200

/* All events of a turn. */
void brute_turn_make(const pir_polytope *p, const pir_polytope *q, pir_quat start, pir_vec3 axis, bool difference,
                     brute_turn *ret_turn);
void brute_turn_clear(brute_turn *turn);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * What fuzz_query.c asks about: pairs of bodies with a sum and a query, and placements read from bytes, each with the
 * exact answer and the error that a number may have.
 */
#ifndef PIR_FUZZ_QUERY_SCENE_H
#define PIR_FUZZ_QUERY_SCENE_H

#include <math.h>

#include <pirouette/pirouette.h>

#include "fuzz/input.h"
#include "query/place_oracle.h"

/* The error that a number may have, relative to the size of the bodies and of the answer. */
#define QUERY_BOUND 1e-12

/* Numbers are compared where lengths and their squares are far from the ends of the doubles. */
#define QUERY_LEAST 0x1p-400
#define QUERY_MOST  0x1p400

struct query_scene {
    pir_polytope *p, *q;
    pir_sum *sum;
    pir_query *query; /* NULL where the bodies are too far away */
    pir_query_cache cache;
};

struct query_ask {
    pir_query_input input;
    pir_vec3 direction;
    place_oracle *oracle;
    place_answer right;
    double should; /* the signed distance */
    double far;    /* the greatest coordinate of all */
    double bound;  /* of numbers; infinite where they are not compared */
};

/* Reads a vector: any doubles. */
pir_vec3 query_next_vector(struct fuzz_input *input);

/* Takes over the references to p and q. */
struct query_scene query_scene_make(pir_polytope *p, pir_polytope *q, pir_quat rotation);
void query_scene_free(struct query_scene *scene);

/* Whether a refusal for being too far away may be right, for bodies in place or a translation t. */
int query_may_be_far(const struct query_scene *scene, pir_vec3 t);

/* Reads a placement and a direction. */
struct query_ask query_next_ask(const struct query_scene *scene, struct fuzz_input *input, place_oracle *oracle);

static inline pir_vec3 query_add(pir_vec3 a, pir_vec3 b, double s) {
    return (pir_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline double query_length(pir_vec3 a) {
    return hypot(a.x, hypot(a.y, a.z));
}

static inline double query_largest(pir_vec3 a) {
    return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
}

#endif

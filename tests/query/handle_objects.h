/* SPDX-License-Identifier: MIT */
/* The objects of a program of handles and the model beside them: see handle_program.h. */
#ifndef PIR_TEST_HANDLE_OBJECTS_H
#define PIR_TEST_HANDLE_OBJECTS_H

#include <stdbool.h>

#include <pirouette/pirouette.h>

#include "fuzz/input.h"
#include "support/memory.h"

#define SLOTS    3
#define SUBJECTS (2 * SLOTS + 1) /* more than queries and live meshes together stand on */
#define POINTS   8

/*
 * What the model knows of a sum. The bodies are twins of those that the sum was made of, so that the model shares no
 * reference with the objects under test.
 */
struct subject {
    uint32_t uses;
    pir_polytope *p, *q;
    int difference;
    double scale[2];
    pir_quat rotation, shown; /* the rotation that the pairing is exact at, and the one that was asked for */
    bool behind, region, tolerant;
    pir_vec3 axis;
    double half_angle;
};

/* A body and its twin, an equal one of its own. */
struct body {
    pir_polytope *handle, *twin;
};

struct sum {
    pir_sum *handle;
    struct subject *subject;
};

struct query {
    pir_query *handle;
    struct subject *subject;
    pir_query_cache cache;
};

struct live {
    pir_live_mesh *handle;
    struct subject *subject;
};

/* A locator, and one of another map of the same body. */
struct locator {
    pir_cgm_locator *handle, *twin;
};

struct program {
    struct fuzz_input input;
    const char *failed;
    test_memory memory;       /* of sums and what stands on them */
    pir_workspace *workspace; /* of the sums that are not in slot 0 */
    struct subject subjects[SUBJECTS + SLOTS];
    struct body bodies[SLOTS];
    struct sum sums[SLOTS];
    struct query queries[SLOTS];
    struct live lives[SLOTS];
    struct locator locators[SLOTS];
};

static inline void need(struct program *program, bool condition, const char *what) {
    if (!condition && !program->failed)
        program->failed = what;
}

/* --- handle_answers.c --- */

/* Asks two queries the same placements, directions and casts, and notes a failure where their answers differ. */
void handle_compare_answers(struct program *program, pir_query *one, pir_query *other, const pir_query_input *input,
                            pir_vec3 along);

/* The same with batches. */
void handle_compare_batches(struct program *program, pir_query *one, pir_query *other, const pir_query_input *input);

/* The same with advances that do not turn, so that the sum keeps its rotation. */
void handle_compare_advances(struct program *program, struct query *query, pir_query *other, pir_vec3 from,
                             pir_vec3 along);

#endif

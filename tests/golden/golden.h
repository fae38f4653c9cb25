/* SPDX-License-Identifier: MIT */
/*
 * Golden histories: short uses of the library, each made of a number alone, with a hash of all that it gives. They are
 * the same on every machine, with every compiler and instruction set. Inputs are made with basic arithmetic and sqrt
 * alone, whatever PIR_TEST_SEED says. Hashes take numbers in one order of bytes.
 */
#ifndef PIR_TEST_GOLDEN_H
#define PIR_TEST_GOLDEN_H

#include <stddef.h>
#include <stdint.h>

#include <pirouette/base.h>
#include <pirouette/polytope.h>
#include <pirouette/query.h>

#include "support/random.h"

/* The hash of history `number` of each kind. */
uint64_t golden_sum(uint64_t number);      /* pairings, meshes, live meshes, bytes of a sum that turns */
uint64_t golden_query(uint64_t number);    /* answers of queries on a difference that turns */
uint64_t golden_pair(uint64_t number);     /* answers and manifolds of a pair that moves */
uint64_t golden_scene(uint64_t number);    /* events, snapshots and answers of a scene */
uint64_t golden_slices(uint64_t number);   /* records, planes and vertices of slices, as a file holds them */
uint64_t golden_solid(uint64_t number);    /* sums of solids that are not convex */
uint64_t golden_simplify(uint64_t number); /* simplified polytopes and their bounds */
uint64_t golden_file(uint64_t number);     /* models by name, and the text of files that are written */

/* Random numbers of a history; `kind` keeps kinds apart. */
test_random golden_random(uint64_t kind, uint64_t number);

/* Ends the program with a message unless the call succeeded. */
void golden_require(pir_status status, const char *call);

/* FNV-1a, on from `hash`. */
uint64_t golden_number(uint64_t hash, uint64_t number);
uint64_t golden_double(uint64_t hash, double x);
uint64_t golden_vector(uint64_t hash, pir_vec3 v);
uint64_t golden_bytes(uint64_t hash, const void *data, size_t size);
uint64_t golden_polytope(uint64_t hash, const pir_polytope *polytope);
uint64_t golden_answer(uint64_t hash, const pir_query_result *answer);
uint64_t golden_contacts(uint64_t hash, const pir_contact *contacts, size_t count);

/* The versions of the kernels: how many this processor runs, their names, and that all sums now take one of them. */
unsigned golden_kernels_count(void);
const char *golden_kernels_name(unsigned index);
void golden_kernels_take(unsigned index);

#endif

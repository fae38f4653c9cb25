/* SPDX-License-Identifier: MIT */
/*
 * Random numbers that repeat: xoshiro256** (Blackman and Vigna), seeded through splitmix64 from the run's seed and a
 * case number, so that any one case can be made again alone. The seed is 1 or what the environment variable
 * PIR_TEST_SEED says.
 */
#ifndef PIR_TEST_RANDOM_H
#define PIR_TEST_RANDOM_H

#include <stdint.h>

#include <pirouette/base.h>

typedef struct test_random {
    uint64_t state[4];
} test_random;

/* The seed of this run; test_print_seed tells it, once at the start of a program. */
uint64_t test_seed(void);
void test_print_seed(void);

/* The numbers of case `number` of `stream`, a word that keeps tests apart. */
test_random test_random_case(const char *stream, uint64_t number);

uint64_t test_random_bits(test_random *random);

/* 0 .. below − 1; below > 0. */
uint32_t test_random_below(test_random *random, uint32_t below);

/* low .. high, both included. */
int test_random_between(test_random *random, int low, int high);

/* [−1, 1), a multiple of 2^-52. */
double test_random_unit(test_random *random);

/* ±m·2^e with m random in [1, 2) and e random in low .. high. */
double test_random_scaled(test_random *random, int low, int high);

/* Uniform on the unit sphere; made with +, ·, / and sqrt alone, so the same bits everywhere. */
pir_vec3 test_random_direction(test_random *random);

#endif

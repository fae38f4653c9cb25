/* SPDX-License-Identifier: MIT */
/*
 * Parts of proofs in JSON: numbers as texts of integers and fractions in lowest terms, pieces, trees. docs/plan.md has
 * the format. Failures of the file are for the caller to ask for.
 */
#ifndef PIR_PLAN_PLAN_WRITE_H
#define PIR_PLAN_PLAN_WRITE_H

#include <stdio.h>

#include "plan/divide.h"

/* The file that is written to, what is written of, and a rational for scratch. */
typedef struct pir_plan_writer {
    FILE *file;
    const pir_plan_space *space;
    const pir_plan_sums *sums;
    const pir_plan_tree *tree;
    const uint32_t *root; /* per free cell, equal to `start` where it is connected with the start; or NULL: no sides */
    uint32_t start;
    uint32_t *corner; /* room for the corners of a facet */
    mpq_t x;
} pir_plan_writer;

void pir_plan_put_doubles(pir_plan_writer *writer, const double *x, int count);

/* A list of rationals. */
void pir_plan_put_rationals(pir_plan_writer *writer, const mpq_t *x, int count);

/* A question about any motion: bounds of translations, where the robot is at both ends, and pieces; borrowed. */
typedef struct pir_plan_asked {
    const double *low, *high, *at[2]; /* of three each */
    pir_quat rotation[2];
    const pir_plan_pieces *robot, *obstacles;
} pir_plan_asked;

/* The beginning of an object that proves something about it: a member of a name, 1, and the question. */
void pir_plan_put_asked(pir_plan_writer *writer, const char *kind, const pir_plan_asked *asked);

/* A member of an object: the list of convex pieces. */
void pir_plan_put_pieces(pir_plan_writer *writer, const char *name, const pir_plan_pieces *pieces);

/* A member of an object: the parts of the tree. */
void pir_plan_put_tree(pir_plan_writer *writer);

/* The most corners that a facet of pieces has, at least 1. */
uint32_t pir_plan_most_corners(const pir_plan_pieces *pieces);

#endif

/* SPDX-License-Identifier: MIT */
/* What Behar and Lien report in Dynamic Minkowski Sum of Convex Shapes (GMU-CS-TR-2010-12): their
   models and their Table 1. */
#ifndef BENCH_PAPER_H
#define BENCH_PAPER_H

#define PAPER_MODELS 13

struct paper_model {
    const char *name, *shape;
    unsigned facets; /* all triangles; ours are maximal, so some models have fewer */
};

extern const struct paper_model paper_model[PAPER_MODELS];

/* Brute-force time over update time of models i and j, either way round: one table, 500 steps a turn. */
double paper_speedup(unsigned i, unsigned j);

#endif

/* SPDX-License-Identifier: MIT */
/* The three experiments of Behar and Lien, section 5. Each writes CSV and SVG, and its part of the Markdown page. */
#ifndef BENCH_EXPERIMENTS_H
#define BENCH_EXPERIMENTS_H

#include "results.h"

/* The paper's step in experiments 1 and 3. */
#define PAPER_STEPS 500.0

void experiment_table1(const struct results *results, FILE *page);
void experiment_figure4(const struct results *results, FILE *page);
void experiment_figure5(const struct results *results, FILE *page);

#endif

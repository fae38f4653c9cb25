/* SPDX-License-Identifier: MIT */
/* The experiments of the dymsum paper, each beside the paper's figures. Usage: bench_dymsum FOLDER */
#include <stdio.h>

#include "experiments.h"
#include "trial.h"

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_dymsum FOLDER\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    FILE *page = results_open(&results, "dymsum.md");
    fprintf(page,
            "# The experiments of the dymsum paper\n\nMachine: %s; one thread. The paper: Behar and Lien, "
            "GMU-CS-TR-2010-12, "
            "an Intel processor at 2.13 GHz.\nTimes of updates hold the %.0f ns that two readings of the clock take; "
            "walks and brute force are in CPU time.\n\n",
            results.machine, trial_clock_cost());
    experiment_table1(&results, page);
    experiment_figure4(&results, page);
    experiment_figure5(&results, page);
    results_close(page, "dymsum.md");
    printf("results in %s\n", results.folder);
    return 0;
}

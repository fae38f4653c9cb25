/* SPDX-License-Identifier: MIT */
/* Where results go: a folder named by the machine, under the one that the program is given. */
#ifndef BENCH_RESULTS_H
#define BENCH_RESULTS_H

#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

struct results {
    char machine[128]; /* in words: the processor and its cores */
    char folder[1024];
};

/* Works the machine out and makes the folder. Ends the program with a message when it cannot. */
struct results results_new(const char *root);

/* Opens a file of that name to write; results_close ends the program with a message when writing failed. */
FILE *results_open(const struct results *results, const char *name);
void results_close(FILE *file, const char *name);

/* How often to do something: `usual`, or at most 3 times where the environment has PIR_BENCH_SMOKE: that shows only
   that tables are written. */
uint32_t results_count(uint32_t usual);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
/* How long the stages of our sum take, by the library's insides. */
#ifndef PIR_BENCH_STAGES_H
#define PIR_BENCH_STAGES_H

#include <pirouette/solid.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct stages {
    double decompose, pairs, whole; /* seconds of processor time */
    pir_solid_sum_info info;
} stages;

/* Seconds of processor time that this process has taken. */
double stages_clock(void);

/* Runs everything once. Ends the program with a message when something fails. */
stages stages_measure(const pir_solid *p, const pir_solid *q);

#ifdef __cplusplus
}
#endif

#endif

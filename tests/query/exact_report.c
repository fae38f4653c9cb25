/* SPDX-License-Identifier: MIT */
/* See exact_report.h. */
#include "query/exact_report.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The promise of query.h. */
#define PROMISE 1e-12
#define PRINTED 5

static const char *const names[EXACT_KINDS] = {
    "oracle",    "features", "state",   "distance", "depth",   "normal",           "relation", "holds",
    "witness",   "tie",      "cache",   "batch",    "exit",    "approach-outcome", "approach", "cast-outcome",
    "cast-time", "contact",  "escapes", "farthest", "rounded", "cutoff",           "manifold"};

static exact_tally tally[EXACT_KINDS];

exact_where exact_at;
static bool left_out[EXACT_KINDS];
static unsigned long long printed_limit;

int exact_report_only(const char *wanted) {
    for (int k = 0; k < EXACT_KINDS; k++)
        left_out[k] = wanted != NULL;
    while (wanted && *wanted) {
        size_t length = strcspn(wanted, ",");
        int kind = 0;
        while (kind < EXACT_KINDS && (strlen(names[kind]) != length || strncmp(names[kind], wanted, length) != 0))
            kind++;
        if (kind == EXACT_KINDS)
            return 0;
        left_out[kind] = false;
        wanted += length + (wanted[length] == ',');
    }
    return 1;
}

void exact_check(exact_kind kind, int holds, const char *format, ...) {
    if (left_out[kind])
        return;
    tally[kind].count++;
    if (holds)
        return;
    if (printed_limit == 0) {
        const char *text = getenv("PIR_TEST_PRINTED");
        printed_limit = text ? strtoull(text, NULL, 10) : PRINTED;
    }
    if (tally[kind].failed++ >= printed_limit)
        return;
    va_list list;
    va_start(list, format);
    printf("FAILED %s: ", names[kind]);
    vprintf(format, list);
    printf("\n    scene %llu, turn %d, pose %d: %s\n", exact_at.scene, exact_at.turn, exact_at.pose, exact_at.text);
    va_end(list);
}

void exact_number(exact_kind kind, const char *what, double is, double should, double scale) {
    double error = is == should ? 0 : fabs(is - should) / scale;
    if (left_out[kind])
        return;
    if (!(error <= tally[kind].worst))
        tally[kind].worst = error;
    exact_check(kind, error <= PROMISE, "%s %.17g, not %.17g (off by %.3g of %.3g)", what, is, should, error, scale);
}

exact_tally exact_report_take(void) {
    exact_tally all = {0, 0, 0};
    for (int k = 0; k < EXACT_KINDS; k++) {
        all.count += tally[k].count;
        all.failed += tally[k].failed;
        all.worst = fmax(all.worst, tally[k].worst);
        tally[k] = (exact_tally){0, 0, 0};
    }
    return all;
}

unsigned long long exact_report_print(void) {
    unsigned long long failed = 0;
    printf("%-18s%14s%10s%14s\n", "check", "count", "failed", "worst error");
    for (int k = 0; k < EXACT_KINDS; k++) {
        printf("%-18s%14llu%10llu", names[k], tally[k].count, tally[k].failed);
        if (tally[k].worst > 0)
            printf("%14.3g", tally[k].worst);
        printf("\n");
        failed += tally[k].failed;
    }
    return failed;
}

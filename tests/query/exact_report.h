/* SPDX-License-Identifier: MIT */
/*
 * The findings of exact checks: for each kind their number, the failures, and the worst error. The first failures of
 * each kind are printed.
 */
#ifndef PIR_TEST_EXACT_REPORT_H
#define PIR_TEST_EXACT_REPORT_H

#include <stdint.h>

typedef enum exact_kind {
    EXACT_ORACLE = 0, /* the oracle's two ways agree */
    EXACT_FEATURES,   /* facets and edges of the bodies */
    EXACT_STATE,      /* states and outcomes of placements, in every call */
    EXACT_DISTANCE,
    EXACT_DEPTH,
    EXACT_NORMAL,           /* unit, in the exact direction */
    EXACT_RELATION,         /* point_p = point_q + distance · normal */
    EXACT_HOLDS,            /* the witness's features hold the points */
    EXACT_WITNESS,          /* they are the faces that the rule of pir_witness asks for, exactly */
    EXACT_TIE,              /* the facet that the tie rule asks for, exactly */
    EXACT_CACHE,            /* answers with any cache and history, bit for bit */
    EXACT_BATCH,            /* answers of batches, bit for bit */
    EXACT_EXIT,             /* directional depth */
    EXACT_APPROACH_OUTCOME, /* directional distance */
    EXACT_APPROACH,
    EXACT_CAST_OUTCOME,
    EXACT_CAST_TIME,
    EXACT_CONTACT, /* points and features of casts and directions */
    EXACT_ESCAPES,
    EXACT_FARTHEST,
    EXACT_ROUNDED, /* with radii */
    EXACT_CUTOFF,
    EXACT_MANIFOLD,
    EXACT_KINDS,
} exact_kind;

/* The present case. It is printed with a failure, so that the failure can be repeated. */
typedef struct exact_where {
    unsigned long long scene;
    int turn, pose;
    char text[1024];
} exact_where;

extern exact_where exact_at;

/* Counts only the kinds of the given names from here on; all for NULL. Commas separate the names. 0 when a name is
   unknown. */
int exact_report_only(const char *names);

/* Counts a check. Where it failed, prints the printf-formatted text, for the first few of a kind. */
void exact_check(exact_kind kind, int holds, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Counts a number: |is − should| must be at most bound·scale. The worst |is − should| / scale is kept. */
void exact_number(exact_kind kind, const char *what, double is, double should, double scale);

/* What was found since the last call of this one: checks, failures, and the worst error of a number. */
typedef struct exact_tally {
    unsigned long long count, failed;
    double worst;
} exact_tally;

exact_tally exact_report_take(void);

/* Prints the table and returns the number of failures. */
unsigned long long exact_report_print(void);

#endif

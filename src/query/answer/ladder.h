/* SPDX-License-Identifier: MIT */
/*
 * The ways from a placement to an answer, tried in turn. Each ends with a proof at this placement, or leaves the
 * question open for the next. A pair tries a proof of an earlier pose before, for which no placement is made, and
 * the whole difference after (pair/answer.c).
 *
 *   - walk: from the facet of the last answer, by doubles, to the facet that holds the foot of x now
 *     (query/walk/walker.h). Where that separates, it is the nearest; where x is within it, foot.h tells whether it is
 *     the least. Where doubles leave the facet of the last answer in doubt, integers prove it.
 *   - depth, where the last answer was deep: from the facets that a source has kept.
 *   - nearest: a descent to the nearest point, proven by doubles, else by integers where x is certainly outside.
 *   - depth anew: the facet of least slack.
 *
 * Facets come from a source: a pair's are those of a closed surface of vertex pairs (pair/pair_depth.c), a sum's are
 * the pieces of its pairing (query/answer/answers.c).
 */
#ifndef PIR_QUERY_ANSWER_LADDER_H
#define PIR_QUERY_ANSWER_LADDER_H

#include "query/answer/result.h"
#include "query/walk/walker.h"

/* Where the next answer starts from. Never believed: an answer has the same bits whatever its hints were. */
typedef struct pir_hint {
    bool has_facet;
    bool deep;      /* the last answer took its facet from the source, x being inside */
    uint8_t points; /* of the simplex below */
    uint32_t a[3], b[3];
    pir_piece facet; /* of the last answer; its corner may have changed */
} pir_hint;

typedef struct pir_task pir_task;

/* The steps that a pair and a sum take in their own ways. */
typedef struct pir_facet_source {
    /*
     * Whether x is outside of D for certain, where a descent ended at task->simplex and did not prove the nearest
     * point. *ret_distance is at most the distance along the simplex's direction, 0 where none is certain.
     */
    bool (*is_outside)(pir_task *task, double *ret_distance);
    /* The answer from facets: those that were kept, before the descent, or, `anew`, all that is needed after it. */
    bool (*depth)(pir_task *task, bool anew);
    /* NULL, or keeps that the bodies are apart by a distance along n for certain. */
    void (*keep_apart)(pir_task *task, pir_vec3 n, double distance);
} pir_facet_source;

/* The way that gave the answer. */
typedef enum pir_task_way { PIR_WAY_OPEN, PIR_WAY_WALK, PIR_WAY_NEAREST, PIR_WAY_DEPTH } pir_task_way;

struct pir_task {
    const pir_facet_source *source;
    const pir_frame *frame;
    const pir_placement *placement;
    pir_exact *exact;
    pir_hint *hint;
    const pir_walker *walker;
    int want;
    double limit;            /* the cutoff and the radii, in the frame */
    bool may_near, may_deep; /* which ways the caller allows */
    bool was_deep;           /* as the hint had it */
    bool is_outside;         /* proven */
    bool has_same;           /* `same` is proven */
    bool in_doubt;           /* it may be the facet of the last answer, which doubles do not tell */
    pir_same_facet same;
    pir_simplex simplex;
    pir_piece decided; /* that of the true facet which the answer is by, x inside of D or on it; else none */
    pir_query_result *result;
};

/* Begins a task. The caller sets the members up to may_deep, and clears the result. */
static inline void pir_task_begin(pir_task *task) {
    task->is_outside = task->has_same = task->in_doubt = task->same.is_far = false;
    task->simplex.count = task->simplex.tried = 0;
    task->decided.kind = PIR_NO_PIECE;
}

/* The answer, by one of the ways; PIR_WAY_OPEN where none found it. */
pir_task_way pir_task_answer(pir_task *task);

/* Keeps a facet as a hint. */
static inline void pir_task_keep_facet(pir_task *task, const pir_facet *facet) {
    task->hint->facet = facet->piece;
    task->hint->has_facet = true;
}

/* --- answers from what is proven --- */

/* x outside of D, with the nearest point. */
void pir_task_near(pir_task *task, const pir_nearest *nearest);

/* x inside of D; `facet` is the one of least slack. */
void pir_task_inside(pir_task *task, const pir_facet *facet, double slack);

/* x on the boundary of D; `touching` is the first true facet that it is on, if any. */
void pir_task_touching(pir_task *task, const pir_least *touching);

/* The answer from task->same, proven with its slack, x outside. */
void pir_task_near_same(pir_task *task);

/* The answer from a true facet, where that is enough. */
bool pir_task_settle(pir_task *task, const pir_facet *facet);

/* The distance above which an answer is beyond the cutoff for certain. */
static inline double pir_task_least_beyond(const pir_task *task) {
    return task->limit + PIR_DISTANCE_ERROR * task->placement->reach;
}

#endif

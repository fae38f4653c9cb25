/* SPDX-License-Identifier: MIT */
/* The rest of a sum's candidates once the sums of all pairs of pieces have covered the inside. */
#ifndef PIR_SOLID_SUM_REMAINS_H
#define PIR_SOLID_SUM_REMAINS_H

#include "solid/body/solid_body.h"
#include "solid/space/polygons.h"
#include "solid/sum/convex.h"
#include "solid/sum/subtract.h"
#include "solid/sum/touching.h"

/* A candidate of which something is left. */
typedef struct pir_survivor {
    bool two_sided;        /* of open solids: the sum is on both sides of what is left */
    uint32_t half;         /* of one plane for all in it */
    uint32_t polygon;      /* the whole candidate, in `kept` */
    uint32_t first, count; /* what is left, in `kept` */
} pir_survivor;

typedef struct pir_remains {
    pir_space *space;
    pir_pair_sum *pair;
    uint32_t pair_count, pair_room;
    pir_boxes boxes;
    uint32_t *found; /* scratch: pairs whose boxes meet a candidate's */
    double *depth;   /* scratch, per pair: how deep in it the candidate's middle is */
    uint32_t *order, *work;
    uint32_t *half, half_room; /* scratch */
    pir_polygons polygons;     /* of the candidate at hand */
    pir_polygons kept;         /* the candidates, then what is left of them */
    pir_fragments fragments, covered;
    bool open;
    pir_touching touching; /* scratch, of the candidate at hand */
    pir_touching left;     /* segments and points that are left of all candidates of open solids */
    pir_survivor *survivor;
    uint32_t survivor_count, survivor_room;
    uint64_t candidates;
} pir_remains;

/* Makes the sums of all pairs of pieces, then clips every candidate by them; of open solids by the open sums first. The
 * status is the space's. */
void pir_remains_make(pir_remains *remains, const pir_shell_body body[2], pir_convexes convexes[2], bool open);
void pir_remains_finish(pir_remains *remains);

#endif

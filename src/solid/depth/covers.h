/* SPDX-License-Identifier: MIT */
/* Sums that have points inside: see covers.c. */
#ifndef PIR_SOLID_DEPTH_COVERS_H
#define PIR_SOLID_DEPTH_COVERS_H

#include "solid/depth/obstacle.h"

/* How many pairs are tried before all are. */
#define PIR_COVERS_LATE 16

/* A ball that holds a piece of P: the middle in P's own frame, the radius, both in units of the frame. */
typedef struct pir_cover_ball {
    double middle[3], radius;
} pir_cover_ball;

typedef struct pir_covers {
    pir_obstacle *obstacle;
    pir_cover_ball *ball;                  /* per piece of P */
    uint32_t late[PIR_COVERS_LATE], count; /* pairs whose sums have covered points of late, the last one first */
} pir_covers;

/* How deep places of the sum of a pair are to be in other sums: by `margin`, and by `turn` times how far a point of the
 * pair's piece of P may be from one of the other's. While no vector of P turns by more than `turn` times its length,
 * they stay deeper than `margin` then (kept_covers.h). */
typedef struct pir_cover_need {
    uint32_t pair;
    double margin, turn;
} pir_cover_need;

/* False when out of memory. */
bool pir_covers_init(pir_covers *covers, pir_obstacle *obstacle);
void pir_covers_finish(pir_covers *covers);

/* A pair in whose sum a point is inside, exactly: one of those of late, or the deepest; or none. */
uint32_t pir_covers_of(pir_covers *covers, uint32_t point);

/* A pair in whose sum a place is as deep as it needs to be, proven by doubles: the first guess, where it is one, one of
 * those of late, or any; or none. The place is within 2^-46. */
uint32_t pir_covers_about(pir_covers *covers, const pir_cover_need *need, uint32_t guess, const double x[3]);

/* How deep a place in a sum needs to be. */
double pir_covers_margin(const pir_covers *covers, const pir_cover_need *need, uint32_t cover);

/* The turn that some places, within 2^-46, can bear, all of them inside of one sum but that of `own`, as doubles prove;
 * 0 where none of late holds them. One that bears `enough` is as good as any. *guess is the pair that is asked first,
 * if any, and then the one that holds them. */
double pir_covers_all(pir_covers *covers, uint32_t own, double enough, uint32_t *guess, uint32_t count,
                      const double (*x)[3]);

#endif

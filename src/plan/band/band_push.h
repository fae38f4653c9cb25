/* SPDX-License-Identifier: MIT */
/* A band of poses, pushed across itself; see band.h. */
#ifndef PIR_PLAN_BAND_PUSH_H
#define PIR_PLAN_BAND_PUSH_H

#include "plan/band/band_bodies.h"

typedef struct pir_band_row {
    pir_band_pose *pose, *spare, *best; /* of `room` each, from malloc */
    uint32_t count, bests, room;
} pir_band_row;

/* Makes room for poses; false when out of memory. */
bool pir_band_row_reserve(pir_band_row *row, uint32_t count);
void pir_band_row_finish(pir_band_row *row);

/*
 * Adds a pose between two that are farther apart than the spacing and than their rooms, and drops one without which two
 * others are not. So a row is fine where it is narrow, and nowhere else. PIR_ERR_LIMIT where poses are too many.
 */
pir_status pir_band_space(const pir_band_bodies *bodies, double spacing, pir_band_row *row);

/* How far two poses in a row are apart, farther than their rooms; 0 where all motions between them are free. */
double pir_band_gap(const pir_band_bodies *bodies, const pir_band_row *row);

/* Pushes each pose once, but the ends; how deep the deepest one is then, or how much room it has, up to the reach. */
pir_status pir_band_push_row(pir_band_bodies *bodies, double length, double reach, pir_band_row *row,
                             double *ret_least);

/* Notes the poses as the best ones, and goes back to these. */
void pir_band_row_note(pir_band_row *row);
void pir_band_row_restore(pir_band_row *row);

#endif

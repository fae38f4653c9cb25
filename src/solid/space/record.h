/* SPDX-License-Identifier: MIT */
/*
 * A record of one job in a space: the points and planes that it made, and each side that it was told, once. A job
 * whose choices rest on sides alone, and on what holds at every rotation, chooses the same wherever the sides are the
 * same; so it need not be done again there, only the doubles of what it made are (pir_space_renew_point).
 *
 * Invariants while a space has a record:
 * - A side that is not 0 is in it, by whatever way it was told. One that is 0 by what the two are made of, or by what
 *   they are at rest (identity.h), holds at every rotation and is not. One that numbers alone say is 0 may end with
 *   this rotation: the record is `fleeting` then.
 * - Where a filter leaves something out without asking, it notes the sides that it has proven.
 */
#ifndef PIR_SOLID_SPACE_RECORD_H
#define PIR_SOLID_SPACE_RECORD_H

#include "solid/space/polygons.h"
#include "solid/space/space.h"

/* A side of a plane on which a point is: 1 or −1. */
typedef struct pir_told_side {
    uint32_t plane, point;
    int32_t sign;
} pir_told_side;

typedef struct pir_number_list {
    uint32_t *number, count, room;
} pir_number_list;

/* A polygon that is apart from a convex set: all of its corners are above one of the set's planes. Another of them may
 * take that one's place. */
typedef struct pir_parted_polygon {
    uint32_t set, plane;
    uint32_t first, count; /* of its corners */
    double until;          /* for whoever keeps it */
} pir_parted_polygon;

/* A polygon that a convex set covers; or, with no set, one that is left. */
typedef struct pir_met {
    uint32_t set, first, count;
} pir_met;

struct pir_side_record {
    pir_number_list points, planes; /* made, in order */
    uint32_t set;                   /* the convex set at hand, by a number of the job's */
    pir_parted_polygon *parted;
    uint32_t parted_count, parted_room;
    pir_met *met;
    uint32_t met_count, met_room;
    pir_number_list corners; /* of those that are apart or met */
    pir_told_side *told;
    uint32_t told_count, told_room;
    uint32_t *slot, slot_room; /* a told side + 1 at its hash, or 0; only while it is of this job */
    bool fleeting;
};

void pir_record_finish(pir_side_record *record, pir_space *space);

/* Begins a job, whose record replaces that of the one before; and ends it. */
void pir_record_begin(pir_side_record *record, pir_space *space);
void pir_record_end(pir_space *space);

/* Notes what was made. */
void pir_record_point(pir_space *space, uint32_t point);
void pir_record_plane(pir_space *space, uint32_t plane);

/* Notes a side that is not 0, once. */
void pir_record_side(pir_space *space, uint32_t plane, uint32_t point, int sign);

/* Notes that all corners of a polygon are on one side of a half-space. */
void pir_record_polygon(const pir_polygons *polygons, uint32_t polygon, uint32_t half, int side);

/* Notes that a polygon is apart from the set at hand, by a half-space whose plane all corners are above. */
void pir_record_parted(const pir_polygons *polygons, uint32_t polygon, uint32_t half);

/* Notes that a set covers a polygon, or with no set that the polygon is left. */
void pir_record_met(const pir_polygons *polygons, uint32_t polygon, uint32_t set);

/* Adds a number to a list. */
void pir_number_list_add(pir_number_list *list, pir_space *space, uint32_t number);

#endif

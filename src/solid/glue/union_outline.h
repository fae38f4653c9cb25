/* SPDX-License-Identifier: MIT */
/*
 * The boundary of unions of polygons, plane by plane: directed edges with the union on their left. And edges that are
 * no side of a polygon. cut_runs.h cuts them at each other.
 */
#ifndef PIR_SOLID_GLUE_OUTLINE_H
#define PIR_SOLID_GLUE_OUTLINE_H

#include "solid/space/places.h"
#include "solid/space/polygons.h"

/* The groups of edges that bound no polygon: where facets cross each other, and on their own. */
#define PIR_GROUP_CROSSING (UINT32_MAX - 1)
#define PIR_GROUP_LONE     UINT32_MAX

/* A run of a line. */
typedef struct pir_run {
    uint32_t group; /* of polygons in one plane, or of the two above */
    uint32_t half;  /* the group's, or a plane that holds the line */
    uint32_t line;
    uint32_t a, b; /* points, a before b along the line */
    int sign;      /* 1 when the edge leads from a to b, −1 when from b to a */
} pir_run;

/* A segment from a to b of the line where two planes meet. */
typedef struct pir_segment {
    uint32_t plane[2];
    uint32_t a, b;
} pir_segment;

typedef struct pir_segment_list {
    pir_segment *segment;
    uint32_t count, room;
} pir_segment_list;

/* A vertex within a run of a line, where runs of other lines end. */
typedef struct pir_outline_touch {
    uint32_t line, point;
} pir_outline_touch;

typedef struct pir_union_outline {
    pir_space *space;
    pir_places points, lines;
    uint32_t *line_direction, line_room;
    uint32_t (*line_plane)[2], line_plane_room; /* two planes that meet in the line */
    uint32_t *line_of, line_of_room; /* per plane of the group at hand: the line where it cuts the group's plane */
    pir_run *run;                    /* by group */
    uint32_t run_count, run_room;
    uint32_t loose; /* the first group whose runs may cross others within; none at first */
    pir_run *side;  /* scratch: the sides of the group at hand, the parts of a run */
    uint32_t side_count, side_room;
    pir_outline_touch *touch; /* by line */
    uint32_t touch_count, touch_room;
    uint32_t *order, order_room, *work, work_room, *place, place_room, place_count, *rank, rank_room;
    /* Of each line of the group at hand with more than two ends, where they are wanted: the other plane through it, how
     * many there are, and these in order. */
    bool keeps_chains;
    uint32_t *chain, chain_count, chain_room;
} pir_union_outline;

void pir_union_outline_init(pir_union_outline *outline, pir_space *space);
void pir_union_outline_finish(pir_union_outline *outline);

/* The line where two planes meet, and its direction. */
uint32_t pir_union_outline_line(pir_union_outline *outline, uint32_t f, uint32_t g);

/* Takes all points, lines and runs out, and keeps the memory. */
void pir_union_outline_clear(pir_union_outline *outline);

/* Adds edges in the plane of `half`, which is the first plane of each, as a group: they lead from a to b with the union
 * that they bound on their left, and do not overlap. */
void pir_union_outline_add(pir_union_outline *outline, uint32_t group, uint32_t half, const pir_segment *edge,
                           uint32_t count);

/* Adds the union of segments as runs of a group that has no polygons. */
void pir_union_outline_add_segments(pir_union_outline *outline, uint32_t group, const pir_segment *segment,
                                    uint32_t count);

/* Adds a run, or a side to the scratch. */
void pir_union_outline_push(pir_union_outline *outline, pir_run run);
void pir_union_outline_push_side(pir_union_outline *outline, pir_run side);

/* Puts 0 .. count in order into `order`; the order holds with equal ones as they stand. False when out of memory. The
 * context is the outline, or another. */
bool pir_union_outline_order(pir_union_outline *outline, uint32_t count, bool (*before)(void *, uint32_t, uint32_t),
                             void *context);
bool pir_union_outline_sort(pir_union_outline *outline, uint32_t count, bool (*before)(void *, uint32_t, uint32_t));

/* Adds a place to those collected, and puts them in order along a line, each once. */
void pir_union_outline_push_place(pir_union_outline *outline, uint32_t point);
bool pir_union_outline_sort_places(pir_union_outline *outline, uint32_t line);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The boundary of a solid within a space: its points, facets with their planes, edges with how they bend, and convex
 * polygons, the parts, that cover each facet.
 *
 * Halfedges are numbered corner by corner of the facets as given; those of the diagonals that cut a facet into parts
 * follow. A facet is left of its halfedges.
 *
 * Invariants of a body that was made without a fault: every facet is planar with an area, twin is an involution, and
 * facets that a flat edge joins have one plane, that of their `group`. Parts are convex, without straight corners.
 */
#ifndef PIR_SOLID_BODY_BODY_H
#define PIR_SOLID_BODY_BODY_H

#include "solid/space/space.h"

enum pir_bend { PIR_BEND_REFLEX = -1, PIR_BEND_FLAT = 0, PIR_BEND_CONVEX = 1 };

typedef struct pir_shell_body_edge {
    uint32_t half;        /* of the two, the one of the lower number */
    uint32_t a, b;        /* points, from its origin to its target */
    uint32_t left, right; /* facets */
    uint32_t direction;   /* from a to b */
    enum pir_bend bend;
} pir_shell_body_edge;

/* Facets as loops of point numbers, and what they are called in reports. */
typedef struct pir_shell_body_source {
    const char *name;
    pir_report *report;
    double unit;          /* what 1 in the space's doubles is in the units of the file */
    const uint32_t *line; /* per facet the line of the file, or NULL: facets are told by their numbers */
    uint32_t point_count, facet_count;
    const uint32_t *start, *corner;
} pir_shell_body_source;

typedef struct pir_shell_body {
    pir_space *space;
    pir_shell_body_source source;
    uint32_t first_point; /* point i of the source is point first_point + i of the space */
    uint32_t *plane;      /* per facet */
    uint32_t *half;       /* per facet: its half-space, of one plane for all facets in that plane */
    uint32_t *group;      /* per facet: the first of those that flat edges join it with */
    uint32_t half_count, half_room;
    uint32_t *origin, *next, *prev, *twin, *facet; /* per halfedge; origin is a point of the space */
    uint32_t edge_count, edge_room;
    pir_shell_body_edge *edge;
    uint32_t part_count, part_room, corner_count, corner_room;
    uint32_t *part_start, *part_corner; /* points, counter-clockwise; part_count + 1 starts */
    uint32_t *part_direction;           /* per corner: of the side that begins there */
    uint32_t *part_facet;
} pir_shell_body;

/*
 * Makes the body of `source`, whose points have their coordinates in the space's numbers 3i, 3i + 1, 3i + 2 from
 * `numbers` on. PIR_ERR_NOT_CLOSED and PIR_ERR_FORMAT are reported with the edge or the facet; else the space's status.
 */
pir_status pir_shell_body_make(pir_shell_body *body, pir_space *space, const pir_shell_body_source *source,
                               uint32_t numbers);
void pir_shell_body_finish(pir_shell_body *body);

/* The half-space of a facet. */
static inline uint32_t pir_shell_body_half(const pir_shell_body *body, uint32_t facet) {
    return pir_half(body->plane[facet], false);
}

/* "name:line" or "name: facet 7". */
#define PIR_BODY_WHERE 128
const char *pir_shell_body_where(const pir_shell_body_source *source, uint32_t facet, char ret_text[PIR_BODY_WHERE]);

/* "(x, y, z)" of a point of the space, in the units of the source. */
const char *pir_shell_body_place(const pir_shell_body *body, uint32_t point, char ret_text[PIR_BODY_WHERE]);

#endif

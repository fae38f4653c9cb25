/* SPDX-License-Identifier: MIT */
/*
 * Convex polygons in one plane n·x = d, exactly: corners in rationals, counter-clockwise about n, three or more.
 *
 * Half-planes are those of half-spaces m·x ≤ c. A part that is cut off has an inside, or it is dropped.
 */
#ifndef PIR_PLAN_OPENING_OPENING_POLYGON_H
#define PIR_PLAN_OPENING_OPENING_POLYGON_H

#include <stdbool.h>
#include <stdint.h>

#include <gmp.h>

#include <pirouette/polytope.h>

typedef struct pir_opening_polygon {
    mpq_t (*at)[3];
    uint32_t count;
    double low[3], high[3]; /* a box round it, widened by more than roundings */
} pir_opening_polygon;

typedef struct pir_opening_polygons {
    pir_opening_polygon *at;
    uint32_t count, room;
} pir_opening_polygons;

typedef struct pir_opening_half {
    mpq_t m[3], c;
} pir_opening_half;

void pir_opening_half_init(pir_opening_half *half);
void pir_opening_half_clear(pir_opening_half *half);

/* The half-space of a piece's facet. */
void pir_opening_half_of_facet(const mpq_t (*vertex)[3], const uint32_t corner[3], pir_opening_half *ret_half);

/* The half-plane, in a plane of normal n, left of the line from a to b, as a half-space across it. */
void pir_opening_half_of_side(const mpq_t n[3], const mpq_t a[3], const mpq_t b[3], pir_opening_half *ret_half);

/* m·x − c. */
void pir_opening_half_value(const pir_opening_half *half, const mpq_t x[3], mpq_t ret_value);

/* A polygon with room for corners, which are 0; false when out of memory. */
bool pir_opening_polygon_new(uint32_t count, pir_opening_polygon *ret_polygon);
void pir_opening_polygon_free(pir_opening_polygon *polygon);
/* Sets the box, of corners that are set. */
void pir_opening_polygon_bound(pir_opening_polygon *polygon);

/*
 * The part within a half-space, or beyond it where `beyond`; without corners where it has no inside, or, where
 * `closed`, no point. False when out of memory.
 */
bool pir_opening_polygon_clip(const pir_opening_polygon *polygon, const pir_opening_half *half, bool beyond,
                              bool closed, pir_opening_polygon *ret_part);

/* Takes a polygon over into a list, which frees it when it has no room. */
bool pir_opening_polygons_add(pir_opening_polygons *list, pir_opening_polygon *polygon);
void pir_opening_polygons_free(pir_opening_polygons *list);

static inline bool pir_opening_polygons_near(const pir_opening_polygon *a, const pir_opening_polygon *b) {
    for (int k = 0; k < 3; k++)
        if (a->low[k] > b->high[k] || b->low[k] > a->high[k])
            return false;
    return true;
}

#endif

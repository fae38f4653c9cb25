/* SPDX-License-Identifier: MIT */
/*
 * The contents of a file: points and facets as they stand in it, before the hull is taken.
 *
 * Points are doubles, or rationals once a coordinate is none. A facet is a loop of point numbers; a corner may be a
 * point that is read later, so that readers check at the end what they could not check before. Memory comes from the
 * caller's allocator.
 */
#ifndef PIR_POLYTOPE_SURFACE_MODEL_H
#define PIR_POLYTOPE_SURFACE_MODEL_H

#include <stdbool.h>

#include <gmp.h>

#include <pirouette/io.h>

/* Where a facet's corners begin, and the line of the file that it starts on; its corners end where those of the next
 * begin. */
struct pir_model_facet {
    uint32_t start, line;
};

struct pir_model {
    pir_allocator allocator;
    const char *name; /* for reports */
    pir_report *report;
    bool binary; /* facets are told by their numbers; else by the lines of the file that they start on */

    uint32_t point_count, point_room;
    pir_vec3 *points;
    mpq_t *exact; /* 3 · exact_count, or NULL while all coordinates are doubles */
    uint32_t exact_count;

    uint32_t facet_count, facet_room;
    struct pir_model_facet *facet;
    uint32_t corner_count, corner_room;
    uint32_t *corner;
};

static inline uint32_t pir_model_corners_end(const struct pir_model *model, uint32_t facet) {
    return facet + 1 < model->facet_count ? model->facet[facet + 1].start : model->corner_count;
}

void pir_model_init(struct pir_model *model, const char *name, const pir_allocator *allocator, pir_report *report);
void pir_model_finish(struct pir_model *model);

/* Reports that memory ran out. */
pir_status pir_model_fail_memory(const struct pir_model *model);

/* PIR_ERR_LIMIT where there are 2^30 points or facets, or more. For counts that are given before what they count. */
pir_status pir_model_check_counts(const struct pir_model *model, size_t points, size_t facets);

/* Room for `count` points in all, so that adding up to that many cannot fail. The caller has checked that the bytes of
   the file can hold so many. */
pir_status pir_model_reserve_points(struct pir_model *model, uint32_t count);

/* Adds a point, finite; a facet without corners; a corner of the last facet. PIR_ERR_MEMORY, PIR_ERR_LIMIT (2^30 points
 * or facets). */
pir_status pir_model_add_point(struct pir_model *model, pir_vec3 point);
pir_status pir_model_begin_facet(struct pir_model *model, size_t line);
pir_status pir_model_add_corner(struct pir_model *model, uint32_t point);

#endif

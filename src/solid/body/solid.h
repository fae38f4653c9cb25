/* SPDX-License-Identifier: MIT */
/* The inside of a solid: its points as integers on one scale, its facets as loops, and what was found out about it. */
#ifndef PIR_SOLID_BODY_SOLID_H
#define PIR_SOLID_BODY_SOLID_H

#include <stdatomic.h>

#include <pirouette/solid.h>

#include "exact/vectors.h"
#include "solid/body/solid_body.h"

struct pir_solid {
    atomic_uint references;
    pir_allocator allocator;
    pir_vectors points; /* times scale */
    pir_scale scale;
    uint32_t facet_count, corner_count;
    uint32_t *start, *corner; /* facet_count + 1; numbers of points */
    pir_solid_info info;
    mpq_t volume;
};

/* The parts that a solid is made of; everything is copied. */
typedef struct pir_solid_parts {
    const pir_vectors *points;
    const pir_scale *scale;
    pir_shell_body_source source; /* its loops and names; unit and point_count are filled in */
} pir_solid_parts;

/* PIR_ERR_EMPTY without facets; the errors of pir_solid_read for what is no solid. */
pir_status pir_solid_make(const pir_solid_parts *parts, const pir_solid_options *options, pir_solid **ret_solid);

/* The body of a solid in a space, which must have been made for numbers as long as the solid's. */
pir_status pir_solid_body(const pir_solid *solid, pir_space *space, pir_shell_body *ret_body);

/* The options to use: pir_options_take, with an allocator in them, which is put in *allocator. */
pir_status pir_solid_options_take(const pir_solid_options *options, pir_report *const *report, pir_allocator *allocator,
                                  pir_solid_options *ret_used);

#endif

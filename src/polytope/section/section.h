/* SPDX-License-Identifier: MIT */
/* The inside of a section. */
#ifndef PIR_POLYTOPE_SECTION_SECTION_H
#define PIR_POLYTOPE_SECTION_SECTION_H

#include <pirouette/section.h>

/* One block each, of `room` elements, of which `count` are in use. */
struct pir_section {
    pir_allocator allocator;
    pir_vec3 normal; /* the plane, as given */
    double offset;
    uint32_t count, room;
    pir_vec3 *corner;
    uint32_t (*edge)[2]; /* per corner, the smaller vertex first; both the same for a vertex */
};

#endif

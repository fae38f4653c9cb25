/* SPDX-License-Identifier: MIT */
/*
 * Seams: segments in which two sheets of a surface join, edges and what the cuts of facets into parts have left within
 * them. Where a seam lies in the inside of a part, or along another seam, sheets of one must not be on both sides of
 * those of the other.
 */
#ifndef PIR_SOLID_BODY_SEAMS_H
#define PIR_SOLID_BODY_SEAMS_H

#include "solid/body/solid_body.h"
#include "solid/space/boxes.h"

typedef struct pir_seam {
    uint32_t a, b;        /* points */
    uint32_t left, right; /* facets; the same within one */
    uint32_t direction;   /* from a to b, or none yet */
    bool edge;            /* of the body */
} pir_seam;

/* PIR_ERR_FORMAT, reported with an edge and a facet, where sheets cross at a seam. `boxes` are those of the parts, and
 * `found` has room for as many. */
pir_status pir_seams_check(pir_shell_body *body, const pir_boxes *boxes, uint32_t *found);

/* Reports that a seam meets a facet. */
pir_status pir_seam_refuse(const pir_shell_body *body, const pir_seam *seam, uint32_t facet);

#endif

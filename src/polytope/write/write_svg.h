/* SPDX-License-Identifier: MIT */
/* Pictures of bodies as SVG. The caller notices a stream in error. */
#ifndef PIR_POLYTOPE_WRITE_WRITE_SVG_H
#define PIR_POLYTOPE_WRITE_WRITE_SVG_H

#include <stdio.h>

#include <pirouette/mesh.h>

/* A whole picture of one body, with a legend when its facets are of more than one kind. */
pir_status pir_mesh_write_svg(const pir_mesh *mesh, FILE *file);

/*
 * One body as it lies in the view: what a picture needs to place it. A point v of the mesh is drawn, in units of
 * `radius`, at the projection of (v − centre)/radius, x to the right and y down, as SVG has it; low and high bound
 * that projection.
 */
struct pir_svg_body {
    const pir_mesh *mesh;
    pir_vec3 centre;
    double radius; /* the largest |coordinate| of v − centre; 0 for a point */
    double low[2], high[2];
    unsigned kinds; /* bit 1 << kind for each kind of facet that is drawn */
};

struct pir_svg_body pir_svg_measure(const pir_mesh *mesh);

/*
 * Writes the body as one <g> element, its centre at (x, y) of the picture and `scale` picture units for one radius.
 * Bodies drawn to one scale have scale proportional to radius.
 */
void pir_svg_write_body(FILE *file, const struct pir_svg_body *body, double x, double y, double scale);

/* The width of a legend of these kinds, and the legend itself, its upper left corner at (x, y), PIR_SVG_LEGEND_HEIGHT
 * high. */
#define PIR_SVG_LEGEND_HEIGHT 20.0
double pir_svg_legend_width(unsigned kinds);
void pir_svg_write_legend(FILE *file, unsigned kinds, double x, double y);

#endif

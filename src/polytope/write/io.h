/* SPDX-License-Identifier: MIT */
/*
 * The parts behind io.h of the public headers: bytes of a file, one reader or writer per format, pictures of bodies.
 *
 * Readers get the whole file in memory and a short name for reports; writers get an open stream and leave it to write.c
 * to notice a stream in error. Numbers use '.' whatever the process's locale says.
 */
#ifndef PIR_POLYTOPE_WRITE_IO_H
#define PIR_POLYTOPE_WRITE_IO_H

#include <locale.h>
#include <stdbool.h>
#include <stdio.h>

#include <pirouette/io.h>

/* The largest file or text that is read: 2 GiB. Below it, lines, vertices and facets all count in 32 bits. */
#define PIR_FILE_SIZE_MAX ((size_t)1 << 31)

/* The thread's locale put aside for "C" between enter and leave; enter returns false when out of memory. */
struct pir_c_locale {
    locale_t own, previous;
};
bool pir_c_locale_enter(struct pir_c_locale *ret_locale);
void pir_c_locale_leave(struct pir_c_locale *locale);

/* Which reader and writer a file has. */
enum pir_file_type { PIR_FILE_UNKNOWN, PIR_FILE_OFF, PIR_FILE_ASSIMP, PIR_FILE_SVG };

/* The type by the ending, in either case; ret_ending gets it in lower case without the dot. */
enum pir_file_type pir_file_type_of(const char *path, char ret_ending[4]);

/* The last part of a path, short enough to leave room for what went wrong. */
const char *pir_short_name(const char *path);

/* The bounds of a mesh's vertices. */
void pir_mesh_bounds(const pir_mesh *mesh, pir_vec3 *ret_low, pir_vec3 *ret_high);

/* OFF to a stream: exact rationals where `exact`, else the shortest decimal that reads back as the same double. */
pir_status pir_mesh_write_off(const pir_mesh *mesh, FILE *file, bool exact);

/* OBJ, STL and PLY through assimp; `ending` is "obj", "stl" or "ply". Where the build has no assimp:
 * PIR_ERR_UNSUPPORTED. */
pir_status pir_mesh_write_assimp(const pir_mesh *mesh, FILE *file, const char *ending, const char *name,
                                 pir_report *report);

/* A whole picture of one body, with a legend when its facets are of more than one kind. */
pir_status pir_mesh_write_svg(const pir_mesh *mesh, FILE *file);

/*
 * One body as it lies in the view: what a picture needs to place it. A point v of the mesh is drawn, in units of
 * `radius`, at the projection of (v − centre)/radius, x to the right and y down, as SVG has it; low and high bound that
 * projection.
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

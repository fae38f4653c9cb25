/* SPDX-License-Identifier: MIT */
/*
 * Drawing a cubical Gaussian map, as in Fogel and Halperin's figures: the cube unfolded to a cross around its +z
 * face, each face seen from outside and turned so that neighbours join along their common side.
 *
 *            +y
 *        -x  +z  +x  -z
 *            -y
 */
#include "cgm_picture.h"

#include <inttypes.h>
#include <math.h>

#define SQUARE 190.0 /* the side of a map */
#define MARGIN 18.0
#define HALF   (SQUARE / 2)

/* Where each map stands in the cross, and its directions to the right and up. */
static const struct panel {
    int column, row;
    pir_vec3 right, up;
} panels[6] = {
    {0, 1, {0, 0, 1}, {0, 1, 0}},  {1, 2, {1, 0, 0}, {0, 0, 1}},  {3, 1, {-1, 0, 0}, {0, 1, 0}},
    {2, 1, {0, 0, -1}, {0, 1, 0}}, {1, 0, {1, 0, 0}, {0, 0, -1}}, {1, 1, {1, 0, 0}, {0, 1, 0}},
};

/* The owner of a feature. Each has a colour. */
enum owner { NOBODY, OF_P, OF_Q, OF_OTHER, OF_SEVERAL };
static const char *const colours[] = {"#b8b8b8", "#d22f27", "#2456c8", "#2e8b57", "#8a3ba8"};

static double dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static void project(const pir_cgm *cgm, uint32_t vertex, double ret_xy[2]) {
    pir_cgm_vertex_info v = pir_cgm_vertex_at(cgm, vertex);
    const struct panel *panel = &panels[v.map];
    double depth = fmax(fabs(v.direction.x), fmax(fabs(v.direction.y), fabs(v.direction.z)));
    ret_xy[0] = MARGIN + panel->column * SQUARE + HALF + HALF * dot(v.direction, panel->right) / depth;
    ret_xy[1] = MARGIN + panel->row * SQUARE + HALF - HALF * dot(v.direction, panel->up) / depth;
}

/* One more source that has a feature. */
static enum owner add_owner(enum owner owner, uint32_t source) {
    if (owner != NOBODY)
        return OF_SEVERAL;
    return source == 0 ? OF_P : source == 1 ? OF_Q : OF_OTHER;
}

static enum owner owner_of_half(const pir_cgm *cgm, uint32_t half) {
    enum owner owner = NOBODY;
    for (uint32_t s = 0; s < pir_cgm_source_count(cgm); s++)
        if (pir_cgm_halfedge_edge(cgm, half, s) != PIR_CGM_NONE)
            owner = add_owner(owner, s);
    return owner;
}

static enum owner owner_of_vertex(const pir_cgm *cgm, uint32_t vertex) {
    enum owner owner = NOBODY;
    for (uint32_t s = 0; s < pir_cgm_source_count(cgm); s++)
        if (pir_cgm_vertex_facet(cgm, vertex, s) != PIR_CGM_NONE)
            owner = add_owner(owner, s);
    // where arcs of different sources cross there is a facet of the sum that is nobody's own
    return owner == NOBODY && pir_cgm_vertex_at(cgm, vertex).real ? OF_SEVERAL : owner;
}

static void write_edges(FILE *file, const pir_cgm *cgm, enum owner owner, double width) {
    fprintf(file, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" stroke-linecap=\"round\" d=\"",
            colours[owner], width);
    uint32_t halves = pir_cgm_total_counts(cgm).halfedges;
    for (uint32_t h = 0; h < halves; h += 2) {
        if (owner_of_half(cgm, h) != owner)
            continue;
        pir_cgm_halfedge_info half = pir_cgm_halfedge_at(cgm, h);
        double from[2], to[2];
        project(cgm, half.origin, from);
        project(cgm, half.target, to);
        fprintf(file, "M%.3f %.3fL%.3f %.3f", from[0], from[1], to[0], to[1]);
    }
    fprintf(file, "\"/>\n");
}

static void write_vertices(FILE *file, const pir_cgm *cgm, double radius) {
    uint32_t vertices = pir_cgm_total_counts(cgm).vertices;
    for (uint32_t v = 0; v < vertices; v++) {
        enum owner owner = owner_of_vertex(cgm, v);
        double at[2];
        project(cgm, v, at);
        if (owner != NOBODY)
            fprintf(file, "<circle cx=\"%.3f\" cy=\"%.3f\" r=\"%.2f\" fill=\"%s\"/>\n", at[0], at[1], radius,
                    colours[owner]);
    }
}

void cgm_picture_write(FILE *file, const pir_cgm *cgm) {
    pir_cgm_counts total = pir_cgm_total_counts(cgm);
    double width = 4 * SQUARE + 2 * MARGIN, height = 3 * SQUARE + 2 * MARGIN;
    // the more there is to draw, the finer
    double fine = 1 / (1 + sqrt(total.vertices) / 60);
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\">\n",
            width, height, width, height);
    fprintf(file,
            "<title>Cubical Gaussian map: %" PRIu32 " vertices, %" PRIu32 " halfedges, %" PRIu32 " faces</title>\n",
            total.vertices, total.halfedges, total.faces);
    fprintf(file, "<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n");
    fprintf(file, "<g font-family=\"Helvetica,Arial,sans-serif\" font-size=\"12\" fill=\"#808080\">\n");
    for (uint32_t map = 0; map < 6; map++)
        fprintf(file, "<text x=\"%.2f\" y=\"%.2f\">%s</text>\n", MARGIN + panels[map].column * SQUARE + 6,
                MARGIN + panels[map].row * SQUARE + 16, pir_cgm_map_name(map));
    fprintf(file, "</g>\n");
    write_edges(file, cgm, NOBODY, 0.6);
    for (int owner = OF_P; owner <= OF_SEVERAL; owner++)
        write_edges(file, cgm, (enum owner)owner, 0.5 + 1.2 * fine);
    write_vertices(file, cgm, 0.8 + 2.2 * fine);
    fprintf(file, "</svg>\n");
}

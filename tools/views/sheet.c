/* SPDX-License-Identifier: MIT */
/*
 * Differences of several pairs of pieces overlap one another; what of them is seen hidden.c says. A facet that is cut
 * into several parts is one path, so that no seam shows between them.
 */
#include "sheet.h"

#include <math.h>
#include <stdlib.h>

#include "../message.h"
#include "../model.h"
#include "../text.h"
#include "hidden.h"

/* A view, the space between views, the line under each, the title's line. */
#define VIEW_SIZE  168.0
#define VIEW_SPACE 10.0
#define LABEL      18.0
#define TITLE      34.0

/* One colour per kind of facet, in the order of pir_facet_kind, and the way to the light: right, up, to the viewer. */
static const double colours[4][3] = {{92, 138, 190}, {240, 165, 84}, {98, 179, 162}, {176, 122, 170}};
static const double light[3] = {-0.4, 0.67, 0.625};

/* A view being drawn. */
struct painter {
    FILE *file;
    double scale;
    bool open; /* a path is open, of `facet` or, where none is, of lines */
    bool is_facet;
    uint32_t facet;
};

static void close_path(struct painter *painter) {
    if (painter->open)
        fputs("\"/>\n", painter->file);
    painter->open = false;
}

static unsigned shade(double channel, double lit) {
    double dark = channel * (0.58 + 0.42 * lit), white = 0.22 * lit * lit * lit;
    return (unsigned)lround(dark + (255 - dark) * white);
}

static void open_facet(struct painter *painter, const struct seen_body *body, uint32_t facet) {
    const double *n = body->plane[facet];
    double lit = fmin(1, fmax(0, 0.5 + 0.5 * (n[0] * light[0] + n[1] * light[1] + n[2] * light[2])));
    const double *colour = colours[pir_mesh_facet_kind(body->mesh, facet)];
    close_path(painter);
    fprintf(painter->file, "<path fill=\"#%02x%02x%02x\" d=\"", shade(colour[0], lit), shade(colour[1], lit),
            shade(colour[2], lit));
    painter->open = painter->is_facet = true;
    painter->facet = facet;
}

static void put_polygon(void *context, const struct seen_body *body, uint32_t facet, const struct seen_polygon *part) {
    struct painter *painter = context;
    if (!painter->open || !painter->is_facet || painter->facet != facet)
        open_facet(painter, body, facet);
    for (uint32_t i = 0; i < part->count; i++)
        fprintf(painter->file, "%s%.1f %.1f", i ? "L" : "M", painter->scale * part->at[i][0],
                -painter->scale * part->at[i][1]);
    fputs("Z", painter->file);
}

static void put_line(void *context, const double a[2], const double b[2]) {
    struct painter *painter = context;
    if (!painter->open || painter->is_facet) {
        close_path(painter);
        fputs("<path class=\"e\" d=\"", painter->file);
        painter->open = true;
        painter->is_facet = false;
    }
    fprintf(painter->file, "M%.1f %.1fL%.1f %.1f", painter->scale * a[0], -painter->scale * a[1], painter->scale * b[0],
            -painter->scale * b[1]);
}

/* Draws all differences of one rotation; false after a complaint. */
static bool put_bodies(struct painter *painter, const struct slices *slices, uint64_t shown, pir_vec3 middle) {
    struct seen_body *bodies = calloc(slices->pairs, sizeof *bodies);
    pir_mesh **meshes = calloc(slices->pairs, sizeof *meshes);
    bool done = bodies && meshes, told = false;
    for (uint32_t pair = 0; done && pair < slices->pairs; pair++) {
        meshes[pair] = slices_mesh(slices, shown, pair, PIR_DOUBLE);
        told = !meshes[pair];
        done = meshes[pair] && hidden_see(&bodies[pair], meshes[pair], middle);
    }
    const struct seen_sink sink = {painter, put_polygon, put_line};
    for (uint32_t pair = 0; done && pair < slices->pairs; pair++) {
        done = hidden_parts(bodies, slices->pairs, pair, &sink);
        close_path(painter);
    }
    if (!done && !told)
        complain("%s: out of memory", slices->path);
    for (uint32_t pair = 0; pair < slices->pairs; pair++) {
        if (bodies)
            hidden_clear(&bodies[pair]);
        if (meshes)
            pir_mesh_destroy(meshes[pair]);
    }
    free(bodies);
    free(meshes);
    return done;
}

/* Draws all sections of one rotation. */
static bool put_sections(struct painter *painter, const struct slices *slices, uint64_t shown, pir_vec3 middle,
                         const struct planar *planar) {
    double origin[2];
    planar_flat(planar, middle, origin);
    for (uint32_t pair = 0; pair < slices->pairs; pair++) {
        pir_section *section = planar_section(planar, slices, shown, pair);
        if (!section)
            return false;
        uint32_t count = pir_section_corner_count(section);
        if (count > 0)
            fputs("<path class=\"s\" d=\"", painter->file);
        for (uint32_t i = 0; i < count; i++) {
            double flat[2];
            planar_flat(planar, pir_section_corners(section)[i], flat);
            fprintf(painter->file, "%s%.1f %.1f", i ? "L" : "M", painter->scale * (flat[0] - origin[0]),
                    -painter->scale * (flat[1] - origin[1]));
        }
        if (count > 0)
            fputs("Z\"/>\n", painter->file);
        pir_section_destroy(section);
    }
    return true;
}

/* The angle of a rotation, in degrees. */
static double angle_of(pir_quat q) {
    return 360 / 3.14159265358979323846 * atan2(sqrt(q.x * q.x + q.y * q.y + q.z * q.z), fabs(q.w));
}

static void put_title(FILE *file, const struct slices *slices, const struct planar *planar) {
    fprintf(file, "<text x=\"%g\" y=\"22\" font-size=\"15\">", VIEW_SPACE);
    text_print_xml(file, model_title(slices->path));
    fprintf(file, ": %llu of %llu slices", (unsigned long long)slices->count,
            (unsigned long long)slices->info.grid.count);
    if (planar->given)
        fprintf(file, ", at %c = %.6g", "xyz"[planar->axis], planar -> offset);
    fputs("</text>\n", file);
}

bool sheet_write(FILE *file, const struct slices *slices, const struct planar *planar) {
    double columns = ceil(sqrt((double)slices->count * 4 / 3)), radius;
    double rows = ceil((double)slices->count / columns), step = VIEW_SIZE + VIEW_SPACE;
    double width = columns * step + VIEW_SPACE, height = TITLE + rows * (step + LABEL);
    pir_vec3 middle;
    slices_ball(slices, &middle, &radius);
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" viewBox=\"0 0 %g %g\" "
            "font-family=\"Helvetica,Arial,sans-serif\" fill=\"#24384a\">\n"
            "<style>.e{fill:none;stroke:#24384a;stroke-width:.5;stroke-linecap:round}"
            ".s{fill:#5c8abe;fill-opacity:.35;stroke:#24384a;stroke-width:.8;stroke-linejoin:round}</style>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
            width, height, width, height);
    put_title(file, slices, planar);
    struct painter painter = {.file = file, .scale = VIEW_SIZE / 2 / radius};
    bool done = true;
    for (uint64_t s = 0; done && s < slices->count; s++) {
        double x = VIEW_SPACE + VIEW_SIZE / 2 + step * fmod((double)s, columns);
        double y = TITLE + VIEW_SIZE / 2 + (step + LABEL) * floor((double)s / columns);
        fprintf(file, "<g class=\"view\" transform=\"translate(%g %g)\">\n", x, y);
        done =
            planar->given ? put_sections(&painter, slices, s, middle, planar) : put_bodies(&painter, slices, s, middle);
        fprintf(file, "<text y=\"%g\" text-anchor=\"middle\" font-size=\"11\">%llu: %.1f°</text>\n</g>\n",
                VIEW_SIZE / 2 + 12, (unsigned long long)slices_number(slices, s), angle_of(slices_rotation(slices, s)));
    }
    fputs("</svg>\n", file);
    return done;
}

/* SPDX-License-Identifier: MIT */
/*
 * See clash_picture.h. Solids are drawn by the facets of their convex pieces that face the viewer, at azimuth 35° and
 * elevation 25°, the farther ones first: solids that clash over those that do not, so that nothing hides a clash.
 */
#include "clash_picture.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "file.h"
#include "message.h"

#define SIZE   960.0
#define MARGIN 20.0

static const char *const colours[] = {"#c8ced4", "#c8ced4", "#e0a030", "#d04040", "#8050c0", "#2060d0"};
static const char *const words[] = {"", "no clash", "protrusion", "piercing", "envelope", "duplicate"};

/* To the right, up and towards the viewer. */
static const double view[3][3] = {
    {-0.57357644, 0.81915204, 0}, {-0.34618861, -0.24240388, 0.90630779}, {0.74240388, 0.51983679, 0.42261826}};

/* A facet to be drawn. */
struct drawn {
    double depth, shade;
    pir_clash_kind kind; /* of its solid: the last of what it does */
    uint32_t first, count;
};

struct clash_drawing {
    struct drawn *facet;
    double (*point)[2];
    uint32_t facet_count, facet_room, point_count, point_room;
    double low[2], high[2];
    bool failed;
};

static bool reserve(void **array, uint32_t *room, uint32_t count, size_t size) {
    if (count <= *room)
        return true;
    void *grown = realloc(*array, 2 * (size_t)count * size);
    if (grown) {
        *array = grown;
        *room = 2 * count;
    }
    return grown;
}

static double along(const double axis[3], pir_vec3 x) {
    return axis[0] * x.x + axis[1] * x.y + axis[2] * x.z;
}

/* Adds a facet of a piece, with its corners, if it faces the viewer. */
static void add_facet(struct clash_drawing *d, const pir_polytope *piece, uint32_t number, pir_clash_kind kind) {
    const pir_vec3 n = pir_polytope_normal(piece, number);
    const uint32_t count = pir_polytope_facet_size(piece, number);
    uint32_t *corner = malloc(count * sizeof *corner);
    d->failed = d->failed || !corner ||
                !reserve((void **)&d->facet, &d->facet_room, d->facet_count + 1, sizeof *d->facet) ||
                !reserve((void **)&d->point, &d->point_room, d->point_count + count, sizeof *d->point);
    if (!d->failed && along(view[2], n) > 0) {
        struct drawn facet = {0, 0.55 + 0.45 * fabs(n.z * 0.7 + n.x * 0.6 + n.y * 0.2), kind, d->point_count, count};
        pir_polytope_facet(piece, number, corner);
        for (uint32_t i = 0; i < count; i++) {
            const pir_vec3 x = pir_polytope_vertex(piece, corner[i]);
            facet.depth += along(view[2], x) / count;
            for (int k = 0; k < 2; k++) {
                const double at = along(view[k], x);
                d->point[d->point_count][k] = at;
                d->low[k] = fmin(d->low[k], at);
                d->high[k] = fmax(d->high[k], at);
            }
            d->point_count++;
        }
        d->facet[d->facet_count++] = facet;
    }
    free(corner);
}

static void add_solid(struct clash_drawing *d, const pir_solid *solid, pir_clash_kind kind) {
    pir_decompose_options options = pir_decompose_options_default();
    pir_pieces *pieces = NULL;
    options.method = PIR_DECOMPOSE_FACETS;
    d->failed = d->failed || pir_solid_decompose(solid, &options, NULL, &pieces) != PIR_OK;
    for (uint32_t i = 0; pieces && i < pir_pieces_count(pieces) && !d->failed; i++) {
        pir_polytope *piece = NULL;
        d->failed = pir_pieces_polytope(pieces, i, &piece) != PIR_OK;
        for (uint32_t f = 0; !d->failed && f < pir_polytope_facet_count(piece); f++)
            add_facet(d, piece, f, kind);
        pir_polytope_release(piece);
    }
    pir_pieces_destroy(pieces);
}

/* Solids without a clash first, then the farther ones. */
static int compare_drawn(const void *a, const void *b) {
    const struct drawn *x = a, *y = b;
    const bool clash[2] = {x->kind > PIR_CLASH_TOUCHING, y->kind > PIR_CLASH_TOUCHING};
    if (clash[0] != clash[1])
        return clash[0] ? 1 : -1;
    return (x->depth > y->depth) - (x->depth < y->depth);
}

static void print_facet(FILE *file, const struct clash_drawing *d, const struct drawn *facet, double scale) {
    unsigned rgb = (unsigned)strtoul(colours[facet->kind] + 1, NULL, 16);
    const bool clash = facet->kind > PIR_CLASH_TOUCHING;
    fprintf(file, "<path fill=\"#%02x%02x%02x\" fill-opacity=\"%s\" d=\"", (unsigned)((rgb >> 16) * facet->shade),
            (unsigned)((rgb >> 8 & 255) * facet->shade), (unsigned)((rgb & 255) * facet->shade),
            clash ? "0.9" : "0.25");
    for (uint32_t i = 0; i < facet->count; i++) {
        const double *at = d->point[facet->first + i];
        fprintf(file, "%c%.2f %.2f", i ? 'L' : 'M', MARGIN + scale * (at[0] - d->low[0]),
                MARGIN + scale * (d->high[1] - at[1]));
    }
    fputs("Z\"/>\n", file);
}

static void print_legend(FILE *file) {
    for (int kind = PIR_CLASH_TOUCHING; kind <= PIR_CLASH_DUPLICATE; kind++)
        fprintf(file,
                "<rect x=\"%g\" y=\"%d\" width=\"14\" height=\"14\" stroke=\"#444\" fill=\"%s\"/>"
                "<text x=\"%g\" y=\"%d\">%s</text>\n",
                MARGIN, 20 * kind, colours[kind], MARGIN + 20, 20 * kind + 12, words[kind]);
}

static void print_picture(FILE *file, struct clash_drawing *d) {
    const double wide = d->high[0] - d->low[0], tall = d->high[1] - d->low[1];
    const double scale = SIZE / fmax(fmax(wide, tall), 1e-300);
    if (d->facet_count > 0)
        qsort(d->facet, d->facet_count, sizeof *d->facet, compare_drawn);
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" font-family=\"sans-serif\" "
            "font-size=\"14\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n"
            "<g stroke=\"#405060\" stroke-width=\"0.5\" stroke-linejoin=\"round\">\n",
            scale * wide + 2 * MARGIN, scale * tall + 2 * MARGIN);
    for (uint32_t i = 0; i < d->facet_count; i++)
        print_facet(file, d, &d->facet[i], scale);
    fputs("</g>\n", file);
    print_legend(file);
    fputs("</svg>\n", file);
}

bool clash_picture_write(const char *path, const struct clash_body *bodies, size_t count,
                         const struct clash_found *found, size_t found_count) {
    struct clash_drawing d = {.low = {HUGE_VAL, HUGE_VAL}, .high = {-HUGE_VAL, -HUGE_VAL}};
    struct output_file file = {0};
    bool good = output_open(&file, path);
    for (size_t i = 0; i < count && good; i++) {
        pir_clash_kind kind = PIR_CLASH_TOUCHING;
        for (size_t k = 0; k < found_count; k++)
            if ((found[k].pair.a == i || found[k].pair.b == i) && found[k].verdict.kind > kind)
                kind = found[k].verdict.kind;
        add_solid(&d, bodies[i].solid, kind);
    }
    if (d.failed)
        complain("clash: %s: out of memory", path);
    good = good && !d.failed;
    if (good && d.facet_count > 0)
        print_picture(file.stream, &d);
    good = good && output_commit(&file);
    output_discard(&file);
    free(d.facet);
    free(d.point);
    return good;
}

/* SPDX-License-Identifier: MIT */
/*
 * See solid_picture.h. Coordinates are taken relative to the middle of all bounds and to the largest of them, so that
 * nothing overflows. Facets that face away are left out; a facet without area, or seen from its edge, shows nothing.
 */
#include "pixels/solid_picture.h"

#include <math.h>
#include <stdlib.h>

#include "message.h"
#include "pixels/png_file.h"

/* The longer side of what is drawn and the space about it, in pixels. */
#define SIZE   640.0
#define MARGIN 24.0

/* To the right, up and towards the viewer, at azimuth 35° and elevation 25°; and the way to the light there. */
static const double view[3][3] = {
    {-0.57357644, 0.81915204, 0}, {-0.34618861, -0.24240388, 0.90630779}, {0.74240388, 0.51983679, 0.42261826}};
static const double light[3] = {-0.4, 0.67, 0.625};

static const struct pixel_colour line_colour = {0x24, 0x38, 0x4a}, solid_colour = {176, 122, 170};

struct scene {
    pir_vec3 middle;
    double radius;          /* 1 for a point */
    double low[2], high[2]; /* of the picture, before it is scaled */
    double scale, left, top;
    struct pixels pixels;
    float (*at)[3]; /* scratch: the corners of a facet */
    double *crossings;
    size_t room;
};

/* --- where things are --- */

static void see(const struct scene *scene, pir_vec3 x, double ret_seen[3]) {
    const double at[3] = {(x.x - scene->middle.x) / scene->radius, (x.y - scene->middle.y) / scene->radius,
                          (x.z - scene->middle.z) / scene->radius};
    for (int k = 0; k < 3; k++)
        ret_seen[k] = view[k][0] * at[0] + view[k][1] * at[1] + view[k][2] * at[2];
}

static void place(const struct scene *scene, pir_vec3 x, float ret_at[3]) {
    double seen[3];
    see(scene, x, seen);
    ret_at[0] = (float)(scene->left + scene->scale * seen[0]);
    ret_at[1] = (float)(scene->top - scene->scale * seen[1]);
    ret_at[2] = (float)(scene->scale * seen[2]);
}

static void find_middle(struct scene *scene, pir_mesh *const *meshes, uint32_t count) {
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (uint32_t m = 0; m < count; m++)
        for (uint32_t v = 0; v < pir_mesh_vertex_count(meshes[m]); v++) {
            const pir_vec3 x = pir_mesh_vertices(meshes[m])[v];
            const double at[3] = {x.x, x.y, x.z};
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], at[k]);
                high[k] = fmax(high[k], at[k]);
            }
        }
    scene->middle = (pir_vec3){low[0] / 2 + high[0] / 2, low[1] / 2 + high[1] / 2, low[2] / 2 + high[2] / 2};
    scene->radius = fmax(high[0] / 2 - low[0] / 2, fmax(high[1] / 2 - low[1] / 2, high[2] / 2 - low[2] / 2));
    scene->radius = scene->radius > 0 ? scene->radius : 1;
}

/* Scales what is seen to the size of the picture. False when out of memory. */
static bool frame(struct scene *scene, pir_mesh *const *meshes, uint32_t count) {
    for (int k = 0; k < 2; k++)
        scene->low[k] = HUGE_VAL, scene->high[k] = -HUGE_VAL;
    for (uint32_t m = 0; m < count; m++)
        for (uint32_t v = 0; v < pir_mesh_vertex_count(meshes[m]); v++) {
            double seen[3];
            see(scene, pir_mesh_vertices(meshes[m])[v], seen);
            for (int k = 0; k < 2; k++) {
                scene->low[k] = fmin(scene->low[k], seen[k]);
                scene->high[k] = fmax(scene->high[k], seen[k]);
            }
        }
    const double wide = scene->high[0] - scene->low[0], tall = scene->high[1] - scene->low[1];
    scene->scale = SIZE / fmax(fmax(wide, tall), 1e-9);
    scene->left = MARGIN - scene->scale * scene->low[0];
    scene->top = MARGIN + scene->scale * scene->high[1];
    return pixels_make(&scene->pixels, (size_t)ceil(scene->scale * wide + 2 * MARGIN),
                       (size_t)ceil(scene->scale * tall + 2 * MARGIN));
}

/* --- facets --- */

/* The corners of a facet in the picture and its normal of unit length, in the frame of the view. */
static bool lay(struct scene *scene, const pir_mesh *mesh, const uint32_t *corners, uint32_t count, double normal[3]) {
    if (count > scene->room) {
        scene->room = 2 * (size_t)count;
        free(scene->at);
        free(scene->crossings);
        scene->at = malloc(scene->room * sizeof *scene->at);
        scene->crossings = malloc(scene->room * sizeof *scene->crossings);
    }
    if (!scene->at || !scene->crossings)
        return false;
    double first[3], last[3] = {0, 0, 0}, next[3];
    see(scene, pir_mesh_vertices(mesh)[corners[0]], first);
    normal[0] = normal[1] = normal[2] = 0;
    for (uint32_t i = 0; i < count; i++) {
        const pir_vec3 x = pir_mesh_vertices(mesh)[corners[i]];
        place(scene, x, scene->at[i]);
        see(scene, x, next);
        for (int k = 0; k < 3; k++)
            next[k] -= first[k];
        for (int k = 0; k < 3; k++)
            normal[k] += last[(k + 1) % 3] * next[(k + 2) % 3] - last[(k + 2) % 3] * next[(k + 1) % 3];
        for (int k = 0; k < 3; k++)
            last[k] = next[k];
    }
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int k = 0; k < 3; k++)
        normal[k] = length > 0 ? normal[k] / length : 0;
    return true;
}

static uint8_t shade(uint8_t channel, double lit) {
    const double dark = channel * (0.58 + 0.42 * lit), white = 0.22 * lit * lit * lit;
    return (uint8_t)lround(dark + (255 - dark) * white);
}

static struct pixel_colour shaded(struct pixel_colour colour, const double normal[3]) {
    const double dot = normal[0] * light[0] + normal[1] * light[1] + normal[2] * light[2];
    const double lit = fmin(1, fmax(0, 0.5 + 0.5 * dot));
    return (struct pixel_colour){shade(colour.red, lit), shade(colour.green, lit), shade(colour.blue, lit)};
}

/* Whether the loop has the side from a to b as well. */
static bool has_side(const uint32_t *corners, uint32_t count, uint32_t a, uint32_t b) {
    for (uint32_t i = 0; i < count; i++)
        if (corners[i] == a && corners[i + 1 < count ? i + 1 : 0] == b)
            return true;
    return false;
}

/* Draws a facet that faces the viewer, or the sides of one but for slits, which are walked both ways. */
static bool draw_facet(struct scene *scene, const pir_mesh *mesh, uint32_t facet, struct pixel_colour colour,
                       bool sides) {
    uint32_t count;
    const uint32_t *corners = pir_mesh_facet(mesh, facet, &count);
    double n[3];
    if (!lay(scene, mesh, corners, count, n))
        return false;
    if (!(n[2] > 1e-3))
        return true;
    // the picture's y goes down
    const double x = -n[0] / n[2], y = n[1] / n[2];
    if (!sides) {
        const float *at = scene->at[0];
        const double plane[3] = {x, y, (double)at[2] - x * (double)at[0] - y * (double)at[1]};
        pixels_fill(&scene->pixels, (const float(*)[3])scene->at, count, plane, shaded(colour, n), scene->crossings);
        return true;
    }
    const float before = (float)fmin(0.5 + 0.5 * (fabs(x) + fabs(y)), 0.01 * SIZE);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t j = i + 1 < count ? i + 1 : 0;
        if (!has_side(corners, count, corners[j], corners[i]))
            pixels_line(&scene->pixels, scene->at[i], scene->at[j], before, 2, line_colour);
    }
    return true;
}

/* --- all of it --- */

/* A colour of its own for each of several, all as bright. */
static struct pixel_colour colour_of(uint32_t number, uint32_t count) {
    const double hue = 2.399963 * number;
    if (count == 1)
        return solid_colour;
    return (struct pixel_colour){(uint8_t)lround(165 + 60 * cos(hue)), (uint8_t)lround(165 + 60 * cos(hue + 2.1)),
                                 (uint8_t)lround(165 + 60 * cos(hue + 4.2))};
}

/* The segments and points that an open sum leaves on their own. */
static void draw_thin(struct scene *scene, const pir_mesh *mesh) {
    uint32_t segments, points;
    const uint32_t *ends = pir_mesh_segments(mesh, &segments), *alone = pir_mesh_points(mesh, &points);
    float a[3], b[3];
    for (uint32_t i = 0; i < segments; i++) {
        place(scene, pir_mesh_vertices(mesh)[ends[2 * i]], a);
        place(scene, pir_mesh_vertices(mesh)[ends[2 * i + 1]], b);
        pixels_line(&scene->pixels, a, b, 0.5f, 5, line_colour);
    }
    for (uint32_t i = 0; i < points; i++) {
        place(scene, pir_mesh_vertices(mesh)[alone[i]], a);
        pixels_line(&scene->pixels, a, a, 0.5f, 12, line_colour);
    }
}

static bool draw(struct scene *scene, pir_mesh *const *meshes, uint32_t count) {
    for (int sides = 0; sides < 2; sides++)
        for (uint32_t m = 0; m < count; m++)
            for (uint32_t f = 0; f < pir_mesh_facet_count(meshes[m]); f++)
                if (!draw_facet(scene, meshes[m], f, colour_of(m, count), sides))
                    return false;
    for (uint32_t m = 0; m < count; m++)
        draw_thin(scene, meshes[m]);
    return true;
}

bool solid_picture_write(struct output_file *file, pir_mesh *const *meshes, uint32_t count) {
    struct scene scene = {0};
    find_middle(&scene, meshes, count);
    const bool good =
        frame(&scene, meshes, count) && draw(&scene, meshes, count) && png_write(&scene.pixels, file->stream);
    pixels_clear(&scene.pixels);
    free(scene.at);
    free(scene.crossings);
    if (!good && !output_failed(file))
        complain("%s: out of memory for the picture", file->path);
    return good && output_commit(file);
}

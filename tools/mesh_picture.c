/* SPDX-License-Identifier: MIT */
/*
 * Orthographic, seen so that the segment between the two points has its full length: it lies in the plane of the
 * picture, from left to right. Triangles are drawn as they stand in the file, the two that the points are of strong.
 */
#include "mesh_picture.h"

#include <math.h>
#include <stdio.h>

#include "file.h"

#define SIZE   640.0
#define MARGIN 40.0

/* Directions in the world to the right and up, and what of them is in the picture. */
struct view {
    pir_vec3 right, up;
    double low[2], high[2], scale;
};

static double dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static pir_vec3 unit(pir_vec3 v) {
    double by = 1 / sqrt(dot(v, v));
    return (pir_vec3){v.x * by, v.y * by, v.z * by};
}

static struct view view_along(pir_vec3 from, pir_vec3 to) {
    pir_vec3 way = {to.x - from.x, to.y - from.y, to.z - from.z};
    struct view view = {{1, 0, 0}, {0, 0, 1}, {HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}, 1};
    if (dot(way, way) > 0)
        view.right = unit(way);
    // up is what the axis that is least along it leaves
    pir_vec3 r = view.right, axis = {0, 0, 1};
    if (fabs(r.z) > fabs(r.x) || fabs(r.z) > fabs(r.y))
        axis = fabs(r.x) < fabs(r.y) ? (pir_vec3){1, 0, 0} : (pir_vec3){0, 1, 0};
    double along = dot(axis, r);
    view.up = unit((pir_vec3){axis.x - along * r.x, axis.y - along * r.y, axis.z - along * r.z});
    return view;
}

static void include(struct view *view, pir_vec3 point) {
    const double at[2] = {dot(view->right, point), dot(view->up, point)};
    for (int k = 0; k < 2; k++) {
        view->low[k] = fmin(view->low[k], at[k]);
        view->high[k] = fmax(view->high[k], at[k]);
    }
}

static void fit(struct view *view) {
    double extent = fmax(view->high[0] - view->low[0], view->high[1] - view->low[1]);
    view->scale = extent > 0 ? (SIZE - 2 * MARGIN) / extent : 1;
}

static double across(const struct view *view, pir_vec3 point) {
    return SIZE / 2 + (dot(view->right, point) - 0.5 * (view->low[0] + view->high[0])) * view->scale;
}

static double down(const struct view *view, pir_vec3 point) {
    return SIZE / 2 - (dot(view->up, point) - 0.5 * (view->low[1] + view->high[1])) * view->scale;
}

static void put_triangle(FILE *file, const struct view *view, const pir_triangle_corners *c, pir_pose pose) {
    fprintf(file, "<path d=\"M");
    for (int k = 0; k < 3; k++) {
        pir_vec3 at = pir_pose_apply(pose, c->corner[k]);
        fprintf(file, "%s%.2f %.2f", k > 0 ? "L" : "", across(view, at), down(view, at));
    }
    fprintf(file, "Z\"/>\n");
}

static void put_mesh(FILE *file, const struct view *view, const pir_trimesh *mesh, pir_pose pose, uint32_t strong,
                     const char *colour) {
    pir_triangle_corners corners;
    fprintf(file, "<g stroke=\"%s\" stroke-width=\"0.6\" opacity=\"0.6\" fill=\"none\">\n", colour);
    for (uint32_t t = 0; pir_trimesh_triangle(mesh, t, &corners) == PIR_OK; t++)
        put_triangle(file, view, &corners, pose);
    fprintf(file, "</g>\n<g stroke=\"%s\" stroke-width=\"1.6\" fill=\"%s\" fill-opacity=\"0.4\">\n", colour, colour);
    if (pir_trimesh_triangle(mesh, strong, &corners) == PIR_OK)
        put_triangle(file, view, &corners, pose);
    fprintf(file, "</g>\n");
}

static void put_answer(FILE *file, const struct view *view, const pir_trimesh_distance *answer, const char *word) {
    const pir_vec3 ends[2] = {answer->point_p, answer->point_q};
    fprintf(file, "<g stroke=\"#c0392b\" stroke-width=\"2.5\" fill=\"#c0392b\">\n");
    fprintf(file, "<path d=\"M%.2f %.2fL%.2f %.2f\"/>\n", across(view, ends[0]), down(view, ends[0]),
            across(view, ends[1]), down(view, ends[1]));
    for (int k = 0; k < 2; k++)
        fprintf(file, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"4\"/>\n", across(view, ends[k]), down(view, ends[k]));
    fprintf(file,
            "</g>\n<text x=\"%g\" y=\"%g\" font-family=\"sans-serif\" font-size=\"16\" fill=\"#c0392b\">%s "
            "%.6g</text>\n",
            MARGIN, MARGIN - 14, word, answer->distance);
}

bool mesh_picture_write(const char *path, pir_trimesh *const mesh[2], const pir_pose pose[2],
                        const pir_trimesh_distance *answer, const char *word) {
    struct view view = view_along(answer->point_q, answer->point_p);
    for (int i = 0; i < 2; i++) {
        pir_triangle_corners corners;
        for (uint32_t t = 0; pir_trimesh_triangle(mesh[i], t, &corners) == PIR_OK; t++)
            for (int k = 0; k < 3; k++)
                include(&view, pir_pose_apply(pose[i], corners.corner[k]));
    }
    fit(&view);
    struct output_file file = {0};
    bool done = output_open(&file, path);
    if (done) {
        fprintf(file.stream,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" viewBox=\"0 0 %g %g\">\n"
                "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n<g stroke-linejoin=\"round\">\n",
                SIZE, SIZE, SIZE, SIZE);
        put_mesh(file.stream, &view, mesh[1], pose[1], answer->triangle_q, "#2c5f8a");
        put_mesh(file.stream, &view, mesh[0], pose[0], answer->triangle_p, "#3a8a4d");
        put_answer(file.stream, &view, answer, word);
        fprintf(file.stream, "</g>\n</svg>\n");
        done = output_commit(&file);
    }
    output_discard(&file);
    return done;
}

/* SPDX-License-Identifier: MIT */
/*
 * Orthographic, seen along the direction that shows the answer's segment at full length: its normal lies in the plane
 * of the picture. Edges in front of either body's middle are drawn strong, the others faint.
 */
#include "query_picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "file.h"
#include "message.h"

#define SIZE   640.0
#define MARGIN 40.0

/* Picture coordinates: right, up, towards the eye. */
struct view {
    double axis[3][3];
    double middle[2], scale;
};

static void rotate(pir_quat q, pir_vec3 v, double r[3]) {
    double n = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, s = 2 / n;
    double cx = q.y * v.z - q.z * v.y, cy = q.z * v.x - q.x * v.z, cz = q.x * v.y - q.y * v.x;
    r[0] = v.x + s * (q.w * cx + q.y * cz - q.z * cy);
    r[1] = v.y + s * (q.w * cy + q.z * cx - q.x * cz);
    r[2] = v.z + s * (q.w * cz + q.x * cy - q.y * cx);
}

static void project(const struct view *view, const double v[3], double to[3]) {
    for (int k = 0; k < 3; k++)
        to[k] = view->axis[k][0] * v[0] + view->axis[k][1] * v[1] + view->axis[k][2] * v[2];
}

/* Right is the answer's normal; up is what is left of the axis least along it. */
static void turn_view(struct view *view, pir_vec3 normal) {
    const double n[3] = {normal.x, normal.y, normal.z};
    bool any = n[0] != 0 || n[1] != 0 || n[2] != 0;
    int least = 0;
    for (int k = 0; k < 3; k++) {
        view->axis[0][k] = any ? n[k] : k == 0;
        if (fabs(view->axis[0][k]) < fabs(view->axis[0][least]))
            least = k;
    }
    double up[3] = {0, 0, 0}, length = 0;
    for (int k = 0; k < 3; k++)
        up[k] = (k == least) - view->axis[0][least] * view->axis[0][k];
    for (int k = 0; k < 3; k++)
        length += up[k] * up[k];
    for (int k = 0; k < 3; k++)
        view->axis[1][k] = up[k] / sqrt(length);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        view->axis[2][k] = view->axis[0][i] * view->axis[1][j] - view->axis[0][j] * view->axis[1][i];
    }
}

/* The vertices of a body in picture coordinates. */
static double (*project_body(const struct view *view, const pir_polytope *body, const pir_quat *rotation,
                             pir_vec3 at))[3] {
    uint32_t count = pir_polytope_vertex_count(body);
    double(*points)[3] = calloc(count, sizeof *points);
    for (uint32_t v = 0; points && v < count; v++) {
        pir_vec3 c = pir_polytope_vertex(body, v);
        double world[3] = {c.x, c.y, c.z};
        if (rotation)
            rotate(*rotation, c, world);
        world[0] += at.x;
        world[1] += at.y;
        world[2] += at.z;
        project(view, world, points[v]);
    }
    return points;
}

static void include(const double (*points)[3], uint32_t count, double low[2], double high[2]) {
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], points[i][k]);
            high[k] = fmax(high[k], points[i][k]);
        }
}

static void put_line(FILE *file, const struct view *view, const double a[3], const double b[3]) {
    fprintf(file, "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\"/>\n",
            SIZE / 2 + (a[0] - view->middle[0]) * view->scale, SIZE / 2 - (a[1] - view->middle[1]) * view->scale,
            SIZE / 2 + (b[0] - view->middle[0]) * view->scale, SIZE / 2 - (b[1] - view->middle[1]) * view->scale);
}

static void put_body(FILE *file, const struct view *view, const pir_polytope *body, const double (*points)[3],
                     const char *colour) {
    double middle = 0;
    uint32_t count = pir_polytope_vertex_count(body);
    for (uint32_t v = 0; v < count; v++)
        middle += points[v][2] / count;
    for (int front = 0; front < 2; front++) {
        fprintf(file, "<g stroke=\"%s\" stroke-width=\"%s\" opacity=\"%s\">\n", colour, front ? "1.6" : "1",
                front ? "1" : "0.3");
        for (uint32_t e = 0; e < pir_polytope_edge_count(body); e++) {
            uint32_t ends[2];
            pir_polytope_edge(body, e, ends);
            if ((points[ends[0]][2] + points[ends[1]][2] > 2 * middle) == front)
                put_line(file, view, points[ends[0]], points[ends[1]]);
        }
        fprintf(file, "</g>\n");
    }
}

static void put_answer(FILE *file, const struct view *view, const pir_query_result *answer) {
    static const char *const words[] = {"distance", "touching", "depth"};
    const double p[3] = {answer->point_p.x, answer->point_p.y, answer->point_p.z};
    const double q[3] = {answer->point_q.x, answer->point_q.y, answer->point_q.z};
    double ends[2][3];
    project(view, p, ends[0]);
    project(view, q, ends[1]);
    fprintf(file, "<g stroke=\"#c0392b\" stroke-width=\"2.5\" fill=\"#c0392b\">\n");
    put_line(file, view, ends[0], ends[1]);
    for (int k = 0; k < 2; k++)
        fprintf(file, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"4\"/>\n",
                SIZE / 2 + (ends[k][0] - view->middle[0]) * view->scale,
                SIZE / 2 - (ends[k][1] - view->middle[1]) * view->scale);
    fprintf(
        file,
        "</g>\n<text x=\"%g\" y=\"%g\" font-family=\"sans-serif\" font-size=\"16\" fill=\"#c0392b\">%s %.6g</text>\n",
        MARGIN, MARGIN - 14, words[answer->state], fabs(answer->distance));
}

bool query_picture_write(const char *path, const pir_polytope *p, const pir_polytope *q, pir_quat rotation,
                         pir_vec3 translation, const pir_query_result *answer) {
    struct view view = {0};
    struct output_file file = {0};
    turn_view(&view, answer->normal);
    double(*of_p)[3] = project_body(&view, p, &rotation, translation),
    (*of_q)[3] = project_body(&view, q, NULL, (pir_vec3){0, 0, 0});
    bool done = of_p && of_q;
    if (!done)
        complain("%s: out of memory", path);
    done = done && output_open(&file, path);
    if (done) {
        double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
        include((const double(*)[3])of_p, pir_polytope_vertex_count(p), low, high);
        include((const double(*)[3])of_q, pir_polytope_vertex_count(q), low, high);
        double extent = fmax(high[0] - low[0], high[1] - low[1]);
        view.scale = extent > 0 ? (SIZE - 2 * MARGIN) / extent : 1;
        for (int k = 0; k < 2; k++)
            view.middle[k] = 0.5 * (low[k] + high[k]);
        fprintf(file.stream,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" viewBox=\"0 0 %g %g\">\n<rect "
                "width=\"100%%\" "
                "height=\"100%%\" fill=\"white\"/>\n<g stroke-linecap=\"round\">\n",
                SIZE, SIZE, SIZE, SIZE);
        put_body(file.stream, &view, q, (const double(*)[3])of_q, "#2c5f8a");
        put_body(file.stream, &view, p, (const double(*)[3])of_p, "#3a8a4d");
        put_answer(file.stream, &view, answer);
        fprintf(file.stream, "</g>\n</svg>\n");
        done = output_commit(&file);
    }
    output_discard(&file);
    free(of_p);
    free(of_q);
    return done;
}

/* SPDX-License-Identifier: MIT */
/*
 * See shared_middle.h. x = b + a' for a point b of Q's face and a' of that of A'. So b is in the one and in the other
 * reflected through x/2: two convex sets of one plane, of which the middle of what they share is taken, corner by
 * corner. These are numbers and decide nothing: what is within 2^-42 of a face's plane counts to it.
 */
#include "solid/depth/shared_middle.h"

#include <math.h>

/* More corners than this of a face are left out. */
#define CORNERS 64

struct touching_face {
    uint32_t count;
    double at[2 * CORNERS][2]; /* clipping may add as many as the other face has sides */
};

/* The plane's axes, and where coordinates in it begin. */
struct chart {
    double u[3], v[3], origin[3];
};

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static struct chart chart_of(const double n[3], const double origin[3]) {
    struct chart c;
    const int k = fabs(n[0]) <= fabs(n[1]) && fabs(n[0]) <= fabs(n[2]) ? 0 : fabs(n[1]) <= fabs(n[2]) ? 1 : 2;
    const double along = n[k], length = sqrt(1 - along * along);
    for (int i = 0; i < 3; i++) {
        c.u[i] = ((i == k) - along * n[i]) / length;
        c.origin[i] = origin[i];
    }
    for (int i = 0; i < 3; i++)
        c.v[i] = n[(i + 1) % 3] * c.u[(i + 2) % 3] - n[(i + 2) % 3] * c.u[(i + 1) % 3];
    return c;
}

static double turn_of(const double a[2], const double b[2], const double c[2]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Orders corners round their convex hull, from the leftmost one (Jarvis 1973). */
static void order(struct touching_face *face) {
    uint32_t first = 0, done = 1;
    for (uint32_t i = 1; i < face->count; i++)
        if (face->at[i][0] < face->at[first][0] ||
            (face->at[i][0] == face->at[first][0] && face->at[i][1] < face->at[first][1]))
            first = i;
    for (uint32_t at = first, to = 0; done <= face->count; to++) {
        const double kept[2] = {face->at[to][0], face->at[to][1]};
        for (int k = 0; k < 2; k++) {
            face->at[to][k] = face->at[at][k];
            face->at[at][k] = kept[k];
        }
        if (done++ == face->count)
            break;
        at = to + 1;
        for (uint32_t i = to + 2; i < face->count; i++)
            if (turn_of(face->at[to], face->at[at], face->at[i]) < 0)
                at = i;
    }
}

/* The vertices of a piece that are highest along ±n, seen in the plane: as they are, or reflected. */
static struct touching_face face_of(const pir_framed_body *body, uint32_t i, const double n[3],
                                    const struct chart *chart, const double *x) {
    struct touching_face face = {0};
    double most = -HUGE_VAL;
    for (uint32_t v = body->of->vertex_start[i]; v < body->of->vertex_start[i + 1]; v++)
        most = fmax(most, dot(n, body->vertex[v]));
    for (uint32_t v = body->of->vertex_start[i]; v < body->of->vertex_start[i + 1] && face.count < CORNERS; v++) {
        if (dot(n, body->vertex[v]) < most - 0x1p-42)
            continue;
        double to[3];
        for (int k = 0; k < 3; k++)
            to[k] = (x ? x[k] - body->vertex[v][k] : body->vertex[v][k]) - chart->origin[k];
        face.at[face.count][0] = dot(chart->u, to);
        face.at[face.count++][1] = dot(chart->v, to);
    }
    if (face.count > 2)
        order(&face);
    return face;
}

/* Cuts a face by the line from a to b: what is left of it stays, and a little more. */
static void cut(struct touching_face *face, const double a[2], const double b[2]) {
    struct touching_face rest = {0};
    const double length = hypot(b[0] - a[0], b[1] - a[1]);
    double side[2 * CORNERS];
    for (uint32_t i = 0; i < face->count; i++)
        side[i] = turn_of(a, b, face->at[i]) / length + 0x1p-48;
    for (uint32_t i = 0; i < face->count && rest.count + 2 <= 2 * CORNERS; i++) {
        const uint32_t j = i + 1 < face->count ? i + 1 : 0;
        if (side[i] >= 0) {
            rest.at[rest.count][0] = face->at[i][0];
            rest.at[rest.count++][1] = face->at[i][1];
        }
        if (side[i] * side[j] < 0 && (face->count > 2 || i == 0)) {
            const double s = side[i] / (side[i] - side[j]);
            for (int k = 0; k < 2; k++)
                rest.at[rest.count][k] = face->at[i][k] + s * (face->at[j][k] - face->at[i][k]);
            rest.count++;
        }
    }
    if (rest.count > 0)
        *face = rest;
}

/* Cuts a segment where the line of another crosses it, or by its ends where they are parallel. */
static void cross(struct touching_face *face, const struct touching_face *other) {
    const double side[2] = {turn_of(other->at[0], other->at[1], face->at[0]),
                            turn_of(other->at[0], other->at[1], face->at[1])};
    const double way[2] = {other->at[1][0] - other->at[0][0], other->at[1][1] - other->at[0][1]};
    if (fabs(side[0] - side[1]) > 0x1p-40 * hypot(way[0], way[1])) {
        const double s = fmin(1, fmax(0, side[0] / (side[0] - side[1])));
        for (int k = 0; k < 2; k++)
            face->at[0][k] += s * (face->at[1][k] - face->at[0][k]);
        face->count = 1;
        return;
    }
    for (int end = 0; end < 2; end++) {
        const double sign = end ? 1 : -1, *at = other->at[end];
        const double to[2] = {at[0] - sign * way[1], at[1] + sign * way[0]};
        cut(face, end ? at : at, to);
    }
}

static void middle_of(const struct touching_face *face, double ret[2]) {
    ret[0] = ret[1] = 0;
    for (uint32_t i = 0; i < face->count; i++)
        for (int k = 0; k < 2; k++)
            ret[k] += face->at[i][k] / face->count;
}

void pir_obstacle_shared_middle(const pir_obstacle *obstacle, uint32_t plane, const double x[3], double ret_point[3]) {
    const pir_obstacle_plane *f = &obstacle->plane[plane];
    const pir_framed_body *p = &obstacle->frame.body[0], *q = &obstacle->frame.body[1];
    const uint32_t i = f->pair / q->of->count, j = f->pair % q->of->count;
    uint32_t highest = q->of->vertex_start[j];
    for (uint32_t v = highest; v < q->of->vertex_start[j + 1]; v++)
        highest = dot(f->n, q->vertex[v]) > dot(f->n, q->vertex[highest]) ? v : highest;
    const struct chart chart = chart_of(f->n, q->vertex[highest]);
    struct touching_face own = face_of(q, j, f->n, &chart, NULL), other = face_of(p, i, f->n, &chart, x);
    if (own.count > 1 && other.count == 1) {
        own = other;
    } else if (own.count == 2 && other.count == 2) {
        cross(&own, &other);
    } else if (own.count > 1) {
        struct touching_face *cut_by = other.count > 2 ? &other : &own, *rest = other.count > 2 ? &own : &other;
        for (uint32_t k = 0; k < cut_by->count; k++)
            cut(rest, cut_by->at[k], cut_by->at[k + 1 < cut_by->count ? k + 1 : 0]);
        own = *rest;
    }
    double at[2];
    middle_of(&own, at);
    for (int k = 0; k < 3; k++)
        ret_point[k] = chart.origin[k] + at[0] * chart.u[k] + at[1] * chart.v[k];
}

/* SPDX-License-Identifier: MIT */
/*
 * A convex body hides itself and all behind it: the half-spaces of the facets that face the viewer, and one
 * through each edge between such a facet and one that does not, along the line of sight. In the plane of a facet of
 * another body these are half-planes, so what is hidden of the facet is a convex polygon. Cutting along one half-plane
 * after another leaves the visible rest in convex parts.
 *
 * Where facets of two bodies are in one plane, the one of the lesser number is drawn: what a body hides of one with a
 * greater number is a little more than it should be, of one with a lesser number a little less.
 *
 * A facet with more than SEEN_CORNERS / 2 corners is drawn in fans of so many.
 */
#include "hidden.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The view by rows: what right, up and towards the viewer are, at azimuth 35° from x to y and elevation 25°. */
static const double view[3][3] = {{-0.57357643635104609, 0.81915204428899178, 0},
                                  {-0.34618861305875415, -0.24240387650610400, 0.90630778703664996},
                                  {0.74240387650610400, 0.51983679072568466, 0.42261826174069944}};

/* How much more or less, in shares of a body's extent. */
#define OVERLAP 1e-7

/* A visible part shorter or thinner than this share of the picture is left out. */
#define SLIVER 1e-9

/* --- one body --- */

static void see_vertices(struct seen_body *body, pir_vec3 middle) {
    const pir_vec3 *vertices = pir_mesh_vertices(body->mesh);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(body->mesh); v++) {
        const double d[3] = {vertices[v].x - middle.x, vertices[v].y - middle.y, vertices[v].z - middle.z};
        for (int k = 0; k < 3; k++)
            body->at[v][k] = view[k][0] * d[0] + view[k][1] * d[1] + view[k][2] * d[2];
        for (int k = 0; k < 2; k++) {
            body->low[k] = v ? fmin(body->low[k], body->at[v][k]) : body->at[v][k];
            body->high[k] = v ? fmax(body->high[k], body->at[v][k]) : body->at[v][k];
        }
    }
}

/* The plane of a facet, by Newell's sum about its first corner. */
static void see_facet(struct seen_body *body, uint32_t facet) {
    uint32_t count;
    const uint32_t *corner = pir_mesh_facet(body->mesh, facet, &count);
    const double *origin = body->at[corner[0]];
    double n[3] = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < count; i++)
        for (int k = 0; k < 3; k++) {
            int a = (k + 1) % 3, b = (k + 2) % 3;
            const double *x = body->at[corner[i]], *y = body->at[corner[i + 1]];
            n[k] += (x[a] - origin[a]) * (y[b] - origin[b]) - (x[b] - origin[b]) * (y[a] - origin[a]);
        }
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++)
        body->plane[facet][k] = length > 0 ? n[k] / length : 0;
    const double *p = body->plane[facet];
    body->plane[facet][3] = p[0] * origin[0] + p[1] * origin[1] + p[2] * origin[2];
    body->front[facet] = p[2] > SLIVER;
}

static int compare_rims(const void *a, const void *b) {
    const struct rim *x = a, *y = b;
    return x->from != y->from ? (x->from > y->from) - (x->from < y->from) : (x->to > y->to) - (x->to < y->to);
}

static void find_rims(struct seen_body *body) {
    for (uint32_t f = 0; f < pir_mesh_facet_count(body->mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(body->mesh, f, &count);
        for (uint32_t i = 0; body->front[f] && i < count; i++)
            body->rim[body->rims++] = (struct rim){corner[i], corner[i + 1 < count ? i + 1 : 0]};
    }
    qsort(body->rim, body->rims, sizeof *body->rim, compare_rims);
}

/* Whether the facet on the other side of an edge faces the viewer as well. */
static bool is_inner(const struct seen_body *body, uint32_t from, uint32_t to) {
    const struct rim back = {to, from};
    return bsearch(&back, body->rim, body->rims, sizeof *body->rim, compare_rims) != NULL;
}

/* The half-spaces of what the body hides: first those along the line of sight. */
static void see_shadow(struct seen_body *body) {
    for (uint32_t i = 0; i < body->rims; i++) {
        const struct rim *rim = &body->rim[i];
        if (is_inner(body, rim->from, rim->to))
            continue;
        // facets that face the viewer are counter-clockwise: outside is to the right of the edge
        const double *a = body->at[rim->from], *b = body->at[rim->to];
        double length = hypot(b[0] - a[0], b[1] - a[1]);
        if (!(length > 0))
            continue;
        struct half_space out = {{(b[1] - a[1]) / length, (a[0] - b[0]) / length, 0}, 0};
        out.offset = out.normal[0] * a[0] + out.normal[1] * a[1];
        body->shadow[body->shadows++] = out;
    }
    for (uint32_t f = 0; f < pir_mesh_facet_count(body->mesh); f++)
        if (body->front[f]) {
            const double *p = body->plane[f];
            body->shadow[body->shadows++] = (struct half_space){{p[0], p[1], p[2]}, p[3]};
        }
}

bool hidden_see(struct seen_body *body, const pir_mesh *mesh, pir_vec3 middle) {
    uint32_t facets = pir_mesh_facet_count(mesh), corners = 0;
    for (uint32_t f = 0; f < facets; f++) {
        uint32_t count;
        pir_mesh_facet(mesh, f, &count);
        corners += count;
    }
    *body = (struct seen_body){.mesh = mesh};
    body->at = malloc(pir_mesh_vertex_count(mesh) * sizeof *body->at);
    body->front = calloc(facets + 1, sizeof *body->front);
    body->plane = calloc(facets + 1, sizeof *body->plane);
    body->shadow = malloc((corners + facets + 1) * sizeof *body->shadow);
    body->rim = malloc((corners + 1) * sizeof *body->rim);
    bool done = body->at && body->front && body->plane && body->shadow && body->rim;
    if (done) {
        see_vertices(body, middle);
        for (uint32_t f = 0; f < facets; f++)
            see_facet(body, f);
        find_rims(body);
        see_shadow(body);
    }
    return done;
}

void hidden_clear(struct seen_body *body) {
    free(body->at);
    free(body->front);
    free(body->plane);
    free(body->rim);
    free(body->shadow);
    *body = (struct seen_body){0};
}

/* --- polygons --- */

/* A half-plane: x with a[0]·x + a[1]·y ≤ a[2]. */
static double over(const double half[3], const double point[2]) {
    return half[0] * point[0] + half[1] * point[1] - half[2];
}

/* The part of a convex polygon in a half-plane, or, with sign −1, the part that is not. */
static void cut(const struct seen_polygon *from, const double half[3], double sign, struct seen_polygon *ret_part) {
    ret_part->count = 0;
    for (uint32_t i = 0; i < from->count; i++) {
        const double *a = from->at[i], *b = from->at[i + 1 < from->count ? i + 1 : 0];
        double h = sign * over(half, a), k = sign * over(half, b);
        if (h <= 0 && ret_part->count < SEEN_CORNERS)
            memcpy(ret_part->at[ret_part->count++], a, 2 * sizeof *a);
        if ((h < 0 && k > 0) || (h > 0 && k < 0)) {
            double t = h / (h - k);
            if (ret_part->count < SEEN_CORNERS) {
                ret_part->at[ret_part->count][0] = a[0] + t * (b[0] - a[0]);
                ret_part->at[ret_part->count++][1] = a[1] + t * (b[1] - a[1]);
            }
        }
    }
}

static double area(const struct seen_polygon *polygon) {
    double sum = 0;
    for (uint32_t i = 2; i < polygon->count; i++) {
        const double *o = polygon->at[0], *a = polygon->at[i - 1], *b = polygon->at[i];
        sum += (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    }
    return sum / 2;
}

/* A list of polygons that grows. */
struct parts {
    struct seen_polygon *at;
    size_t count, room;
};

static bool parts_add(struct parts *parts, const struct seen_polygon *polygon) {
    if (parts->count == parts->room) {
        size_t room = 2 * parts->room + 8;
        struct seen_polygon *grown = realloc(parts->at, room * sizeof *grown);
        if (!grown)
            return false;
        parts->at = grown;
        parts->room = room;
    }
    parts->at[parts->count++] = *polygon;
    return true;
}

/* A half-space in the plane of a facet, as a half-plane of the picture: z = (d − n0·x − n1·y) / n2 there. */
static void in_plane(const struct half_space *space, const double plane[4], double more, double ret_half[3]) {
    double c = space->normal[2] / plane[2];
    ret_half[0] = space->normal[0] - c * plane[0];
    ret_half[1] = space->normal[1] - c * plane[1];
    ret_half[2] = space->offset + more - c * plane[3];
}

/* Whether a body hides some of a polygon in `plane`. */
static bool hides(const struct seen_body *body, const double plane[4], double more,
                  const struct seen_polygon *polygon) {
    struct seen_polygon rest = *polygon, next;
    for (uint32_t i = 0; i < body->shadows; i++) {
        double half[3];
        in_plane(&body->shadow[i], plane, more, half);
        cut(&rest, half, 1, &next);
        if (!(area(&next) > SLIVER * area(polygon)))
            return false;
        rest = next;
    }
    return body->shadows > 0;
}

/* Adds to `to` what of a polygon in `plane` the body does not hide. */
static bool subtract(const struct seen_body *body, const double plane[4], double more,
                     const struct seen_polygon *polygon, struct parts *to) {
    if (!hides(body, plane, more, polygon))
        return parts_add(to, polygon);
    struct seen_polygon rest = *polygon, part;
    double least = SLIVER * area(polygon);
    for (uint32_t i = 0; i < body->shadows; i++) {
        double half[3];
        in_plane(&body->shadow[i], plane, more, half);
        cut(&rest, half, -1, &part);
        if (area(&part) > least && !parts_add(to, &part))
            return false;
        cut(&rest, half, 1, &part);
        rest = part;
    }
    return true;
}

/* The number added to the offsets of a body that hides some of `own`. */
static double overlap(const struct seen_body *own, bool more) {
    double extent = fmax(own->high[0] - own->low[0], own->high[1] - own->low[1]);
    return more ? OVERLAP * extent : -OVERLAP * extent;
}

static bool apart(const struct seen_body *a, const struct seen_body *b) {
    return a->high[0] <= b->low[0] || b->high[0] <= a->low[0] || a->high[1] <= b->low[1] || b->high[1] <= a->low[1];
}

/* One facet, or a fan of it, less what the other bodies hide. */
static bool facet_parts(const struct seen_body *bodies, uint32_t count, uint32_t which, uint32_t facet,
                        const struct seen_polygon *whole, const struct seen_sink *sink) {
    struct parts now = {0}, next = {0};
    const struct seen_body *own = &bodies[which];
    bool done = parts_add(&now, whole);
    for (uint32_t b = 0; done && b < count; b++) {
        if (b == which || apart(own, &bodies[b]))
            continue;
        next.count = 0;
        for (size_t i = 0; done && i < now.count; i++)
            done = subtract(&bodies[b], own->plane[facet], overlap(own, b < which), &now.at[i], &next);
        struct parts swap = now;
        now = next;
        next = swap;
    }
    for (size_t i = 0; done && i < now.count; i++)
        sink->polygon(sink->context, own, facet, &now.at[i]);
    free(now.at);
    free(next.at);
    return done;
}

/* --- edges --- */

/* The share of an edge that a body hides: from *ret_from to *ret_to; none where those are not in order. */
static void hidden_share(const struct seen_body *body, double more, const double (*edge)[3], double *ret_from,
                         double *ret_to) {
    double from = 0, to = body->shadows > 0 ? 1 : -1;
    for (uint32_t i = 0; i < body->shadows && from < to; i++) {
        const struct half_space *s = &body->shadow[i];
        double h = -s->offset - more, k = h;
        for (int c = 0; c < 3; c++) {
            h += s->normal[c] * edge[0][c];
            k += s->normal[c] * edge[1][c];
        }
        if (h >= 0 && k >= 0)
            to = -1;
        else if (h > 0)
            from = fmax(from, h / (h - k));
        else if (k > 0)
            to = fmin(to, h / (h - k));
    }
    *ret_from = from;
    *ret_to = to;
}

/* The stretch of an edge from `from` to `to`, less what the bodies from number `next` on hide. */
static void edge_parts(const struct seen_body *bodies, uint32_t count, uint32_t next, uint32_t own,
                       const double (*edge)[3], const struct seen_sink *sink) {
    double from, to, middle[2][2][3];
    for (; next < count; next++) {
        if (next == own || apart(&bodies[own], &bodies[next]))
            continue;
        hidden_share(&bodies[next], overlap(&bodies[own], next < own), edge, &from, &to);
        if (!(to - from > SLIVER))
            continue;
        for (int c = 0; c < 3; c++) {
            double length = edge[1][c] - edge[0][c];
            middle[0][0][c] = edge[0][c];
            middle[0][1][c] = edge[0][c] + from * length;
            middle[1][0][c] = edge[0][c] + to * length;
            middle[1][1][c] = edge[1][c];
        }
        if (from > SLIVER)
            edge_parts(bodies, count, next + 1, own, (const double(*)[3])middle[0], sink);
        if (to < 1 - SLIVER)
            edge_parts(bodies, count, next + 1, own, (const double(*)[3])middle[1], sink);
        return;
    }
    sink->line(sink->context, edge[0], edge[1]);
}

/* --- a body among others --- */

/* Draws a facet in fans of at most half as many corners as a polygon holds. */
static bool facet_fans(const struct seen_body *bodies, uint32_t count, uint32_t which, uint32_t facet,
                       const struct seen_sink *sink) {
    uint32_t corners;
    const uint32_t *corner = pir_mesh_facet(bodies[which].mesh, facet, &corners);
    bool done = true;
    for (uint32_t start = 1; done && start + 1 < corners; start += SEEN_CORNERS / 2 - 2) {
        struct seen_polygon fan = {.count = 0};
        for (uint32_t i = start - 1; i < corners && fan.count < SEEN_CORNERS / 2; i++) {
            uint32_t v = i == start - 1 ? corner[0] : corner[i];
            memcpy(fan.at[fan.count++], bodies[which].at[v], 2 * sizeof(double));
        }
        done = facet_parts(bodies, count, which, facet, &fan, sink);
    }
    return done;
}

bool hidden_parts(const struct seen_body *bodies, uint32_t count, uint32_t which, const struct seen_sink *sink) {
    const struct seen_body *own = &bodies[which];
    bool done = true;
    for (uint32_t f = 0; done && f < pir_mesh_facet_count(own->mesh); f++)
        if (own->front[f])
            done = facet_fans(bodies, count, which, f, sink);
    for (uint32_t f = 0; done && f < pir_mesh_facet_count(own->mesh); f++) {
        uint32_t corners;
        const uint32_t *corner = pir_mesh_facet(own->mesh, f, &corners);
        for (uint32_t i = 0; own->front[f] && i < corners; i++) {
            uint32_t a = corner[i], b = corner[i + 1 < corners ? i + 1 : 0];
            double edge[2][3];
            memcpy(edge[0], own->at[a], sizeof edge[0]);
            memcpy(edge[1], own->at[b], sizeof edge[1]);
            if (a < b || !is_inner(own, a, b)) // an edge between two facets that are drawn comes twice
                edge_parts(bodies, count, 0, which, (const double(*)[3])edge, sink);
        }
    }
    return done;
}

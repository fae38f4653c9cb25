/* SPDX-License-Identifier: MIT */
/*
 * The mass of a polytope that is grown by a ball, in doubles, after Steiner: it is the polytope, a prism on each facet,
 * a sector of a cylinder along each edge and a sector of the ball at each vertex, which share no inside.
 *
 * The directions of a sector at a vertex are a polygon on the sphere whose sides are the arcs of its edges. With the
 * area A of the polygon, and of each arc its angle θ, the unit direction d of its edge away from the vertex and the
 * integral c of n along it, the divergence theorem on the sphere gives
 *
 *     ∫ n = −½ Σ θ d        ∫ n nᵀ = (2 A I − Σ (d cᵀ + c dᵀ)) / 6
 *
 * A is 2π less the angles of the facets at the vertex. Flat bodies have the same form (polytope.h): a polygon has a
 * prism on either side, a segment two sectors of half a cylinder each.
 */
#include <math.h>

#include <pirouette/mass.h>

#include "base/vec.h"
#include "polytope/polytope.h"

/* Integrals of 1, x and x xᵀ, about an origin of their own. */
struct rounded_moments {
    double whole, first[3], second[3][3];
};

/* Adds factor · (a bᵀ + b aᵀ) / 2. */
static void add_product(struct rounded_moments *m, double factor, pir_vec3 a, pir_vec3 b) {
    const double x[3] = {a.x, a.y, a.z}, y[3] = {b.x, b.y, b.z};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            m->second[i][k] += 0.5 * factor * (x[i] * y[k] + y[i] * x[k]);
}

static void add_first(struct rounded_moments *m, double factor, pir_vec3 a) {
    m->first[0] += factor * a.x;
    m->first[1] += factor * a.y;
    m->first[2] += factor * a.z;
}

/* An arc: where it begins, a quarter further on, how long it is, and the integral of n along it. */
struct rounding_arc {
    pir_vec3 u, w, sum;
    double angle;
};

/* The arc of an edge, which leads from the facet on the left of a halfedge to the one on its right. */
static struct rounding_arc arc_of(const pir_polytope *p, uint32_t half) {
    struct rounding_arc arc;
    const pir_vec3 d = p->direction[half], right = p->normal[pir_right(p, half)];
    arc.u = p->normal[p->left[half]];
    arc.w = pir_vec_cross(d, arc.u);
    arc.angle = atan2(fabs(pir_vec_dot(right, arc.w)), pir_vec_dot(right, arc.u));
    arc.sum = pir_vec_add(pir_vec_scale(arc.u, sin(arc.angle)), pir_vec_scale(arc.w, 1 - cos(arc.angle)));
    return arc;
}

/* The prism of height r on a triangle with a normal. */
static void add_prism(struct rounded_moments *m, const pir_vec3 corner[3], pir_vec3 n, double r) {
    const pir_vec3 s = pir_vec_add(corner[0], pir_vec_add(corner[1], corner[2]));
    const pir_vec3 cross = pir_vec_cross(pir_vec_sub(corner[1], corner[0]), pir_vec_sub(corner[2], corner[0]));
    const double area = 0.5 * pir_vec_dot(cross, n);
    m->whole += area * r;
    add_first(m, area * r / 3, s);
    add_first(m, area * r * r / 2, n);
    for (int k = 0; k < 3; k++)
        add_product(m, area * r / 12, corner[k], corner[k]);
    add_product(m, area * r / 12, s, s);
    add_product(m, area * r * r / 3, s, n);
    add_product(m, area * r * r * r / 3, n, n);
}

static void add_facets(struct rounded_moments *m, const pir_polytope *p, pir_vec3 origin, double r) {
    for (uint32_t f = 0; f < p->facet_count; f++)
        for (uint32_t i = p->loop_start[f] + 1; i + 1 < p->loop_start[f + 1]; i++) {
            const uint32_t of[3] = {p->loop[p->loop_start[f]], p->loop[i], p->loop[i + 1]};
            pir_vec3 corner[3];
            for (int k = 0; k < 3; k++)
                corner[k] = pir_vec_sub(p->vertex[p->origin[of[k]]], origin);
            add_prism(m, corner, p->normal[f], r);
        }
}

/* The sector of a cylinder along an edge: x = a + t d + ρ n with t up to its length, ρ up to r and n on its arc. */
static void add_edge(struct rounded_moments *m, const pir_polytope *p, uint32_t half, pir_vec3 origin, double r) {
    const struct rounding_arc arc = arc_of(p, half);
    const pir_vec3 a = pir_vec_sub(p->vertex[p->origin[half]], origin),
                   b = pir_vec_sub(p->vertex[p->target[half]], origin), way = pir_vec_sub(b, a);
    const double length = sqrt(pir_vec_dot(way, way)), area = 0.5 * r * r * arc.angle, cube = r * r * r / 3;
    const double fourth = r * r * r * r / 4, s = sin(arc.angle), c = cos(arc.angle);
    const pir_vec3 middle = pir_vec_scale(pir_vec_add(a, b), 0.5);
    m->whole += length * area;
    add_first(m, length * area, middle);
    add_first(m, length * cube, arc.sum);
    add_product(m, length * area, middle, middle);
    add_product(m, length * area / 12, way, way);
    add_product(m, 2 * length * cube, middle, arc.sum);
    add_product(m, length * fourth * 0.5 * (arc.angle + s * c), arc.u, arc.u);
    add_product(m, length * fourth * 0.5 * (arc.angle - s * c), arc.w, arc.w);
    add_product(m, length * fourth * s * s, arc.u, arc.w);
}

/* The sector of the ball at a vertex. */
static void add_vertex(struct rounded_moments *m, const pir_polytope *p, uint32_t vertex, pir_vec3 origin, double r) {
    const double pi = 3.14159265358979323846, cube = r * r * r / 3, fourth = r * r * r * r / 4,
                 fifth = cube * r * r * 0.6;
    const pir_vec3 v = pir_vec_sub(p->vertex[vertex], origin);
    const uint32_t begin = p->half_count > 0 ? p->ring_start[vertex] : 0,
                   end = p->half_count > 0 ? p->ring_start[vertex + 1] : 0;
    double area = end > begin ? 2 * pi : 4 * pi;
    pir_vec3 first = {0, 0, 0};
    struct rounded_moments sphere = {.whole = 0};
    for (uint32_t h = begin; h < end; h++) {
        const struct rounding_arc arc = arc_of(p, h);
        const pir_vec3 d = p->direction[h], next = p->direction[pir_ring_next(p, h)], across = pir_vec_cross(d, next);
        area -= atan2(sqrt(pir_vec_dot(across, across)), pir_vec_dot(d, next));
        first = pir_vec_sub(first, pir_vec_scale(d, 0.5 * arc.angle));
        add_product(&sphere, -1. / 3, d, arc.sum);
    }
    m->whole += area * cube;
    add_first(m, area * cube, v);
    add_first(m, fourth, first);
    add_product(m, area * cube, v, v);
    add_product(m, 2 * fourth, v, first);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            m->second[i][k] += fifth * (sphere.second[i][k] + (i == k ? area / 3 : 0));
}

/* The moments of the polytope itself, about its centroid. */
static void begin(struct rounded_moments *m, const pir_mass *mass) {
    const double trace = mass->inertia[0][0] + mass->inertia[1][1] + mass->inertia[2][2];
    m->whole = mass->volume;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            m->second[i][k] = (i == k ? 0.5 * trace : 0) - mass->inertia[i][k];
}

static pir_mass mass_of(const struct rounded_moments *m, pir_vec3 origin) {
    const pir_vec3 away = {m->first[0] / m->whole, m->first[1] / m->whole, m->first[2] / m->whole};
    pir_mass mass = {.volume = m->whole, .centroid = pir_vec_add(origin, away)};
    double spread[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            spread[i][k] = m->second[i][k] - m->first[i] * m->first[k] / m->whole;
    const double trace = spread[0][0] + spread[1][1] + spread[2][2];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            mass.inertia[i][k] = (i == k ? trace : 0) - spread[i][k];
    return mass;
}

pir_status pir_polytope_rounded_mass(const pir_polytope *polytope, double radius, pir_mass *ret_mass) {
    pir_mass own;
    if (isnan(radius))
        return PIR_ERR_NOT_FINITE;
    if (!(radius >= 0 && radius < HUGE_VAL))
        return PIR_ERR_ARGUMENT;
    const pir_status status = pir_polytope_mass(polytope, &own);
    if (status != PIR_OK || !ret_mass)
        return status == PIR_OK ? PIR_ERR_ARGUMENT : status;
    if (radius == 0) {
        *ret_mass = own;
        return PIR_OK;
    }
    struct rounded_moments moments = {.whole = 0};
    begin(&moments, &own);
    add_facets(&moments, polytope, own.centroid, radius);
    for (uint32_t e = 0; e < polytope->edge_count; e++)
        add_edge(&moments, polytope, polytope->edge_half[e], own.centroid, radius);
    for (uint32_t v = 0; v < polytope->vertex_count; v++)
        add_vertex(&moments, polytope, v, own.centroid, radius);
    const pir_mass mass = mass_of(&moments, own.centroid);
    bool is_finite = isfinite(mass.volume) && pir_vec_is_finite(mass.centroid);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            is_finite = is_finite && isfinite(mass.inertia[i][k]);
    if (!is_finite || !(mass.volume > 0))
        return PIR_ERR_LIMIT;
    *ret_mass = mass;
    return PIR_OK;
}

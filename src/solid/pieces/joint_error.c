/* SPDX-License-Identifier: MIT */
/* See joint_error.h. What rounding may do to a coordinate is added wherever a point is made. */
#include "solid/pieces/joint_error.h"

#include <math.h>
#include <stdbool.h>

#include "base/vec.h"
#include "solid/pieces/convex_distance.h"

/* Planes that are tried: those below which B has least. */
#define PLANES 2

/* A plane that A is below, off by up to `margin` at points of both. */
struct margin_plane {
    pir_vec3 n;
    double h, margin;
};

struct joint {
    const pir_joint_part *a, *b;
    double reach; /* the greatest coordinate of both */
};

static double height(const struct margin_plane *plane, pir_vec3 x) {
    return pir_vec_dot(plane->n, x) - plane->h;
}

/* A bound on the distance of a point from a part, both made with rounding. */
static double distance_to(const struct joint *joint, const pir_joint_part *part, pir_vec3 point) {
    return pir_convex_distance(part->polytope, point, joint->reach) + 0x1p-46 * joint->reach;
}

/* The point of the plane between `from` below it and `to` above, and how far it may be from there. */
static pir_vec3 crossing(const struct margin_plane *plane, pir_vec3 from, pir_vec3 to, double *ret_off) {
    const double below = -height(plane, from), above = height(plane, to), sum = below + above;
    const pir_vec3 way = pir_vec_sub(to, from);
    const double share = sum > 8 * plane->margin ? fmin(1, fmax(0, below / sum)) : 0.5;
    *ret_off = sum > 8 * plane->margin ? 4 * plane->margin / sum * sqrt(pir_vec_dot(way, way)) : HUGE_VAL;
    return pir_vec_add(from, pir_vec_scale(way, share));
}

/* A bound on how far from a part the segment crosses the plane; HUGE_VAL where it is too flat to tell. */
static double from_crossing(const struct joint *joint, const pir_joint_part *part, const struct margin_plane *plane,
                            pir_vec3 from, pir_vec3 to) {
    double off;
    const pir_vec3 c = crossing(plane, from, to, &off);
    return off < HUGE_VAL ? distance_to(joint, part, c) + off : HUGE_VAL;
}

/* The greatest distances of: c from A and from B, what is in A from B, what B has above and below from A. */
struct distances {
    double c_a, c_b, a_b, above_a, below_a;
};

/* Adds the segments from A's vertices to a vertex of B above the plane, which is `from_a` from A. */
static void add_above(const struct joint *joint, const struct margin_plane *plane, pir_vec3 to, double from_a,
                      struct distances *d) {
    const pir_polytope *a = joint->a->polytope;
    d->above_a = fmax(d->above_a, from_a);
    for (uint32_t i = 0; i < pir_polytope_vertex_count(a); i++) {
        const pir_vec3 from = pir_polytope_vertex(a, i);
        if (from.x == to.x && from.y == to.y && from.z == to.z)
            continue;
        const double of_c = from_crossing(joint, joint->b, plane, from, to);
        d->c_a = fmax(d->c_a, fmin(from_crossing(joint, joint->a, plane, from, to), from_a));
        d->c_b = fmax(d->c_b, of_c < HUGE_VAL ? of_c : distance_to(joint, joint->b, from));
    }
}

/* Adds a vertex of B below the plane, and where the segments from it to those above cross the plane. */
static void add_below(const struct joint *joint, const struct margin_plane *plane, pir_vec3 from, double from_a,
                      struct distances *d) {
    const pir_polytope *b = joint->b->polytope;
    d->below_a = fmax(d->below_a, from_a);
    for (uint32_t j = 0; j < pir_polytope_vertex_count(b); j++) {
        const pir_vec3 to = pir_polytope_vertex(b, j);
        if (height(plane, to) < -plane->margin)
            continue;
        double of_c = from_crossing(joint, joint->a, plane, from, to);
        if (of_c == HUGE_VAL)
            of_c = fmax(distance_to(joint, joint->a, to), from_a);
        d->below_a = fmax(d->below_a, of_c);
        d->c_a = fmax(d->c_a, of_c);
    }
}

/* The greatest of the lesser of two linear functions, from their values at two ends. */
static double greatest(const double first[2], const double second[2]) {
    const double at[2] = {first[0] - second[0], first[1] - second[1]};
    const double ends = fmax(fmin(first[0], second[0]), fmin(first[1], second[1]));
    return at[0] * at[1] < 0 ? fmax(ends, first[0] + (first[1] - first[0]) * (at[0] / (at[0] - at[1]))) : ends;
}

static double error_of(const struct joint *joint, const struct distances *d) {
    const double a = joint->a->error, b = joint->b->error;
    const double below = greatest((double[]){a, d->c_a + a}, (double[]){d->a_b + b, d->c_b + b});
    const double above = greatest((double[]){d->c_a + a, d->above_a + a}, (double[]){d->c_b + b, b});
    const double beside = greatest((double[]){a, d->below_a + a}, (double[]){d->a_b + b, b});
    return fmax(below, fmax(above, beside));
}

/* The bound by one plane, or `best` and more where it is no less. */
static double error_by(const struct joint *joint, const struct margin_plane *plane, double best) {
    const pir_polytope *a = joint->a->polytope, *b = joint->b->polytope;
    struct distances d = {0};
    for (uint32_t i = 0; i < pir_polytope_vertex_count(a); i++)
        d.a_b = fmax(d.a_b, distance_to(joint, joint->b, pir_polytope_vertex(a, i)));
    for (uint32_t j = 0; j < pir_polytope_vertex_count(b); j++) {
        const pir_vec3 x = pir_polytope_vertex(b, j);
        const double at = height(plane, x), from_a = distance_to(joint, joint->a, x);
        if (at > -plane->margin)
            add_above(joint, plane, x, from_a, &d);
        if (at < plane->margin)
            add_below(joint, plane, x, from_a, &d);
        if (error_of(joint, &d) >= best)
            return best;
    }
    return error_of(joint, &d);
}

/* A plane of A's facet, moved outwards by more than rounding, and how far B is below it. */
static struct margin_plane plane_of(const struct joint *joint, uint32_t facet, double *ret_below) {
    const pir_polytope *a = joint->a->polytope, *b = joint->b->polytope;
    struct margin_plane plane = {pir_polytope_normal(a, facet), -HUGE_VAL, 0x1p-47 * joint->reach};
    for (uint32_t i = 0; i < pir_polytope_vertex_count(a); i++)
        plane.h = fmax(plane.h, pir_vec_dot(plane.n, pir_polytope_vertex(a, i)));
    plane.h += plane.margin;
    *ret_below = 0;
    for (uint32_t j = 0; j < pir_polytope_vertex_count(b); j++)
        *ret_below = fmax(*ret_below, -height(&plane, pir_polytope_vertex(b, j)));
    return plane;
}

/* The least bound by planes of A's facets, or `best` where none is less. */
static double error_by_facets(const struct joint *joint, double best) {
    struct margin_plane plane[PLANES] = {0};
    double below[PLANES] = {HUGE_VAL, HUGE_VAL};
    for (uint32_t f = 0; f < pir_polytope_facet_count(joint->a->polytope); f++) {
        double own;
        struct margin_plane next = plane_of(joint, f, &own);
        for (int k = 0; k < PLANES; k++)
            if (own < below[k]) {
                const struct margin_plane kept = plane[k];
                const double kept_below = below[k];
                plane[k] = next;
                below[k] = own;
                next = kept;
                own = kept_below;
            }
    }
    for (int k = 0; k < PLANES && below[k] < HUGE_VAL; k++)
        best = fmin(best, error_by(joint, &plane[k], best));
    return best;
}

static double reach_of(const pir_polytope *polytope) {
    pir_vec3 low, high;
    pir_polytope_bounds(polytope, &low, &high);
    return fmax(fmax(fmax(-low.x, high.x), fmax(-low.y, high.y)), fmax(-low.z, high.z));
}

double pir_joint_error(const pir_joint_part *a, const pir_joint_part *b, double limit) {
    const double reach = fmax(reach_of(a->polytope), reach_of(b->polytope));
    const struct joint one = {a, b, reach}, other = {b, a, reach};
    return error_by_facets(&other, error_by_facets(&one, limit)) * (1 + 0x1p-40);
}

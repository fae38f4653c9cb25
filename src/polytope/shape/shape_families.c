/* SPDX-License-Identifier: MIT */
/*
 * Shapes that come in sizes, as points whose exact convex hull is the shape.
 *
 * Facets with more than three corners must lie exactly in a plane although their corners are rounded: caps share one z,
 * and the sides of a prism are parallelograms because the top ring repeats the x and y of the bottom ring. Round shapes
 * stagger neighbouring rings by half a step, which leaves triangles only, and triangles are flat whatever the rounding.
 */
#include "polytope/shape/shape_families.h"

#include <math.h>

/* One ring of `sides` points at height z, turned by half a step when `half` is 1. */
static void ring(struct pir_point_list *points, uint64_t sides, int half, double x, double y, double z) {
    for (uint64_t i = 0; i < sides; i++) {
        const struct pir_direction d = pir_turn_direction(2 * i + (uint64_t)half, 2 * sides);
        pir_point_list_add(points, x * d.x, y * d.y, z);
    }
}

void pir_points_point(const double *value, struct pir_point_list *points) {
    (void)value;
    pir_point_list_add(points, 0, 0, 0);
}

void pir_points_segment(const double *value, struct pir_point_list *points) {
    pir_point_list_add(points, 0, 0, -value[0] / 2);
    pir_point_list_add(points, 0, 0, value[0] / 2);
}

void pir_points_polygon(const double *value, struct pir_point_list *points) {
    ring(points, (uint64_t)value[0], 0, value[1], value[1], 0);
}

void pir_points_box(const double *value, struct pir_point_list *points) {
    for (int i = 0; i < 8; i++)
        pir_point_list_add(points, (i & 1 ? value[0] : -value[0]) / 2, (i & 2 ? value[1] : -value[1]) / 2,
                           (i & 4 ? value[2] : -value[2]) / 2);
}

void pir_points_prism(const double *value, struct pir_point_list *points) {
    ring(points, (uint64_t)value[0], 0, value[1], value[1], -value[2] / 2);
    ring(points, (uint64_t)value[0], 0, value[1], value[1], value[2] / 2);
}

void pir_points_antiprism(const double *value, struct pir_point_list *points) {
    ring(points, (uint64_t)value[0], 0, value[1], value[1], -value[2] / 2);
    ring(points, (uint64_t)value[0], 1, value[1], value[1], value[2] / 2);
}

void pir_points_pyramid(const double *value, struct pir_point_list *points) {
    ring(points, (uint64_t)value[0], 0, value[1], value[1], -value[2] / 2);
    pir_point_list_add(points, 0, 0, value[2] / 2);
}

void pir_points_dipyramid(const double *value, struct pir_point_list *points) {
    ring(points, (uint64_t)value[0], 0, value[1], value[1], 0);
    pir_point_list_add(points, 0, 0, -value[2] / 2);
    pir_point_list_add(points, 0, 0, value[2] / 2);
}

/* The dioctagon has sixteen corners on two circles in turn; it is convex while the radii's ratio is
   above cos(π/8) = 0.924. */
void pir_points_dioctagonal(const double *value, struct pir_point_list *points) {
    const double inner = value[0] * 0.953125;
    ring(points, 8, 0, value[0], value[0], 0);
    ring(points, 8, 1, inner, inner, 0);
    pir_point_list_add(points, 0, 0, -value[1] / 2);
    pir_point_list_add(points, 0, 0, value[1] / 2);
}

/* A capsule: two half spheres of `rings` rings each, the widest at the ends of the straight part. */
void pir_points_rod(const double *value, struct pir_point_list *points) {
    const uint64_t sides = (uint64_t)value[0], rings = (uint64_t)value[1];
    const double radius = value[2], straight = value[3] / 2;
    for (uint64_t k = 0; k < rings; k++) {
        const struct pir_direction up = pir_turn_direction(k, 4 * rings);
        const double wide = radius * up.x, z = straight + radius * up.y;
        ring(points, sides, k % 2 == 1, wide, wide, z);
        ring(points, sides, k % 2 == 0, wide, wide, -z);
    }
    pir_point_list_add(points, 0, 0, straight + radius);
    pir_point_list_add(points, 0, 0, -(straight + radius));
}

/*
 * level − 1 rings of 2·level points between two poles: 4·level·(level − 1) triangles. Points are no further
 * apart along a ring than across, so the staggered triangles are the Delaunay triangles of the points on the sphere,
 * which are the facets of their hull; stretching the sphere keeps them.
 */
void pir_points_ellipsoid(const double *value, struct pir_point_list *points) {
    const uint64_t level = (uint64_t)value[0];
    pir_point_list_add(points, 0, 0, value[3]);
    for (uint64_t k = 1; k < level; k++) {
        const struct pir_direction down = pir_turn_direction(k, 2 * level);
        ring(points, 2 * level, k % 2 == 1, value[1] * down.y, value[2] * down.y, value[3] * down.x);
    }
    pir_point_list_add(points, 0, 0, -value[3]);
}

/* a·i + b·j + c·k */
static pir_vec3 between(pir_vec3 a, double i, pir_vec3 b, double j, pir_vec3 c, double k) {
    return (pir_vec3){a.x * i + b.x * j + c.x * k, a.y * i + b.y * j + c.y * k, a.z * i + b.z * j + c.z * k};
}

/* Adds the point of the sphere in the direction of `v`. */
static void add_on_sphere(struct pir_point_list *points, double radius, pir_vec3 v) {
    const double length = sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    pir_point_list_add(points, radius * (v.x / length), radius * (v.y / length), radius * (v.z / length));
}

/* The corners of an icosahedron of edge 2. */
static void icosahedron_corners(pir_vec3 corner[12]) {
    const double golden = (1 + sqrt(5)) / 2;
    for (int i = 0; i < 4; i++) {
        const double one = i & 1 ? -1 : 1, far = i & 2 ? -golden : golden;
        corner[3 * i] = (pir_vec3){0, one, far};
        corner[3 * i + 1] = (pir_vec3){one, far, 0};
        corner[3 * i + 2] = (pir_vec3){far, 0, one};
    }
}

/* Whether two corners share an edge: the next nearest are 2·golden apart. */
static bool are_neighbours(pir_vec3 a, pir_vec3 b) {
    const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return x * x + y * y + z * z < 5;
}

/* The icosahedron's corners, then the points between them on each edge and inside each facet: class I
   of frequency level + 1. */
void pir_points_geodesic(const double *value, struct pir_point_list *points) {
    const int frequency = (int)value[0] + 1;
    const double radius = value[1];
    pir_vec3 v[12];
    icosahedron_corners(v);
    for (int a = 0; a < 12; a++) {
        add_on_sphere(points, radius, v[a]);
        for (int b = a + 1; b < 12; b++) {
            if (!are_neighbours(v[a], v[b]))
                continue;
            for (int j = 1; j < frequency; j++)
                add_on_sphere(points, radius, between(v[a], frequency - j, v[b], j, v[b], 0));
            for (int c = b + 1; c < 12; c++) {
                if (!are_neighbours(v[a], v[c]) || !are_neighbours(v[b], v[c]))
                    continue;
                for (int j = 1; j < frequency; j++)
                    for (int k = 1; j + k < frequency; k++)
                        add_on_sphere(points, radius, between(v[a], frequency - j - k, v[b], j, v[c], k));
            }
        }
    }
}

/* SplitMix64: Steele, Lea, Flood, Fast splittable pseudorandom number generators, OOPSLA 2014. */
static uint64_t next_random(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

/* A multiple of 2^-52 from −1 up to but not including 1. */
static double random_coordinate(uint64_t *state) {
    return (double)(next_random(state) >> 11) * 0x1p-52 - 1;
}

/*
 * Points of a ball, by drawing from its cube and dropping what lies outside or too near the centre; pushed out to its
 * sphere when `push` is set.
 */
static void random_points(const double *value, bool push, struct pir_point_list *points) {
    const size_t count = (size_t)value[0];
    uint64_t state = (uint64_t)value[1];
    for (size_t made = 0; made < count;) {
        const double x = random_coordinate(&state), y = random_coordinate(&state), z = random_coordinate(&state);
        const double square = x * x + y * y + z * z;
        if (square > 1 || square < 0x1p-20)
            continue;
        const double length = push ? sqrt(square) : 1;
        pir_point_list_add(points, value[2] * (x / length), value[2] * (y / length), value[2] * (z / length));
        made++;
    }
}

void pir_points_random(const double *value, struct pir_point_list *points) {
    random_points(value, false, points);
}

void pir_points_random_sphere(const double *value, struct pir_point_list *points) {
    random_points(value, true, points);
}

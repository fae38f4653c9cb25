/* SPDX-License-Identifier: MIT */
/*
 * See models.h. Prisms have vertical sides and level ends. Rings are copies of one polygon, whose corners have ten
 * binary digits, times radii with three: so the sides between two level rings are exactly planar trapezoids. The rest
 * is triangles.
 */
#include "solid/models.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

static void add_facet(solid_model *m, const pir_vec3 *corner, uint32_t count) {
    uint32_t at = m->start[m->facets];
    for (uint32_t i = 0; i < count && m->points < SOLID_MODEL_POINTS; i++) {
        m->point[m->points] = corner[i];
        m->corner[at++] = m->points++;
    }
    m->start[++m->facets] = at;
}

/* --- prisms --- */

static double rounded(double x, double unit) {
    return floor(x / unit + 0.5) * unit;
}

static pir_vec3 at_angle(double radius, double turns, double z) {
    return (pir_vec3){rounded(radius * cos(2 * PI * turns), 0x1p-20), rounded(radius * sin(2 * PI * turns), 0x1p-20),
                      z};
}

static void add_prism(solid_model *m, const pir_vec3 *bottom, uint32_t count, double height) {
    pir_vec3 loop[256] = {{0, 0, 0}};
    for (uint32_t i = 0; i < count; i++)
        loop[i] = bottom[count - 1 - i];
    add_facet(m, loop, count);
    for (uint32_t i = 0; i < count; i++) {
        loop[i] = bottom[i];
        loop[i].z += height;
    }
    add_facet(m, loop, count);
    for (uint32_t i = 0; i < count; i++) {
        const pir_vec3 a = bottom[i], b = bottom[(i + 1) % count];
        add_facet(m, (const pir_vec3[]){a, b, {b.x, b.y, b.z + height}, {a.x, a.y, a.z + height}}, 4);
    }
}

static void add_star(solid_model *m, uint32_t tips) {
    pir_vec3 loop[256] = {{0, 0, 0}};
    for (uint32_t i = 0; i < 2 * tips; i++)
        loop[i] = at_angle(i % 2 ? 1 : 2.5, i / (2.0 * tips), 0);
    add_prism(m, loop, 2 * tips, 1);
}

static void add_gear(solid_model *m, uint32_t teeth) {
    pir_vec3 loop[256] = {{0, 0, 0}};
    for (uint32_t i = 0; i < teeth; i++) {
        loop[4 * i] = at_angle(2, i / (double)teeth, 0);
        loop[4 * i + 1] = at_angle(2.5, (i + 0.15) / teeth, 0);
        loop[4 * i + 2] = at_angle(2.5, (i + 0.5) / teeth, 0);
        loop[4 * i + 3] = at_angle(2, (i + 0.65) / teeth, 0);
    }
    add_prism(m, loop, 4 * teeth, 1);
}

/* --- convex ones and the stella octangula --- */

static void add_cube(solid_model *m) {
    add_prism(m, (const pir_vec3[]){{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 4, 1);
}

/* An axis-parallel box from `low` to `high`, or the boundary of a cavity of that shape. */
static void add_box(solid_model *m, double low, double high, int cavity) {
    for (int side = 0; side < 6; side++) {
        const int k = side / 2;
        pir_vec3 corner[4];
        for (int i = 0; i < 4; i++) {
            const int turn = side % 2 != cavity ? i : 3 - i;
            double c[3];
            c[k] = side % 2 ? high : low;
            c[(k + 1) % 3] = turn == 1 || turn == 2 ? high : low;
            c[(k + 2) % 3] = turn >= 2 ? high : low;
            corner[i] = (pir_vec3){c[0], c[1], c[2]};
        }
        add_facet(m, corner, 4);
    }
}

static void add_case(solid_model *m) {
    add_box(m, 0, 4, 0);
    add_box(m, 1, 3, 1);
}

static void add_clamp(solid_model *m) {
    add_prism(
        m, (const pir_vec3[]){{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 3, 0}, {4, 3, 0}, {4, 4, 0}, {0, 4, 0}},
        8, 1);
}

static void add_ell(solid_model *m) {
    add_prism(m, (const pir_vec3[]){{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, 6, 1);
}

/* Four trapezoids a side, and the walls outside and inside. */
static void add_frame(solid_model *m) {
    static const double at[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    for (int i = 0; i < 4; i++) {
        const double *a = at[i], *b = at[i + 1];
        const pir_vec3 out[2] = {{3 * a[0], 3 * a[1], 0}, {3 * b[0], 3 * b[1], 0}};
        const pir_vec3 in[2] = {{1 + a[0], 1 + a[1], 0}, {1 + b[0], 1 + b[1], 0}};
        const pir_vec3 top[4] = {
            {out[0].x, out[0].y, 1}, {out[1].x, out[1].y, 1}, {in[1].x, in[1].y, 1}, {in[0].x, in[0].y, 1}};
        add_facet(m, top, 4);
        add_facet(m, (const pir_vec3[]){out[1], out[0], in[0], in[1]}, 4);
        add_facet(m, (const pir_vec3[]){out[0], out[1], top[1], top[0]}, 4);
        add_facet(m, (const pir_vec3[]){in[1], in[0], top[3], top[2]}, 4);
    }
}

static void add_triangle(solid_model *m, pir_vec3 a, pir_vec3 b, pir_vec3 c) {
    add_facet(m, (const pir_vec3[]){a, b, c}, 3);
}

static pir_vec3 between(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
}

/* Each face of a tetrahedron with a smaller one on it: where two cross. */
static void add_stella(solid_model *m) {
    const pir_vec3 v[4] = {{2, 2, 2}, {2, -2, -2}, {-2, 2, -2}, {-2, -2, 2}};
    static const uint8_t face[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    for (int f = 0; f < 4; f++) {
        const pir_vec3 a = v[face[f][0]], b = v[face[f][1]], c = v[face[f][2]],
                       opposite = v[6 - face[f][0] - face[f][1] - face[f][2]];
        const pir_vec3 tip = {-opposite.x, -opposite.y, -opposite.z};
        const pir_vec3 ab = between(a, b), bc = between(b, c), ca = between(c, a);
        add_triangle(m, a, ab, ca);
        add_triangle(m, b, bc, ab);
        add_triangle(m, c, ca, bc);
        add_triangle(m, ab, bc, tip);
        add_triangle(m, bc, ca, tip);
        add_triangle(m, ca, ab, tip);
    }
}

/* A point of the octahedron, on the sphere. */
static pir_vec3 on_sphere(double x, double y, double z) {
    const double length = sqrt(x * x + y * y + z * z);
    return (pir_vec3){rounded(x / length, 0x1p-30), rounded(y / length, 0x1p-30), rounded(z / length, 0x1p-30)};
}

static void add_ball(solid_model *m, int split) {
    for (int octant = 0; octant < 8; octant++) {
        const double s[3] = {octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
        for (int i = 0; i < split; i++)
            for (int j = 0; j < split - i; j++)
                for (int down = 0; down < (i + j + 1 < split ? 2 : 1); down++) {
                    const int a[3][2] = {{i + down, j}, {i + 1, j + down}, {i, j + 1}};
                    pir_vec3 v[3];
                    for (int k = 0; k < 3; k++)
                        v[k] = on_sphere(s[0] * a[k][0], s[1] * a[k][1], s[2] * (split - a[k][0] - a[k][1]));
                    const int even = s[0] * s[1] * s[2] > 0;
                    add_triangle(m, v[0], v[even ? 1 : 2], v[even ? 2 : 1]);
                }
    }
}

/* --- rings --- */

struct ring {
    double radius, z;
};

/* A closed surface round the z axis through rings, from the one at the bottom, outside, to the last one, all with a
 * radius: ends are level. */
static void add_rings(solid_model *m, const struct ring *ring, uint32_t count, uint32_t sides) {
    pir_vec3 first[64] = {{0, 0, 0}}, last[64] = {{0, 0, 0}};
    for (uint32_t i = 0; i < sides; i++) {
        pir_vec3 at[2] = {at_angle(1, i / (double)sides, 0), at_angle(1, (i + 1) % sides / (double)sides, 0)};
        for (int k = 0; k < 2; k++)
            at[k] = (pir_vec3){rounded(at[k].x, 0x1p-10), rounded(at[k].y, 0x1p-10), 0};
        for (uint32_t r = 0; r + 1 < count; r++) {
            const struct ring a = ring[r], b = ring[r + 1];
            add_facet(m,
                      (const pir_vec3[]){{at[0].x * a.radius, at[0].y * a.radius, a.z},
                                         {at[1].x * a.radius, at[1].y * a.radius, a.z},
                                         {at[1].x * b.radius, at[1].y * b.radius, b.z},
                                         {at[0].x * b.radius, at[0].y * b.radius, b.z}},
                      4);
        }
        first[sides - 1 - i] = (pir_vec3){at[0].x * ring[0].radius, at[0].y * ring[0].radius, ring[0].z};
        last[i] = (pir_vec3){at[0].x * ring[count - 1].radius, at[0].y * ring[count - 1].radius, ring[count - 1].z};
    }
    add_facet(m, first, sides);
    add_facet(m, last, sides);
}

static void add_mushroom(solid_model *m, uint32_t sides) {
    static const struct ring ring[] = {{0.5, 0},     {0.375, 0.5},  {0.375, 1.5}, {1.25, 1.25},
                                       {1.5, 1.375}, {1.25, 1.875}, {0.75, 2.25}, {0.25, 2.375}};
    add_rings(m, ring, sizeof ring / sizeof *ring, sides);
}

static void add_cup(solid_model *m) {
    static const struct ring ring[] = {{0.75, 0}, {0.375, 0.25}, {0.375, 0.5}, {1.125, 1},
                                       {1.25, 2}, {1.125, 2},    {1, 1.125},   {0.5, 0.75}};
    add_rings(m, ring, sizeof ring / sizeof *ring, 16);
}

/* --- sections --- */

#define SECTION 8

/* A section of the spoon: half a ring from rim to rim, below, and the same less the depth of the bowl, above. */
static void spoon_section(double x, double half, double thick, double depth, pir_vec3 ret[SECTION]) {
    for (int i = 0; i < 5; i++) {
        const double turn = PI * i / 4;
        ret[i] = (pir_vec3){x, rounded(-half * cos(turn), 0x1p-12), rounded(-(thick + depth) * sin(turn), 0x1p-12)};
    }
    for (int i = 0; i < 3; i++) {
        const double turn = PI * (3 - i) / 4;
        ret[5 + i] =
            (pir_vec3){x, rounded(-half * 0.875 * cos(turn), 0x1p-12), rounded(0.0625 - depth * sin(turn), 0x1p-12)};
    }
}

static void add_spoon(solid_model *m) {
    static const double section[][4] = {
        {0, 0.125, 0.125, 0},       {0.25, 0.5, 0.1875, 0.125}, {0.75, 0.75, 0.25, 0.375}, {1.25, 0.75, 0.25, 0.375},
        {1.75, 0.5, 0.1875, 0.125}, {2, 0.1875, 0.1875, 0},     {3, 0.125, 0.125, 0},      {5, 0.25, 0.125, 0}};
    const uint32_t count = sizeof section / sizeof *section;
    pir_vec3 at[2][SECTION];
    for (uint32_t s = 0; s < count; s++) {
        spoon_section(section[s][0], section[s][1], section[s][2], section[s][3], at[s % 2]);
        pir_vec3 *now = at[s % 2], *before = at[1 - s % 2];
        for (int i = 0; i < SECTION && s > 0; i++) {
            const int j = (i + 1) % SECTION;
            add_triangle(m, before[i], before[j], now[j]);
            add_triangle(m, before[i], now[j], now[i]);
        }
        if (s > 0 && s + 1 < count)
            continue;
        pir_vec3 end[SECTION];
        for (int i = 0; i < SECTION; i++)
            end[i] = now[s > 0 ? i : SECTION - 1 - i];
        add_facet(m, end, SECTION);
    }
}

/* --- by name --- */

static bool make_model(solid_model *m, const char *name) {
    static const struct {
        const char *name;
        void (*add)(solid_model *m);
    } plain[] = {{"cube", add_cube}, {"stella", add_stella}, {"clamp", add_clamp}, {"frame", add_frame},
                 {"case", add_case}, {"cup", add_cup},       {"spoon", add_spoon}, {"ell", add_ell}};
    for (size_t i = 0; i < sizeof plain / sizeof *plain; i++)
        if (strcmp(name, plain[i].name) == 0)
            plain[i].add(m);
    if (strncmp(name, "mushroom", 8) == 0)
        add_mushroom(m, name[8] ? (uint32_t)atoi(name + 8) : 32);
    else if (strncmp(name, "star", 4) == 0)
        add_star(m, (uint32_t)atoi(name + 4));
    else if (strncmp(name, "gear", 4) == 0)
        add_gear(m, (uint32_t)atoi(name + 4));
    else if (strcmp(name, "ball128") == 0)
        add_ball(m, 4);
    else if (strcmp(name, "ball32") == 0)
        add_ball(m, 2);
    return m->facets > 0;
}

solid_model *solid_model_facets(const char *name, double divisor) {
    solid_model *m = calloc(1, sizeof *m);
    if (!m || !make_model(m, name)) {
        free(m);
        return NULL;
    }
    for (uint32_t i = 0; i < m->points; i++)
        m->point[i] = (pir_vec3){m->point[i].x / divisor, m->point[i].y / divisor, m->point[i].z / divisor};
    return m;
}

pir_solid *solid_model_new(const char *name, double divisor) {
    solid_model *m = solid_model_facets(name, divisor);
    pir_solid *solid = NULL;
    if (m) {
        const pir_solid_facets facets = {m->point, m->points, m->start, m->corner, m->facets};
        pir_report report = {0};
        if (pir_solid_create(&facets, NULL, &report, &solid) != PIR_OK)
            fprintf(stderr, "%s: %s\n", name, report.text);
    }
    free(m);
    return solid;
}
